# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scripting surface on shapes and document objects, as it is used in FreeCAD's Python console."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import RESOURCES, api
from ffds_workbench.api import methods, other_part
from ffds_workbench.brep import workpiece
from ffds_workbench.scan.cloud import PointCloud

NOISE = 0.05


def _bump(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))


@pytest.fixture(scope="module")
def scan() -> np.ndarray:
    """Points on the bumped top of a plate of 60 × 40 × 5 mm."""
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (8000, 2)).T
    return np.stack([x, y, 5 + _bump(x, y) + random.normal(0, NOISE, 8000)], axis=1)


@pytest.mark.parametrize("method", ["robust", "ffds"])
def test_a_shape_and_an_array(scan, method):
    lattice = (7, 6) if method == "ffds" else "auto"
    result = api.register(Part.makeBox(60, 40, 5), scan, ["Face6"], method=method, lattice=lattice)
    x, y = np.meshgrid(np.linspace(4, 56, 14), np.linspace(4, 36, 9))
    top = result.shape.Faces[5]
    off = [abs(top.distToShape(Part.Vertex(a, b, 5 + _bump(a, b)))[0]) for a, b in zip(x.flat, y.flat, strict=True)]
    # robust: 0.05 mm / √(8000 / 100 degrees of freedom) = 0.006; ffds carries the noise of its 400 neighbours
    assert np.mean(off) < {"robust": 0.012, "ffds": 0.04}[method]
    assert result.certificate.problems() == []
    assert "before" in result.table()


def test_an_object_is_deformed_where_it_stands(scan):
    placement = FreeCAD.Placement(FreeCAD.Vector(100, -50, 20), FreeCAD.Rotation(FreeCAD.Vector(1, 1, 0), 35))
    document = FreeCAD.newDocument("Api", hidden=True, temp=True)
    try:
        plate = document.addObject("Part::Box", "Plate")
        plate.Length, plate.Width, plate.Height = 60, 40, 5
        plate.Placement = placement
        document.recompute()
        matrix = np.array(placement.toMatrix().A).reshape(4, 4)
        result = api.register(plate, scan @ matrix[:3, :3].T + matrix[:3, 3], ["Face6"])
        assert result.model.label == "Plate"
        np.testing.assert_allclose(result.shape.Placement.toMatrix().A, placement.toMatrix().A, atol=1e-9)
        peak = placement.multVec(FreeCAD.Vector(30, 20, 6))
        assert result.shape.distToShape(Part.Vertex(peak))[0] < 3 * NOISE / 3  # the top of the bump, well fitted
        assert plate.Shape.Volume == pytest.approx(12000)
    finally:
        FreeCAD.closeDocument(document.Name)


def test_frozen_faces_stay_as_they_are(scan):
    box = Part.makeBox(60, 40, 5)
    result = api.register(box, scan, ["Face6"], freeze=["Face1", "Face5"])
    for index in (0, 4):
        assert isinstance(result.shape.Faces[index].Surface, Part.Plane)
        assert result.shape.Faces[index].Area == pytest.approx(box.Faces[index].Area, rel=1e-9)


def test_stiffness_smooths_and_a_gate_above_the_noise_changes_nothing():
    """A bump of 1 mm, known to the noise of 0.03 mm."""
    box, random = Part.makeBox(60, 40, 5), np.random.default_rng(3)
    x, y = random.uniform((0, 0), (60, 40), (6000, 2)).T
    z = 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 8**2)) + random.normal(0, 0.03, 6000)
    scan = np.stack([x, y, z], axis=1)

    def top(**settings) -> float:
        shape = api.register(box, scan, ["Face6"], **settings).shape
        return 20 - shape.distToShape(Part.Vertex(30, 20, 20))[0]

    assert top() == pytest.approx(6, abs=0.03)
    assert top(stiffness=1e4) < 5.9 and top(stiffness=0.01) == pytest.approx(6, abs=0.05)
    assert top(gate=0.3) == pytest.approx(6, abs=0.03)
    whole = api.register(box, scan, stiffness=1e4).shape
    assert 20 - whole.distToShape(Part.Vertex(30, 20, 20))[0] < top()


def test_deviation_of_an_array():
    points = np.random.default_rng(0).uniform((1, 1, 5.2), (59, 39, 5.2), (500, 3))
    figures = api.deviation(Part.makeBox(60, 40, 5), points).report["deviation"]
    assert figures["signed_mean"] == pytest.approx(0.2, abs=1e-9)


def test_files_are_read(tmp_path):
    points = np.random.default_rng(0).uniform((1, 1, 5.2), (59, 39, 5.2), (500, 3))
    model, scan = tmp_path / "plate.step", tmp_path / "scan.xyz"
    Part.makeBox(60, 40, 5).exportStep(str(model))
    np.savetxt(scan, points)
    figures = api.deviation(str(model), scan).report["deviation"]
    assert figures["signed_mean"] == pytest.approx(0.2, abs=1e-9)


def test_progress_is_told(scan):
    told: list[str] = []
    api.deviation(Part.makeBox(60, 40, 5), scan, told.append)
    assert told


@pytest.mark.parametrize(("arguments", "message"), [
    ({"method": "magic"}, "unknown"), ({"lattice": (3, 8)}, "4 or more"), ({"faces": []}, "No face"),
    ({"faces": ["Face9"]}, "no Face9"), ({"freeze": ["Face9"]}, "no Face9"), ({"stiffness": 0}, "stiffness"),
    ({"gate": -1.0}, "above 0"), ({"gate": 1.0, "method": "ffds"}, "method robust")])
