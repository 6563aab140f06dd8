# SPDX-License-Identifier: LGPL-2.1-or-later
"""A scan and a model in different units: the factor is said, and what fits or is a part of it passes."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import RESOURCES, api
from ffds_workbench.brep.model_files import model_file, step_colours
from ffds_workbench.brep.simulated_scan import surface_samples
from ffds_workbench.errors import FfdsError, InputError
from ffds_workbench.registration.rigid.scan_unit import FACTORS, unit_mismatch

BRACKET = RESOURCES / "examples" / "bracket.step"


@pytest.fixture(scope="module")
def bracket():
    """The example: model, scan points, box and surface samples."""
    model, scan = api.read_model(BRACKET), api.read_scan(RESOURCES / "examples" / "bracket_scan.ply")
    samples = surface_samples(model.shape)
    return model, scan.points, *api.inputs.box(model.shape), lambda: samples


def tilted_block() -> Part.Shape:
    """A block with a bore, away from the origin and from the axes."""
    shape = Part.makeBox(200, 120, 60).cut(Part.makeCylinder(20, 80, FreeCAD.Vector(60, 60, -10)))
    shape.Placement = FreeCAD.Placement(FreeCAD.Vector(300, -100, 50), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    return shape


@pytest.mark.parametrize("factor", FACTORS)
def test_every_factor_is_told(bracket, factor):
    _, points, low, high, surface = bracket
    assert unit_mismatch(points / factor, low, high, surface) == factor


def test_places_tell_it_for_a_block_away_from_the_origin():
    shape = tilted_block()
    points, normals = surface_samples(shape)
    low, high = api.inputs.box(shape)
    random = np.random.default_rng(3)
    scan = points + 2.0 * normals * np.sin(points[:, :1] / 40) + random.normal(0, 0.1, points.shape)
    for factor in FACTORS:
        assert unit_mismatch(scan / factor, low, high, lambda: (points, normals)) == factor
    assert unit_mismatch(scan, low, high, lambda: (points, normals)) is None


def test_a_face_without_bounds_is_bad_input():
    """As a damaged IGES file holds it: nothing of it can be meshed."""
    with pytest.raises(InputError, match="no bounds"):
        surface_samples(Part.Plane().toShape())


def test_parts_of_the_surface_and_tables_pass(bracket):
    """Nothing that lies on the part is doubted, be it a hundredth of it or a tenth of what was scanned."""
    _, points, low, high, surface = bracket
    random = np.random.default_rng(4)
    size = np.linalg.norm(high - low)
    for share in (0.3, 0.1, 0.03, 0.01):
        for centre in points[random.integers(len(points), size=5)]:
            apart = np.linalg.norm(points - centre, axis=1)
            assert unit_mismatch(points[apart < np.quantile(apart, share)], low, high, surface) is None
    for times in (1.5, 4.0, 10.0):
        table = np.zeros((len(points), 3))
        table[:, :2] = (low + high)[:2] / 2 + random.uniform(-0.5, 0.5, (len(points), 2)) * times * size
        table[:, 2] = low[2] - 0.02 * size
        assert unit_mismatch(np.vstack([points, table]), low, high, surface) is None


@pytest.mark.parametrize(("factor", "says"), [
    (25.4, r"25\.4 times the scan fits: the scan seems to be in inches, not in millimetres \(use --scan-unit in\)"),
    (1000.0, r"1000 times the scan fits: .*in metres.*--scan-unit m\)"),
    (0.1, r"the scan divided by 10 fits: the model's file seems to declare a wrong unit"),
    (1 / 25.4, r"the scan divided by 25\.4 fits")])
def test_every_job_says_it_at_once(bracket, factor, says):
    model, points, *_ = bracket
    scan = api.PointCloud(points / factor)
    for job in (api.register, api.deviation):
        with pytest.raises(InputError, match=says):
            job(model, scan)


def test_a_unit_that_was_given_wrongly(bracket):
    model, points, *_ = bracket
    with pytest.raises(InputError, match=r"not in metres \(use --scan-unit mm\)"):
        api.deviation(model, api.PointCloud(points * 1000.0, unit="m"))


def test_alignment_says_what_it_multiplied_by(bracket):
    model, points, *_ = bracket
    aligned = api.align_scan(model, api.PointCloud(points / 25.4), "fine")
    assert "the scan is in in, or the model's file declares a wrong unit" in aligned.table()
    assert aligned.alignment.scale == 25.4


def test_a_scan_of_another_part_in_another_unit():
    """What fits in no pose, and is far too small, is said to be so."""
    ball = Part.makeSphere(10.0)
    points, _ = surface_samples(ball)
    with pytest.raises(FfdsError):
        api.align_scan(tilted_block(), api.PointCloud(points * 0.05), "global")


def test_the_unit_that_a_step_file_declares(tmp_path, shared_data):
    assert api.read_model(BRACKET).unit == ""
    assert model_file.read(shared_data / "world" / "pyocc_as1_pe_203.stp").unit == "inches"
    assert step_colours.declared_unit("#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));") == "metres"
    model = model_file.read(shared_data / "world" / "pyocc_as1_pe_203.stp")
    points, _ = surface_samples(model.shape)
    with pytest.raises(InputError, match=r"or the model's file declares a wrong unit \(inches\)"):
        api.register(model, api.PointCloud(points / 25.4))
