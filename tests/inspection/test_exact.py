# SPDX-License-Identifier: LGPL-2.1-or-later
"""Values on exact shapes with known form errors: a plate with a hole, moved by fields whose zones have closed forms."""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.face_displacement import FaceDisplacement
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.inspection.inspect import inspect_shapes
from ffds_workbench.inspection.known_errors import known_errors
from ffds_workbench.inspection.plan import plan_of
from ffds_workbench.inspection.sampling import PartPair

MICROMETRE = 1e-3
X, Y = 20.0, 20.0


@pytest.fixture(scope="module")
def part():
    """60 × 40 × 5 mm, with a hole of 6 mm radius at (20, 20)."""
    return workpiece.read(Part.makeBox(60, 40, 5).cut(Part.makeCylinder(6, 5, Part.Vertex(X, Y, 0).Point)))


def named(part, test):
    """The face whose surface and middle pass a test."""
    return next(face.name for face in part.faces if test(face.own_surface, face.face.CenterOfMass))


@pytest.fixture(scope="module")
def faces(part):
    return {"top": named(part, lambda s, c: abs(c.z - 5) < 1e-6), "bottom": named(part, lambda s, c: abs(c.z) < 1e-6),
            "left": named(part, lambda s, c: abs(c.x) < 1e-6), "right": named(part, lambda s, c: abs(c.x - 60) < 1e-6),
            "front": named(part, lambda s, c: abs(c.y) < 1e-6),
            "hole": named(part, lambda s, c: isinstance(s, Part.Cylinder))}


def inspected(part, move, *items, datums=None, report=None):
    """The items of a plan on the part that a field has moved."""
    moving = {face.index: FaceDisplacement(lambda uv, points: move(points), *[np.linspace(*box, 14)[1:-1] for box in (
        face.geometry.surface.range[:2], face.geometry.surface.range[2:])]) for face in part.faces}
    built = workpiece.read(rebuild(part, moving, 1e-5))
    plan = plan_of({"datums": datums or {}, "items": [dict(zip(("characteristic", "of", "tolerance", "datums"), item,
                                                               strict=False)) for item in items]})
    return inspect_shapes(plan, PartPair(part, built, known_errors(report))).items


def along(axis, size):
    """A field along one axis."""
    return lambda points: size(points)[:, None] * np.eye(3)[axis]


def on_top(points):
    """1 on the upper face, 0 on the lower one."""
    return points[:, 2] / 5


def test_flatness_of_a_cubic(part, faces):
    """Chebyshev: the line nearest to t³ on −1 … 1 is ¾ t, within ¼; least squares takes 3/5 t over a plate without its
    hole, within 2/5."""
    [item] = inspected(part, along(2, lambda p: 0.1 * on_top(p) * ((p[:, 0] - 30) / 30) ** 3),
                       ("flatness", faces["top"], 0.06))
    assert item.value == pytest.approx(0.05, abs=MICROMETRE)
    assert item.least_squares == pytest.approx(0.08, rel=0.05) and item.least_squares > item.value
    assert item.verdict == "pass" and item.band == pytest.approx(0.0, abs=1e-12)  # rounding alone


@pytest.mark.parametrize(("lobes", "kind"), [(2, "roundness"), (3, "roundness"), (3, "cylindricity")])
def test_lobes_of_a_hole(part, faces, lobes, kind):
    """r = 6 + a cos kθ lies between two circles about the axis that it touches in turn: 2a."""
    def move(points):
        angle = np.arctan2(points[:, 1] - Y, points[:, 0] - X)
        fade = np.exp(-((np.hypot(points[:, 0] - X, points[:, 1] - Y) - 6) / 3) ** 2)
        size = 0.02 * np.cos(lobes * angle) * fade
        return np.column_stack([size * np.cos(angle), size * np.sin(angle), np.zeros(len(points))])

    [item] = inspected(part, move, (kind, faces["hole"], 0.03))
    assert item.value == pytest.approx(0.04, abs=MICROMETRE) and item.verdict == "fail"


def test_orientation(part, faces):
    """Tilted by 1 in 1000: 0.06 over 60 mm of the top; 0.005 over 5 mm of the left side."""
    top, side = inspected(part, lambda p: np.column_stack([1e-3 * p[:, 2], 0 * p[:, 0], 1e-3 * on_top(p) * p[:, 0]]),
                          ("parallelism", faces["top"], 0.1, ["A"]), ("perpendicularity", faces["left"], 0.1, ["A"]),
                          datums={"A": faces["bottom"]})
    assert top.value == pytest.approx(0.06, abs=MICROMETRE)
    assert side.value == pytest.approx(0.005, abs=MICROMETRE)