def test_requests_that_cannot_be_read(scan, arguments, message):
    with pytest.raises(api.InputError, match=message):
        api.register(Part.makeBox(60, 40, 5), scan, **arguments)


@pytest.mark.parametrize("other", ["cylinder", "shifted"])
def test_a_scan_of_another_part_or_place_is_refused_before_the_solve(other, monkeypatch):
    """A cylinder through the bracket of the example, and the bracket's own scan 25 mm aside."""
    model = api.read_model(RESOURCES / "examples" / "bracket.step")
    if other == "cylinder":
        cylinder = Part.makeCylinder(30, 100, FreeCAD.Vector(55, 35, -20))
        points, message = api.simulate(cylinder, api.SensorSettings(spacing=1.5)).scan.points, "not show this part"
    else:
        points = api.read_scan(RESOURCES / "examples" / "bracket_scan.ply").points[::4] + [0.0, 25.0, 10.0]
        message = "mm off the part: align it"
    monkeypatch.setattr(methods, "register_joint", lambda *_: pytest.fail("the solve was begun"))
    with pytest.raises(api.RefusedError, match=message):
        api.register(model, points)


def test_a_scan_near_the_edges_of_all_faces_is_told_by_these_alone(monkeypatch):
    """Of a bar that is thin beside its length no face has to be looked at."""
    monkeypatch.setattr(other_part, "make_raster", lambda *_: pytest.fail("a face was looked at"))
    points = np.random.default_rng(3).uniform([0, 0, 4], [100, 4, 4], (500, 3))
    other_part.refuse_other_part(workpiece.read(Part.makeBox(100, 4, 4)), PointCloud(points))


def test_an_array_of_another_shape():
    with pytest.raises(api.InputError, match=r"\(n, 3\)"):
        api.deviation(Part.makeBox(1, 1, 1), np.zeros((5, 2)))


def test_a_hidden_face_is_carried_and_its_band_is_wider():
    """The same plate with its underside scanned or not: only the underside's flag changes, and its band grows."""
    random = np.random.default_rng(2)
    sides = []
    for z in (5.0, 0.0):
        x, y = random.uniform((0, 0), (60, 40), (8000, 2)).T
        sides.append(np.stack([x, y, z + _bump(x, y) + random.normal(0, NOISE, 8000)], axis=1))
    seen, hidden = (api.register(Part.makeBox(60, 40, 5), np.concatenate(sides[:count])).report for count in (2, 1))
    faces = [{face["name"]: face for face in report["faces"]} for report in (seen, hidden)]
    assert [face["Face5"]["flag"] for face in faces] == ["observed", "carried"]
    assert [face["Face6"]["flag"] for face in faces] == ["observed", "observed"]
    assert faces[1]["Face5"]["band"] > 2 * faces[0]["Face5"]["band"]
    assert faces[1]["Face6"]["band"] < 2 * faces[0]["Face6"]["band"]
    below = [edge for edge in hidden["edges"] if set(edge["along"]["flags"]) == {"carried"}]
    assert below and all(len(edge["along"]["bands"]) == len(edge["along"]["flags"]) for edge in hidden["edges"])


def test_before_is_what_the_deviation_of_the_nominal_is():
    """A plate of 5 mm whose top is seen 3 mm too low: its points are nearer to the bottom before, not after."""
    random = np.random.default_rng(2)
    sides = [np.column_stack([random.uniform((0, 0), (60, 40), (8000, 2)), np.full(8000, z)]) for z in (2.0, -3.0)]
    points = np.concatenate(sides) + random.normal(0, NOISE, (16000, 3)) * [0, 0, 1]
    nominal = Part.makeBox(60, 40, 5)
    result = api.register(nominal, points)
    assert result.report["deviation_before"] == api.deviation(nominal, points).report["deviation"]
    after = api.deviation(result.shape, points).report["deviation"]
    assert result.report["deviation_after"] == pytest.approx(after, abs=1e-9)
    assert result.report["deviation_before"]["mean"] == pytest.approx(2.5, abs=0.1)


def test_an_edge_of_no_face_stays_and_is_named(scan):
    line = Part.makeLine(FreeCAD.Vector(0, 0, 9), FreeCAD.Vector(60, 0, 9))
    plate = Part.makeCompound([Part.makeBox(60, 40, 5), line])
    result = api.register(plate, scan)
    assert result.report["sheet"]["loose"] == ["Edge13"] and "Edge13 bounds no face" in result.table()
    assert result.report["edges"][12]["flag"] == "nominal"
    assert result.shape.Edges[12].CenterOfMass == plate.Edges[12].CenterOfMass


@pytest.mark.parametrize("shift, sentence", [(0.0, ""), (15.0, "mm off the part: align it")])
def test_a_body_of_revolution_is_not_off_itself_however_it_is_turned(shift, sentence):
    """Its pose is found anywhere about its axis; what counts is how far the scan lies off its surface."""
    shape = Part.makeCylinder(20, 40).fuse(Part.makeCylinder(10, 60)).removeSplitter()
    corners, triangles = shape.tessellate(0.01)
    corner = np.array([tuple(corners[k]) for triangle in triangles for k in triangle]).reshape(-1, 3, 3)
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    random = np.random.default_rng(1)
    chosen = corner[random.choice(len(area), 20000, p=area / area.sum())]
    points = np.einsum("nk,nkx->nx", random.dirichlet(np.ones(3), 20000), chosen) + random.normal(0, NOISE, (20000, 3))
    part, cloud = workpiece.read(shape), PointCloud(points + [shift, 0, 0])
    text = other_part.far_scan_refusal(part, cloud, other_part.on_faces(part), 4.0)
    assert bool(text) == bool(sentence) and sentence in text
