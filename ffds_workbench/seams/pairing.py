# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which places of two models of the same part are the same material point.

The rebuild keeps the parameters of edges and faces. A STEP file may have an edge run the other way, and a face its
(u, v) turned or exchanged, where its numbers could not be kept otherwise.
"""
from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from ..brep import topology
from ..errors import RefusedError
from ..registration.arrays import Array
from .sampling import by_arc_length
from .weldment import Weldment

_SAME_RANGE = 1e-4
_SAME_PARAMETERS = 1e-3
_ALONG = np.array([0.1, 0.4, 0.8])
"""Unit: fractions of an edge that tell its ends and its sides apart."""
_TURNS = [np.array(rows) for rows in product(([1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]), repeat=2)
          if np.linalg.det(rows)]


def paired_fractions(weldment: Weldment, other: Weldment, edge: int, fractions: Array) -> Array:
    """Fractions of the same edge of another model that mark the same material points: (n,) to (n,).

    The same ones, or at the same share of the edge where the ranges differ in length.
    """
    starts = [model.topology.edge_starts[edge] for model in (weldment, other)]
    here, there = (float(np.ptp(model.edges[edge].ParameterRange)) for model in (weldment, other))
    backwards = starts[0] != starts[1]
    if abs(here - there) <= _SAME_RANGE * there:
        return 1.0 - fractions if backwards else fractions
    return by_arc_length(weldment, edge, other, fractions, backwards)


@dataclass(frozen=True)
class PairedFace:
    """The same face of two models: from the (u, v) of one to that of the other.

    Attributes
    ----------
    turn : (2, 2) with entries 0, 1 and -1
    middle, other_middle : (2,) points that belong together
    """

    turn: Array
    middle: Array
    other_middle: Array

    def uv(self, u: float, v: float) -> tuple[float, float]:
        """The other model's parameters of the same material point."""
        u, v = (self.turn @ (np.array([u, v]) - self.middle) + self.other_middle).tolist()
        return u, v


def paired_face(weldment: Weldment, other: Weldment, face: int) -> PairedFace:
    """How the parameters of a face belong to those of the same face of another model.

    Raises
    ------
    RefusedError : they do not
    """
    pairs = [_traces(weldment, other, face, edge) for edge in weldment.topology.face_edges[face]
             if not weldment.topology.degenerate[edge]]
    here, there = (np.concatenate([points for pair in pairs for points in pair[side]]) for side in (0, 1))
    middle, other_middle = (0.5 * (points.min(axis=0) + points.max(axis=0)) for points in (here, there))
    mirrored = len({model.topology.reversed_faces[face] for model in (weldment, other)}) > 1
    turns = [turn for turn in _TURNS if (np.linalg.det(turn) < 0) == mirrored]
    errors = [max(_apart([(points - middle) @ turn.T + other_middle for points in of_edge], of_other)
                  for of_edge, of_other in pairs) for turn in turns]
    best = int(np.argmin(errors))
    if errors[best] > _SAME_PARAMETERS * np.ptp(here, axis=0).max():
        raise RefusedError(f"Face{face + 1} has other parameters in the as-built model: use the model that "
                           "register wrote.")
    return PairedFace(turns[best], middle, other_middle)


def _traces(weldment: Weldment, other: Weldment, face: int, edge: int) -> tuple[list[Array], list[Array]]:
    """Parameters along an edge as each model's face sees it, (3, 2) each; two where it is a seam."""
    fractions = paired_fractions(weldment, other, edge, _ALONG)
    here, there = ([trace.uv for trace in topology.edge_traces(model.faces[face], model.edges[edge], at)]
                   for model, at in ((weldment, _ALONG), (other, fractions)))
    return here, there


def _apart(here: list[Array], there: list[Array]) -> float:
    """Largest distance of traces that belong together; which side of a seam is which is not known."""
    return min(max(float(np.abs(a - b).max()) for a, b in zip(here, order, strict=False))
               for order in (there, there[::-1]))
