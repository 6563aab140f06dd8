# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scan observes of every face, what is bridged and what is only carried along."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ..data import CellHeights
from ..problem import Problem

OBSERVED, BRIDGED, CARRIED = "observed", "bridged", "carried"
_NEAR_IN_SPACINGS = 3.0
"""Distance from an observed cell up to which a place is observed, in spacings of points (theory: points at random leave
no wider gap)."""
_SEEN_FACE_SHARE = 0.05
"""Share of a face that has to be observed for the rest of it to be bridged (unit)."""
_NEAR_EDGE = 2.0
"""Observed cells this many times as near as others have to be, or within this many trim margins, make an edge observed
(theory: none lie nearer than the margin)."""


@dataclass(frozen=True)
class Coverage:
    """Distances from what was observed.

    Attributes
    ----------
    gap : (spans, k) of every cell from the nearest observed cell of its face, in mm; inf on faces that were not seen
    share : (faces,) share of the area that is observed
    near : what counts as observed, in mm
    trees : of the observed cells of every face
    """

    gap: Array
    share: Array
    near: float
    trees: tuple[cKDTree | None, ...]

    def flags(self, gap: Array, face: Index, near: float) -> NDArray[np.str_]:
        """Flag of places on faces (n,) with their distance (n,) from what was observed."""
        seen = self.share[face] >= _SEEN_FACE_SHARE
        return np.where(seen & (gap <= near), OBSERVED, np.where(seen, BRIDGED, CARRIED))

    def gap_of(self, face: Index, position: Array) -> Array:
        """Distance of nominal places (n, 3) on faces (n,) from the nearest observed cell of their face: (n,)."""
        gap = np.full(len(face), np.inf)
        for index in np.unique(face):
            tree = self.trees[index]
            if tree is not None:
                rows = np.flatnonzero(face == index)
                gap[rows] = tree.query(position[rows])[0]
        return gap

    def edge_near(self, margin: float) -> float:
        """How near to an edge observed cells make it observed."""
        return _NEAR_EDGE * max(margin, self.near)


def coverage(problem: Problem, values: CellHeights) -> Coverage:
    """Coverage of every face by the cells that carry weight."""
    shape = problem.cells.inside.shape
    observed = values.weight.reshape(shape) > 0
    near = _NEAR_IN_SPACINGS * problem.lengths.spacing
    gap, share, trees = np.full(shape, np.inf), np.zeros(len(problem.part.faces)), []
    for face in range(len(problem.part.faces)):
        spans = np.flatnonzero(problem.lattices.face_of_span == face)
        position, seen = problem.cells.nominal.position[spans], observed[spans]
        tree = cKDTree(position[seen], balanced_tree=False, compact_nodes=False) if seen.any() else None
        trees.append(tree)
        if tree is not None:
            gap[spans] = tree.query(position.reshape(-1, 3))[0].reshape(len(spans), -1)
        allowed = np.where(problem.distance[spans] > problem.margin[spans, None], problem.area[spans], 0.0)
        share[face] = allowed[gap[spans] <= near].sum() / max(allowed.sum(), 1e-12)
    return Coverage(gap, share, near, tuple(trees))
