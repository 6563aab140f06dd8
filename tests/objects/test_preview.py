# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers of the live preview, without a window: what it shows last is what OK makes; coarse ones lie near it.

The scan is a bump of 1 mm on a plate with a noise of 0.02 mm, which bounds what is left after the deformation.
"""
from __future__ import annotations

from dataclasses import fields

import numpy as np
import Part
import pytest

from ffds_workbench import api
from ffds_workbench.api.certified import REBUILD_TOLERANCE
from ffds_workbench.gui.preview.face_on_scan import corners
from ffds_workbench.gui.preview.patches import Preview, figures
from ffds_workbench.registration.request import ISOMETRY, METHODS, RegistrationRequest
from ffds_workbench.registration.uv_raster import make_raster
from ffds_workbench.scan.cloud import PointCloud

NOISE = 0.02
TOP = ("Face6",)
REQUESTS = [
    *({"method": method, "faces": TOP, "lattice": lattice} for method in ("robust", "ffds", "ffd-hsu")
      for lattice in ("auto", (7, 5))),
    {"faces": TOP, "lattice": (25, 5)}, {"faces": TOP, "method": "ffds", "lattice": (25, 5)},
    {"faces": TOP, "stiffness": 50.0}, {"faces": TOP, "stiffness": 0.02}, {"faces": TOP, "gate": 0.1},
    {"faces": TOP, "freeze": ("Face1", "Face4")}, {"faces": ("Face6", "Face1")},
    {"faces": TOP, "method": "ffds", "source_points": 100}, {"faces": TOP, "method": "ffd-hsu", "source_points": 900},
    {"method": "ffds"}, {"method": "ffd-hsu"}, {"method": "ffds", "freeze": ("Face2",)},
    {}, {"isometry": "on", "stiffness": 20.0}, {"isometry": "off", "gate": 0.2, "freeze": ("Face5",)},
]


def test_every_method_and_setting_is_among_them():
    """But for what `actions.make_as_built` refuses, as an as-built part takes its scan as it lies and has no bands."""
    tried = {name for settings in REQUESTS for name in settings}
    assert tried == {field.name for field in fields(RegistrationRequest)} - {"sensor", "align"}
    assert {RegistrationRequest(**settings).method for settings in REQUESTS} == set(METHODS)
    assert {RegistrationRequest(**settings).isometry for settings in REQUESTS} == set(ISOMETRY)


def told(text: str) -> None:
    """Nobody listens."""


@pytest.fixture(scope="module")
def plate_and_scan() -> tuple[Part.Shape, PointCloud]:
    """A plate, and a scan of its top and of the side x = 0."""
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (8000, 2)).T
    top = np.stack([x, y, 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))], axis=1)
    y, z = random.uniform((0, 0), (40, 5), (1500, 2)).T
    side = np.stack([0.1 * np.sin(np.pi * y / 40), y, z], axis=1)
    top[:, 2] += random.normal(0, NOISE, len(top))
    side[:, 0] += random.normal(0, NOISE, len(side))
    return Part.makeBox(60, 40, 5), PointCloud(np.concatenate([top, side]))


@pytest.fixture(scope="module")
def preview() -> Preview:
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (20000, 2)).T
    z = 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2)) + random.normal(0, NOISE, 20000)
    return Preview(Part.makeBox(60, 40, 5), PointCloud(np.stack([x, y, z], axis=1)))


@pytest.mark.parametrize("settings", REQUESTS, ids=str)
def test_what_is_shown_last_is_what_ok_makes(plate_and_scan, settings):
    """Point by point of every face: a rebuilt face keeps its (u, v), so the preview's points are looked up there.

    They agree to twice the tolerance of the rebuilt surface, which the rebuild looks at in places of its own; or both
    refuse with the same sentence.
    """
    shape, scan = plate_and_scan
    request = RegistrationRequest(**settings)
    shown, made = _what(lambda: Preview(shape, scan).patches(request, False, told)), _what(
        lambda: api.run(request, shape, scan))
    if isinstance(made, str):
        assert shown == made
        return
    patches = {patch.name: patch for patch in shown}
    assert {made.part.faces[index].name for index in made.found.displacements} <= set(patches)
    for name, patch in patches.items():
        built = _points(made, made.part.index(name))
        assert np.linalg.norm(built - patch.points, axis=1).max() < 2 * REBUILD_TOLERANCE, name


@pytest.mark.parametrize("settings", REQUESTS, ids=str)
def test_while_a_control_moves_every_setting_has_a_preview_or_a_sentence(plate_and_scan, settings):
    patches = _what(lambda: Preview(*plate_and_scan).patches(RegistrationRequest(**settings), True, told))
    assert isinstance(patches, str) or all(np.isfinite(patch.points).all() for patch in patches)


def _what(work):
    """What comes of it, or the sentence of the refusal."""
    try:
        return work()
    except api.FfdsError as refusal:
        return str(refusal)


def _points(made: api.Result, index: int) -> np.ndarray:
    """The corners of a face's raster on the as-built face, (n, 3)."""
    geometry = made.part.geometry(index)
    u, v = corners(make_raster(geometry))
    u0, u1, v0, v1 = geometry.surface.range
    u, v = np.clip(u, u0, u1), np.clip(v, v0, v1)
    surface = made.shape.Faces[index].Surface
    return np.array([tuple(surface.value(a, b)) for a in u for b in v])


@pytest.mark.parametrize("settings", [RegistrationRequest(faces=TOP), RegistrationRequest()])
def test_coarse_and_exact_agree_to_the_noise(preview, settings):
    exact = preview.patches(settings, False, told)
    coarse = preview.patches(settings, True, told)
    for patches in (exact, coarse):
        before, _, after, p95, coverage = figures(patches)
        assert before > 0.2 and after < 2 * NOISE and p95 < 4 * NOISE and coverage > 0.1
    top = [next(patch for patch in patches if patch.name == "Face6").points for patches in (exact, coarse)]
    # Heights: how the top slides in itself one side of a plate hardly tells, and the coarse one leaves out what does.
    off = np.abs(top[0] - top[1])[:, 2]
    assert off.max() < 0.25 and off.mean() < 2 * NOISE


def test_a_stiff_part_stays_off_the_scan_and_comes_back(preview):
    soft, stiff = RegistrationRequest(), RegistrationRequest(stiffness=1e4)
    first = figures(preview.patches(soft, True, told))[2]
    for _ in range(4):
        off = figures(preview.patches(stiff, True, told))[2]
    assert off > 2 * first
    for _ in range(4):
        back = figures(preview.patches(soft, True, told))[2]
    assert back == pytest.approx(first, rel=0.1)


def test_frozen_faces_do_not_move(preview):
    patches = preview.patches(RegistrationRequest(freeze=("Face5",)), True, told)
    bottom = next(patch for patch in patches if patch.name == "Face5")
    assert np.abs(bottom.points[:, 2]).max() < 1e-6
