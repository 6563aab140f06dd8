# SPDX-License-Identifier: LGPL-2.1-or-later
"""The certificate against shapes whose flaws are known because they were put there."""
from __future__ import annotations

from dataclasses import replace

import FreeCAD
import Part
import pytest

from ffds_workbench.errors import RefusedError
from ffds_workbench.report.boolean_check import boolean_checks
from ffds_workbench.report.certificate import Certificate, condition, enforce, structure

SHIFT = 0.0125


def certify(nominal, result, boolean_limit=60.0):
    """The certificate of a shape as it is, with the check for Boolean operations where that has a limit in seconds."""
    checks = [(None,)] * 2 if boolean_limit is None else boolean_checks((nominal, result), boolean_limit)
    return Certificate(*map(condition, (nominal, result), checks))


def box_with_shifted_edge() -> Part.Shape:
    """A box whose edge curve along z through the origin stands SHIFT mm off its faces and vertices."""
    text = Part.makeBox(10, 20, 30).exportBrepToString()
    line = "\n1 0 0 0 0 0 1 \n"
    assert text.count(line) == 1
    shape = Part.Shape()
    shape.importBrepFromString(text.replace(line, f"\n1 {SHIFT} 0 0 0 0 1 \n"))
    return shape


def test_a_clean_box_is_clean():
    box = Part.makeBox(10, 20, 30)
    certificate = certify(box, box.copy())
    assert certificate.problems() == []
    enforce(certificate.before, certificate.after)
    counts = {"compounds": 0, "solids": 1, "shells": 1, "faces": 6, "wires": 6, "edges": 12, "vertices": 8}
    assert certificate.as_dict() == {
        "before": counts, "after": counts, "order_kept": True, "valid": True, "closed": True,
        "max_edge_gap": {"before": pytest.approx(0, abs=1e-12), "after": pytest.approx(0, abs=1e-12)},
        "max_tolerance": {"before": 1e-7, "after": 1e-7}, "boolean_check": {"before": 0, "after": 0}}


def filleted_box() -> Part.Shape:
    box = Part.makeBox(9, 9, 9)
    return box.makeFillet(2, box.Edges)


@pytest.mark.parametrize("shape", [Part.makeCylinder(5, 10), Part.makeSphere(7), Part.makeCone(5, 0, 9),
                                   Part.makeTorus(9, 2), filleted_box()],
                         ids=["cylinder", "sphere", "cone", "torus", "filleted box"])
def test_analytic_shapes_have_no_gap(shape):
    """Rounding of coordinates of about 10 mm is 1e-15; OCCT's fillets are exact to 1e-12."""
    placed = shape.copy()
    placed.Placement = FreeCAD.Placement(FreeCAD.Vector(100, -50, 30), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    assert condition(placed).max_edge_gap < 1e-11


def test_a_known_gap_is_found():
    shifted = box_with_shifted_edge()
    found = condition(shifted)
    assert found.max_edge_gap == pytest.approx(SHIFT, abs=1e-9)
    assert found.gap_at == next(f"Edge{number}" for number, edge in enumerate(shifted.Edges, 1)
                                if not any(vertex.X or vertex.Y for vertex in edge.Vertexes))


def test_a_grown_gap_is_a_problem_beyond_the_nominals_own():
    box, shifted = Part.makeBox(10, 20, 30), box_with_shifted_edge()
    grown = certify(box, shifted, boolean_limit=None)
    assert any(f"gap grew from 0 to 0.013 mm, at {grown.after.gap_at}." in sentence for sentence in grown.problems())
    assert grown.excess_gap == pytest.approx(SHIFT, abs=1e-9)
    assert certify(shifted, shifted, boolean_limit=None).excess_gap == 0


def test_a_grown_tolerance_is_a_problem():
    box, loose = Part.makeBox(10, 20, 30), Part.makeBox(10, 20, 30)
    loose.Vertexes[4].fixTolerance(0.01)
    assert "from 1e-07 to 0.01 mm, at Vertex5." in certify(box, loose, None).problems()[-1]
    assert not certify(loose, loose, None).problems()


def test_lost_faces_are_refused():
    box = Part.makeBox(10, 20, 30)
    with pytest.raises(RefusedError, match="faces changed from 7 to 6"):
        enforce(structure(box.makeFillet(1, box.Edges[:1])), structure(box))


def test_changed_order_is_refused():
    box, cylinder = Part.makeBox(10, 10, 10), Part.makeCylinder(3, 9, FreeCAD.Vector(30, 0, 0))
    certificate = certify(Part.makeCompound([box, cylinder]), Part.makeCompound([cylinder, box]), None)
    assert certificate.as_dict()["order_kept"] is False
    with pytest.raises(RefusedError, match="order"):
        enforce(certificate.before, certificate.after)


def test_opened_and_invalid_shapes_are_refused():
    sound = condition(Part.makeBox(10, 20, 30))
    for spoiled, word in ((replace(sound, closed_shells=(False,)), "closed"),
                          (replace(sound, invalid=("Face3",)), "not valid: Face3")):
        with pytest.raises(RefusedError, match=word):
            enforce(sound, spoiled)
    enforce(replace(sound, closed_shells=(False,)), sound)
    enforce(replace(sound, invalid=("Face2", "Face3")), replace(sound, invalid=("Face3",)))
    with pytest.raises(RefusedError, match="not valid: Edge4"):
        enforce(replace(sound, invalid=("Face3",)), replace(sound, invalid=("Edge4", "Face3")))


def test_more_boolean_errors_are_a_problem():
    sound = condition(Part.makeBox(10, 20, 30), (0, 4))
    for after, sentence in (((2, 0), "reports 2 errors, 0 before"), ((3, 6), "reports 9 errors, 4 before"),
                            ((None, 5), "reports 5 errors, 4 before")):
        worse = Certificate(sound, replace(sound, boolean_check=after)).problems()
        assert len(worse) == 1 and sentence in worse[0]
    for after in ((0, 4), (0, 0), (0, None), (None,)):
        assert not Certificate(sound, replace(sound, boolean_check=after)).problems()
