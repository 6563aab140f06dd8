# SPDX-License-Identifier: LGPL-2.1-or-later
"""The topology certificate: whether an as-built shape keeps the topology of its nominal, and how tightly it closes.

Judges two shapes and changes neither. OCCT evaluates every curve and surface here, so that the verdict does not rest
on the spline code that made the result.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import FreeCAD
import numpy as np
import Part

from ..brep import topology
from ..brep.topology import Topology
from ..brep.validity import invalid_parts, listed
from ..errors import RefusedError
from ..registration.arrays import Array
from .boolean_check import BodyErrors, total

GAP_LIMIT = 1e-4
"""Largest edge gap beyond the nominal's own in mm."""
TOLERANCE_LIMIT = 1e-3
"""Largest tolerance in mm, where neither the nominal's own nor its edge gap, which it has to cover, is larger."""
_UNIFORM_SAMPLES = 65
_SAMPLES_PER_SPAN = 2
_AROUND_LARGEST = 17


@dataclass(frozen=True)
class Structure:
    """What a deformation must keep of a shape.

    Attributes
    ----------
    topology : adjacency by index
    invalid : names of the sub-shapes that OCCT's check finds fault with
    closed_shells : for each shell, whether it is closed
    """

    topology: Topology
    invalid: tuple[str, ...]
    closed_shells: tuple[bool, ...]

    @property
    def valid(self) -> bool:
        return not self.invalid

    @property
    def closed(self) -> bool:
        return bool(self.closed_shells) and all(self.closed_shells)


@dataclass(frozen=True)
class Condition(Structure):
    """How sound one shape is.

    Attributes
    ----------
    max_edge_gap : largest distance in mm between an edge's curve and one of its faces at the same parameter, and
        between an edge's end and its vertex
    max_tolerance : largest tolerance of a face, edge or vertex in mm
    gap_at, tolerance_at : names of the edge that gapes so, and of the sub-shape with that tolerance
    boolean_check : errors that the check for Boolean operations reports for each body by itself; None where it did not
        run or did not finish. Where bodies touch or run into each other is no flaw of either
    """

    max_edge_gap: float
    max_tolerance: float
    gap_at: str
    tolerance_at: str
    boolean_check: BodyErrors = (None,)

    @property
    def boolean_errors(self) -> int | None:
        """Errors that the check for Boolean operations reports for all bodies; None where it did not finish."""
        return total(self.boolean_check)


@dataclass(frozen=True)
class Certificate:
    """The condition of a shape before and after its deformation."""

    before: Condition
    after: Condition

    @property
    def excess_gap(self) -> float:
        """Largest edge gap beyond the nominal's own in mm."""
        return max(0.0, self.after.max_edge_gap - self.before.max_edge_gap)

    @property
    def tolerance_line(self) -> float:
        """What the largest tolerance may be, in mm."""
        return max(self.before.max_tolerance, self.before.max_edge_gap + GAP_LIMIT, TOLERANCE_LIMIT)

    def problems(self) -> list[str]:
        """One sentence for everything that is worse than before; empty for a clean result."""
        sentences = broken(self.before, self.after) + self.looser()
        worse = [(was, count) for was, count in zip(self.before.boolean_check, self.after.boolean_check, strict=False)
                 if count is not None and count > (was or 0)]
        if worse:
            known = [was for was, _ in worse if was is not None]
            was = sum(known) if len(known) == len(worse) else "an unknown number of"
            count = sum(count for _, count in worse)
            sentences.append(f"The check for Boolean operations reports {count} errors, {was} before.")
        return sentences

    def looser(self) -> list[str]:
        """One sentence each where edges gape or tolerances are larger than they may be."""
        sentences = []
        if self.excess_gap > GAP_LIMIT:
            sentences.append(f"The largest edge gap grew from {self.before.max_edge_gap:.2g} to "
                             f"{self.after.max_edge_gap:.2g} mm, at {self.after.gap_at}.")
        if self.after.max_tolerance > self.tolerance_line:
            sentences.append(f"The largest tolerance grew from {self.before.max_tolerance:.2g} to "
                             f"{self.after.max_tolerance:.2g} mm, at {self.after.tolerance_at}.")
        return sentences

    def as_dict(self) -> dict[str, object]:
        """The report's ``topology`` block; lengths in mm."""
        before, after = self.before, self.after
        return {"before": before.topology.counts, "after": after.topology.counts,
                "order_kept": before.topology == after.topology,
                "valid": after.valid, "closed": after.closed,
                "max_edge_gap": {"before": before.max_edge_gap, "after": after.max_edge_gap},
                "max_tolerance": {"before": before.max_tolerance, "after": after.max_tolerance},
                "boolean_check": {"before": before.boolean_errors, "after": after.boolean_errors}}


