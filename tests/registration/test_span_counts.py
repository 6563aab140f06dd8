# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many spans the displacement of a face gets: by the size of its solid, in all units and frames."""
import pytest

pytest.importorskip("FreeCAD")
import FreeCAD
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.surfaces import solid_sizes, span_counts


def counts(shape, least=1e-6, finer=None):
    part, settings = joint_part(read(shape)), JointSettings()
    sizes = solid_sizes(part.faces, part.solids)
    return span_counts(part.faces, sizes, settings.spans, settings.turning, least, finer)


def tube(length, width, radius, wall):
    """A rectangular hollow section with rounded corners, along z."""
    def profile(width, radius):
        box = Part.makeBox(width, width, length, FreeCAD.Vector(-width / 2, -width / 2, 0))
        return box.makeFillet(radius, [e for e in box.Edges if abs(e.tangentAt(e.FirstParameter).z) > 0.9])

    return profile(width, radius).cut(profile(width - 2 * wall, radius - wall)).Solids[0]


@pytest.mark.parametrize("scale", [0.1, 30.0])
def test_a_part_has_the_same_lattices_in_any_size(scale):
    def shape(scale):
        plate = Part.makeBox(80 * scale, 60 * scale, 3 * scale)
        return plate.cut(Part.makeCylinder(7 * scale, 9 * scale, FreeCAD.Vector(30, 20, -1) * scale)).Solids[0]

    assert counts(shape(scale)) == counts(shape(1.0))


def test_a_turned_part_has_the_same_lattices():
    shape = tube(300, 40, 6, 3)
    turned = shape.copy()
    turned.Placement = FreeCAD.Placement(FreeCAD.Vector(10, 20, 30), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    assert counts(turned) == counts(shape)


def test_a_long_tube_has_spans_along_it_and_few_across():
    """Eleven over its length; its corners, a hundredth of it, take their quarter of a turn in one or two."""
    for u, v in counts(tube(1100, 60, 8, 4)):
        assert sorted((u, v))[0] <= 2
        assert sorted((u, v))[1] <= 12


def test_solids_of_an_assembly_have_spans_of_their_own_size():
    large, small = Part.makeBox(1000, 60, 60), Part.makeBox(100, 6, 6, FreeCAD.Vector(0, 60, 0))
    both = counts(Part.makeCompound([large, small]))
    assert both[:6] == both[6:] == counts(large)


def test_a_span_is_never_smaller_than_what_the_scan_fills():
    assert max(max(pair) for pair in counts(Part.makeBox(100, 60, 30), least=50.0)) == 2


def test_finer_spans_are_divided_along_their_longer_side():
    """Faces of a rod of 100 × 6 × 6 have spans of 9 × 6, its ends one of 6 × 6."""
    shape = Part.makeBox(100, 6, 6)
    for before, after in zip(counts(shape), counts(shape, finer=dict.fromkeys(range(6), 2)), strict=True):
        assert after == tuple(2 * n for n in before)
    shape = Part.makeBox(100, 3, 3)
    assert {tuple(sorted(pair)) for pair in counts(shape, finer=dict.fromkeys(range(6), 2))} == {(1, 22), (2, 2)}
