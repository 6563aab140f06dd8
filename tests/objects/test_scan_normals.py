# SPDX-License-Identifier: LGPL-2.1-or-later
"""The normals of scans in a document: kept, turned with their points, and used."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Points
import pytest

from ffds_workbench.api import certified
from ffds_workbench.objects import actions, scans
from ffds_workbench.objects.as_built import report_of
from ffds_workbench.objects.jobs.registration_job import job_on, make_job
from ffds_workbench.registration.request import RegistrationRequest
from ffds_workbench.scan.cloud import PointCloud
from ffds_workbench.scan.sensor.files import write_ply

_RANDOM = np.random.default_rng(7)
POINTS = _RANDOM.uniform(0, 50, (500, 3))
NORMALS = _RANDOM.normal(size=(500, 3))
NORMALS /= np.linalg.norm(NORMALS, axis=1, keepdims=True)
SINGLE = 2e-7
"""Documents hold normals in single precision: half a step at 1 is 6e-8 for each component."""
TURN = FreeCAD.Placement(FreeCAD.Vector(3, -2, 1), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90))


@pytest.fixture
def document():
    created = FreeCAD.newDocument("normals_test")
    yield created
    FreeCAD.closeDocument(created.Name)


def test_kept_in_a_file_and_turned_with_the_scan(document, tmp_path):
    item = scans.add_scan(document, POINTS, "scan", NORMALS)
    np.testing.assert_allclose(scans.scan_cloud(item).normals, NORMALS, atol=SINGLE)
    item.Placement = TURN
    document.saveCopy(str(tmp_path / "kept.FCStd"))
    again = FreeCAD.openDocument(str(tmp_path / "kept.FCStd"))
    cloud = scans.scan_cloud(again.Objects[0])
    FreeCAD.closeDocument(again.Name)
    np.testing.assert_allclose(cloud.normals, NORMALS @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]), atol=SINGLE)


def test_those_of_freecads_own_import_are_read(document, tmp_path):
    write_ply(tmp_path / "scan.ply", POINTS, NORMALS)
    Points.insert(str(tmp_path / "scan.ply"), document.Name)
    np.testing.assert_allclose(scans.scan_cloud(document.Objects[0]).normals, NORMALS, atol=SINGLE)


def test_other_points_do_not_keep_them(document):
    item = scans.add_scan(document, POINTS, "scan", NORMALS)
    scans.set_points(item, POINTS[::2])
    assert scans.scan_cloud(item).normals is None
    scans.set_points(item, POINTS, NORMALS)
    assert scans.scan_cloud(item).normals is not None
    item.Normal = item.Normal[:9]
    assert scans.scan_cloud(item).normals is None


def test_aligned_by_points_they_turn_too(document):
    item = scans.add_scan(document, POINTS, "scan", NORMALS)
    part = document.addObject("Part::Box", "Part")
    document.recompute()
    corners = [(0, 0, 0), (10, 0, 0), (0, 10, 0)]
    actions.align_by_points(part, item, corners, [(0, 0, 0), (0, 10, 0), (-10, 0, 0)], refine=False)
    np.testing.assert_allclose(scans.scan_cloud(item).normals, NORMALS @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
                               atol=SINGLE)


def test_they_tell_the_skin_of_a_sheet_that_stands_turned(document, tmp_path, monkeypatch):
    """A sheet of 2 mm whose upper side is seen 1 mm lower: points alone do not tell that it is not the lower one."""
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)
    sheet = document.addObject("Part::Box", "Sheet")
    sheet.Length, sheet.Width, sheet.Height = 60, 50, 2
    sheet.Placement = TURN
    document.recompute()
    generator = np.random.default_rng(3)
    seen = np.column_stack([generator.uniform(3, (57, 47), (30_000, 2)), 1 + generator.normal(0, 0.05, 30_000)])
    scan = PointCloud(seen, normals=np.tile([0.0, 0.0, 1.0], (30_000, 1)))
    scan = scan.moved(np.array(TURN.toMatrix().A).reshape(4, 4))
    for name, normals in (("plain", None), ("with normals", scan.normals)):
        write_ply(tmp_path / f"{name}.ply", scan.points, normals)
    item = actions.import_scan(document, str(tmp_path / "plain.ply"))
    guessed = report_of(actions.make_as_built(sheet, item))
    assert guessed["sheet"]["unsure"] == pytest.approx(2.0, abs=0.05)
    beforehand = scans.as_stored(item, scan)
    actions.replace_scan(item, str(tmp_path / "with normals.ply"))
    request = RegistrationRequest()
    assert job_on(sheet, beforehand, request).digest == make_job(sheet, item, request).digest
    built = actions.make_as_built(sheet, item)
    # Both sides went down by 1 mm, known to 0.05 mm / √30000.
    assert built.Shape.Volume == pytest.approx(sheet.Shape.Volume, rel=0.01)
    assert built.Shape.CenterOfMass.z == pytest.approx(TURN.Base.z, abs=0.01)
