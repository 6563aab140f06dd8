# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stretches of edges joined to seams where they continue each other tangentially, with a direction and a start."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from .weldment import Weldment

_SAME_PLACE = 0.02
"""Ends of stretches nearer than this (mm) meet; above the tolerance of any sound vertex."""
_START_SAMPLES = 200


@dataclass(frozen=True)
class Stretch:
    """A part of one edge, with what the torch sees on both sides.

    Attributes
    ----------
    edge : index
    start, end : fractions of the edge's range; start > end where the seam runs backwards
    faces : the two faces that the weld joins, the lower-numbered one first
    other : faces of the other part that the edge lies on; empty where it is an edge of one part alone
    kind : "edge", or the kind of joint: "T", "lap", "corner", "butt", "pipe"
    """

    edge: int
    start: float
    end: float
    faces: tuple[int, int]
    other: tuple[int, ...] = ()
    kind: str = "edge"

    @property
    def name(self) -> str:
        """As FreeCAD calls the edge."""
        return f"Edge{self.edge + 1}"

    def reversed(self) -> Stretch:
        """The same stretch, run the other way."""
        return replace(self, start=self.end, end=self.start)

    def fractions(self, along: Array) -> Array:
        """The edge's fractions where the stretch is run through by ``along``, 0…1."""
        return self.start + (self.end - self.start) * along


@dataclass(frozen=True)
class Seam:
    """Stretches that follow each other, one weld; ``closed`` where the end is the start."""

    stretches: tuple[Stretch, ...]
    closed: bool

    @property
    def name(self) -> str:
        """The edges it runs along, in order: "Edge15+Edge16+Edge17"."""
        return "+".join(dict.fromkeys(stretch.name for stretch in self.stretches))

    @property
    def kind(self) -> str:
        """The kinds of its stretches, each once."""
        return "+".join(dict.fromkeys(stretch.kind for stretch in self.stretches))


@dataclass(frozen=True)
class _End:
    """An end of a stretch: where, and the unit direction that leads out of it."""

    stretch: int
    at_start: bool
    point: Array
    outwards: Array


def _ends(weldment: Weldment, stretches: Sequence[Stretch]) -> list[_End]:
    ends = []
    for number, stretch in enumerate(stretches):
        curve = weldment.curve(stretch.edge, np.array([stretch.start, stretch.end]))
        forwards = 1.0 if stretch.end > stretch.start else -1.0
        ends += [_End(number, at_start, curve.points[k], forwards * sign * curve.tangents[k])
                 for k, (at_start, sign) in enumerate(((True, -1.0), (False, 1.0)))]
    return ends


def join(weldment: Weldment, stretches: Sequence[Stretch], corner: float) -> tuple[list[Seam], list[str]]:
    """Join stretches that continue each other within the angle ``corner`` (rad).

    Returns
    -------
    seams : each in the direction of its lowest-numbered edge, and closed ones from that edge's start
    branchings : a sentence for every place where a stretch could go on in two ways; nothing is joined there
    """
    ends = _ends(weldment, stretches)
    partner: dict[tuple[int, bool], _End] = {}
    branchings: dict[frozenset[int], str] = {}
    for end in ends:
        onwards = [other for other in _meeting(end, ends) if -end.outwards @ other.outwards >= np.cos(corner)]
        if len(onwards) > 1:
            here = frozenset({end.stretch, *(other.stretch for other in onwards)})
            branchings[here] = _branching(stretches, here)
        elif onwards:
            partner[end.stretch, end.at_start] = onwards[0]
    mutual = {key: end for key, end in partner.items()
              if (back := partner.get((end.stretch, end.at_start))) and (back.stretch, back.at_start) == key}
    return _follow(stretches, mutual), list(branchings.values())


def refuse_branches(weldment: Weldment, stretches: Sequence[Stretch]) -> None:
    """Refuse stretches of which more than two meet at one point.

    Raises
    ------
    RefusedError
    """
    ends = _ends(weldment, stretches)
    for end in ends:
        here = frozenset({end.stretch, *(other.stretch for other in _meeting(end, ends))})
        if len(here) > 2:
            raise RefusedError(_branching(stretches, here) + ": name the edges of one path.")


def _meeting(end: _End, ends: Sequence[_End]) -> list[_End]:
    return [other for other in ends if other is not end and np.linalg.norm(other.point - end.point) <= _SAME_PLACE]


def _branching(stretches: Sequence[Stretch], here: frozenset[int]) -> str:
    names = list(dict.fromkeys(stretches[number].name for number in sorted(here)))
    return f"{', '.join(names[:-1])} and {names[-1]} meet at one point, and a seam does not branch"


def _follow(stretches: Sequence[Stretch], partner: dict[tuple[int, bool], _End]) -> list[Seam]:
    left = set(range(len(stretches)))
    seams = []
    while left:
        first = min(left, key=lambda number: (stretches[number].edge, stretches[number].start))
        forwards, closed = _walk(first, False, partner)
        backwards = [] if closed else _walk(first, True, partner)[0][1:]
        run = [(number, not turned) for number, turned in reversed(backwards)] + forwards
        left -= {number for number, _ in run}
        chain = (stretches[number].reversed() if turned else stretches[number] for number, turned in run)
        seams.append(Seam(tuple(chain), closed))
    return seams