def broken(before: Structure, after: Structure) -> list[str]:
    """One sentence for every reason to refuse a deformed shape; empty if there is none."""
    counts = before.topology.counts, after.topology.counts
    sentences = [f"The number of {kind} changed from {counts[0][kind]} to {counts[1][kind]}."
                 for kind in counts[0] if counts[0][kind] != counts[1][kind]]
    if not sentences and before.topology != after.topology:
        sentences.append("The order of the faces, edges or vertices changed.")
    worse = [name for name in after.invalid if name not in before.invalid]
    if worse:
        sentences.append(f"The shape is not valid: {listed(worse)}.")
    if not sentences:
        opened = [i + 1 for i, (was, is_now) in enumerate(zip(before.closed_shells, after.closed_shells, strict=True))
                  if was and not is_now]
        sentences += [f"Shell {number} is no longer closed." for number in opened]
    return sentences


def enforce(before: Structure, after: Structure) -> None:
    """Refuse a shape that lost its topology.

    Raises
    ------
    RefusedError
        The result is not valid where it was before, lost a sub-shape, changed its order or opened.
    """
    lost = broken(before, after)
    if lost:
        raise RefusedError("The deformed model lost its topology and was not written: " + " ".join(lost))


def structure(shape: Part.Shape) -> Structure:
    """What of a shape its deformation must keep."""
    return Structure(topology.read(shape), invalid_parts(shape), tuple(bool(s.isClosed()) for s in shape.Shells))


def condition(shape: Part.Shape, boolean_check: BodyErrors = (None,), known: Structure | None = None) -> Condition:
    """The condition of one shape; ``boolean_check`` is taken from `boolean_checks`, ``known`` from `structure`."""
    own = known or structure(shape)
    gap, tolerance = max_edge_gap(shape, own.topology), max_tolerance(shape)
    return Condition(own.topology, own.invalid, own.closed_shells, gap[0], tolerance[0], gap[1], tolerance[1],
                     boolean_check)


def max_tolerance(shape: Part.Shape) -> tuple[float, str]:
    """Largest tolerance of a face, edge or vertex in mm, and which of them has it."""
    named = (("Face", shape.Faces), ("Edge", shape.Edges), ("Vertex", shape.Vertexes))
    return max(((float(part.Tolerance), f"{kind}{number}") for kind, parts in named
                for number, part in enumerate(parts, 1)), key=lambda found: found[0])


def max_edge_gap(shape: Part.Shape, adjacency: Topology) -> tuple[float, str]:
    """Largest distance in mm between an edge and its faces, through the pcurves, and between its ends and vertices, and
    which edge that is."""
    ends = [(distance, number) for number, edge in enumerate(shape.Edges) if not edge.Degenerated
            for distance in _end_gaps(edge)]
    sides = [(distance, number) for face, numbers in zip(shape.Faces, adjacency.face_edges, strict=True)
             for edge, number in zip(face.Edges, numbers, strict=True) if not edge.Degenerated
             for distance in _side_gaps(face, edge)]
    largest, number = max(ends + sides, default=(0.0, 0), key=lambda found: found[0])
    return float(largest), f"Edge{number + 1}"


def _end_gaps(edge: Part.Edge) -> list[float]:
    """Distance of every vertex of the edge from the nearer end of its curve."""
    ends = [edge.Curve.value(t) for t in edge.ParameterRange]
    return [min(end.distanceToPoint(vertex.Point) for end in ends) for vertex in edge.Vertexes]


def _side_gaps(face: Part.Face, edge: Part.Edge) -> Iterator[float]:
    """Largest distance of the edge's curve from the face along each of its pcurves there.

    Sampled evenly and inside every span of both curves, then once more around the largest.
    """
    fractions = _fractions(face, edge)
    value = face.Surface.value
    for side, distances in enumerate(_distances(value, trace) for trace in topology.edge_traces(face, edge, fractions)):
        k = int(distances.argmax())
        around = np.linspace(fractions[max(k - 1, 0)], fractions[min(k + 1, len(fractions) - 1)], _AROUND_LARGEST)
        finer = _distances(value, topology.edge_traces(face, edge, around)[side])
        yield float(max(distances[k], finer.max()))


def _distances(value: Callable[[float, float], FreeCAD.Vector], trace: topology.EdgeTrace) -> Array:
    on_face = np.array([tuple(value(u, v)) for u, v in trace.uv.tolist()])
    return np.linalg.norm(on_face - trace.points, axis=1)


def _fractions(face: Part.Face, edge: Part.Edge) -> Array:
    """Where along an edge to look, 0…1: evenly, and inside every span of its curve and of its pcurve on the face."""
    first, last = edge.ParameterRange
    pcurve = face.curveOnSurface(edge)
    knots = [np.array(curve.getKnots()) for curve in (edge.Curve, pcurve[0] if pcurve else None)
             if hasattr(curve, "getKnots")]
    breaks = np.unique(np.clip((np.concatenate([[first, last], *knots]) - first) / (last - first), 0.0, 1.0))
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(_SAMPLES_PER_SPAN) + 0.5) / _SAMPLES_PER_SPAN
    return np.unique(np.concatenate([np.linspace(0.0, 1.0, _UNIFORM_SAMPLES), breaks, inner.ravel()]))