def test_a_part_that_lies_elsewhere_has_the_same_form_and_position(part, faces):
    """Moved as a whole by 0.5 mm and turned by 2 mrad: against its own datums nothing is off."""
    angle = 2e-3
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    items = inspected(part, lambda p: p @ turn.T - p + [0.3, -0.4, 0.2],
                      ("position", faces["hole"], 0.1, ["A", "B", "C"]), ("profile_surface", faces["right"], 0.1,
                                                                          ["A", "B", "C"]),
                      ("profile_surface", faces["top"], 0.1), ("flatness", faces["top"], 0.1),
                      datums={"A": faces["bottom"], "B": faces["front"], "C": faces["left"]})
    assert [item.value for item in items] == pytest.approx([0.0] * 4, abs=MICROMETRE)


def test_position_and_diameter(part, faces):
    """The hole has moved by (0.03, 0.04) and grown by 0.02 in radius: 2 · 0.05 and 12.04; at the most material, 12 mm,
    the tolerance grows by 0.04."""
    def move(points):
        off = points[:, :2] - [X, Y]
        distance = np.linalg.norm(off, axis=1)
        fade = np.exp(-(np.maximum(distance - 6, 0) / 4) ** 2)[:, None]
        return np.column_stack([fade * (0.02 * off / np.maximum(distance, 1e-9)[:, None] + [0.03, 0.04]),
                                np.zeros(len(points))])

    plan = {"A": faces["bottom"], "B": faces["front"], "C": faces["left"]}
    position, size = inspected(part, move, ("position", faces["hole"], 0.11, ["A", "B", "C"]),
                               ("diameter", faces["hole"], 0.05), datums=plan)
    assert position.value == pytest.approx(0.1, abs=MICROMETRE) and position.verdict == "pass"
    assert size.value == pytest.approx(12.04, abs=MICROMETRE) and size.nominal == pytest.approx(12.0)


def test_dimensions(part, faces):
    """The top is 0.1 mm higher and the right side leans outwards by 0.05 mm at the top: 0.01 rad, 0.573°."""
    thick, length, angle, wall = inspected(
        part, lambda p: np.column_stack([0.05 * on_top(p) * p[:, 0] / 60, 0 * p[:, 0], 0.1 * on_top(p)]),
        ("distance", [faces["bottom"], faces["top"]], 0.2), ("distance", [faces["left"], faces["right"]], 0.05),
        ("angle", [faces["bottom"], faces["right"]], 1), ("thickness", [faces["top"], faces["bottom"]], 0.05))
    assert thick.value == pytest.approx(5.1, abs=MICROMETRE) and thick.verdict == "pass"
    assert length.value == pytest.approx(60.025, abs=MICROMETRE)
    assert angle.value == pytest.approx(90 - np.degrees(0.05 / 5.1), abs=0.01)
    assert wall.value == pytest.approx(5.1, abs=MICROMETRE) and wall.verdict == "fail"


def test_profile_and_straightness(part, faces):
    """A bow of 0.05 mm in the front face: its upper edge fills a tube of 0.05 mm, its surface 0.025 mm to either side
    of where it fits best."""
    edge = next(f"Edge{k}" for k, edge in enumerate(part.edges, 1) if abs(edge.Length - 60) < 1e-6
                and abs(edge.CenterOfMass.y) < 1e-6 and abs(edge.CenterOfMass.z - 5) < 1e-6)
    bow = along(1, lambda p: 0.05 * (1 - ((p[:, 0] - 30) / 30) ** 2) * (1 - p[:, 1] / 40))
    line, surface, profile = inspected(part, bow, ("straightness", edge, 0.1), ("profile_surface", faces["front"], 0.1),
                                       ("profile_line", edge, 0.2, ["A", "B", "C"]),
                                       datums={"A": faces["bottom"], "B": faces["left"], "C": faces["right"]})
    assert line.value == pytest.approx(0.05, abs=MICROMETRE)
    assert surface.value == pytest.approx(0.05, abs=MICROMETRE)
    assert profile.value <= 0.1 + MICROMETRE  # 2 · 0.05 where it may not shift along y


def test_gap_and_flush():
    """Two plates 0.8 mm apart, the second one 0.3 mm lower."""
    first, second = Part.makeBox(20, 30, 5), Part.makeBox(20, 30, 5)
    second.translate(Part.Vertex(20.8, 0, -0.3).Point)
    part = workpiece.read(Part.makeCompound([first, second]))
    edges = [f"Edge{k}" for k, edge in enumerate(part.edges, 1) if abs(edge.Length - 30) < 1e-6 and (
        (edge.CenterOfMass - Part.Vertex(20, 15, 5).Point).Length < 1e-6
        or (edge.CenterOfMass - Part.Vertex(20.8, 15, 4.7).Point).Length < 1e-6)]
    top = part.topology.edge_faces[int(edges[0][4:]) - 1]
    gap, flush = inspected(part, lambda p: np.zeros_like(p), ("gap", edges, 0.1), ("flush", edges, 0.1))
    seen = part.faces[top[0]].face.normalAt(0, 0)
    if abs(seen.z) > 0.5:  # the edge's first face is the upper one
        assert (gap.value, flush.value) == pytest.approx((0.8, -0.3), abs=1e-6)
    else:
        assert (abs(gap.value), abs(flush.value)) == pytest.approx((0.3, 0.8), abs=1e-6)