def _walk(first: int, through_start: bool,
          partner: dict[tuple[int, bool], _End]) -> tuple[list[tuple[int, bool]], bool]:
    """(stretch, whether it is run backwards) from ``first`` on, left by its end or start; and whether closed."""
    run = [(first, through_start)]
    while (entered := partner.get((run[-1][0], run[-1][1]))) is not None:
        if entered.stretch == first:
            return run, True
        run.append((entered.stretch, not entered.at_start))
    return run, False


def grow(weldment: Weldment, edge: int, corner: float) -> list[int]:
    """The edge and all that continue it tangentially, in both directions.

    Raises
    ------
    RefusedError
        two edges go on equally well from one end
    """
    chain = [edge]
    for vertex in weldment.topology.edge_vertices[edge]:
        current, at = edge, vertex
        while (following := _next(weldment, current, at, corner)) is not None and following not in chain:
            chain.append(following)
            ends = weldment.topology.edge_vertices[following]
            current, at = following, ends[0] if ends[-1] == at else ends[-1]
    return chain


def _next(weldment: Weldment, edge: int, vertex: int, corner: float) -> int | None:
    topology = weldment.topology
    if len(topology.edge_vertices[edge]) == 1:
        return None
    out = _direction_from(weldment, edge, vertex)
    candidates = [other for other in topology.vertex_edges[vertex]
                  if other != edge and not topology.degenerate[other] and len(topology.edge_faces[other]) == 2
                  and len(topology.edge_vertices[other]) == 2
                  and -out @ _direction_from(weldment, other, vertex) >= np.cos(corner)]
    beside = set(topology.edge_faces[edge])
    with_face = [other for other in candidates if beside & set(topology.edge_faces[other])]
    chosen = with_face or candidates
    if len(chosen) > 1:
        names = " and ".join(f"Edge{other + 1}" for other in chosen)
        raise RefusedError(f"The seam branches after Edge{edge + 1}: {names} both go on from it; name the edges "
                           "one by one.")
    return chosen[0] if chosen else None


def _direction_from(weldment: Weldment, edge: int, vertex: int) -> Array:
    """Unit direction into an edge from one of its two vertices."""
    curve = weldment.curve(edge, np.array([0.0, 1.0]))
    at = np.array(tuple(weldment.shape.Vertexes[vertex].Point))
    from_end = np.linalg.norm(curve.points[1] - at) < np.linalg.norm(curve.points[0] - at)
    return -curve.tangents[1] if from_end else curve.tangents[0]


def directed(weldment: Weldment, seam: Seam, start: tuple[float, float, float] | None, reverse: bool) -> Seam:
    """The seam from the place nearest to ``start``, and reversed if so asked."""
    if start is not None and seam.closed:
        seam = _turned(weldment, seam, np.array(start))
    elif start is not None:
        first, last = seam.stretches[0], seam.stretches[-1]
        ends = np.concatenate([weldment.curve(first.edge, np.array([first.start])).points,
                               weldment.curve(last.edge, np.array([last.end])).points])
        if np.diff(np.linalg.norm(ends - np.array(start), axis=1))[0] < 0.0:
            seam = _reversed(seam)
    return _reversed(seam) if reverse else seam


def _reversed(seam: Seam) -> Seam:
    return replace(seam, stretches=tuple(stretch.reversed() for stretch in reversed(seam.stretches)))


def _turned(weldment: Weldment, seam: Seam, start: Array) -> Seam:
    """A closed seam, cut open at its point nearest to ``start``."""
    along = np.linspace(0.0, 1.0, _START_SAMPLES + 1)
    distances = np.array([np.linalg.norm(_points(weldment, stretch, along) - start, axis=1)
                          for stretch in seam.stretches])
    number, nearest = (int(index) for index in np.unravel_index(distances.argmin(), distances.shape))
    cut = seam.stretches[number]
    low, high = along[max(nearest - 1, 0)], along[min(nearest + 1, _START_SAMPLES)]
    for _ in range(6):  # each round divides the interval by 50
        inner = np.linspace(low, high, 101)
        best = int(np.linalg.norm(_points(weldment, cut, inner) - start, axis=1).argmin())
        low, high = inner[max(best - 1, 0)], inner[min(best + 1, 100)]
    at = float(cut.fractions(np.array([0.5 * (low + high)]))[0])
    around = seam.stretches[number + 1 :] + seam.stretches[:number]
    if min(abs(at - cut.start), abs(at - cut.end)) < 1e-6:
        whole = (cut, *around) if abs(at - cut.start) < abs(at - cut.end) else (*around, cut)
        return replace(seam, stretches=whole)
    return replace(seam, stretches=(replace(cut, start=at), *around, replace(cut, end=at)))


def _points(weldment: Weldment, stretch: Stretch, along: Array) -> Array:
    return weldment.curve(stretch.edge, stretch.fractions(along)).points
