# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the cells lie from the borders of their faces, and how that grows in them."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ...trims import boundary_pieces
from .cells import SpanGrid
from .lattices import Lattices

_BORDER_PIECE = 0.2467
"""Of the side of a cell: straight pieces along borders that are this long follow a radius of two cells to 0.004 of a
cell (theory: the sagitta, L²/8R). No ratio of whole numbers: borders are whole numbers of cells long, and rounding
must not choose how many pieces there are."""


@dataclass(frozen=True)
class BorderDistance:
    """How far the cells of a face lie from its border.

    Attributes
    ----------
    distance : (spans, k) in mm, negative outside
    slope : (spans, k, 2) how it grows with u and v, in mm
    """

    distance: Array
    slope: Array


def distance_to_trims(faces: tuple[FaceGeometry, ...], lattices: Lattices, cells: SpanGrid, side: Array,
                      farthest: Array) -> BorderDistance:
    """Distance of each cell from the border of its face, at most the ``farthest`` that matters there in mm, (faces,).

    Parameters
    ----------
    faces : of the part
    lattices : of all faces
    cells : places on all faces, span by span
    side : (faces,) length in mm of the longer sides of their cells
    """
    distance = np.repeat(farthest[lattices.face_of_span, None], cells.inside.shape[1], axis=1)
    slope = np.zeros((*distance.shape, 2))
    for index, face in enumerate(faces):
        middle, half = boundary_pieces(face, _BORDER_PIECE * side[index])
        if len(middle):
            spans = np.flatnonzero(lattices.face_of_span == index)
            away = _from_pieces(cells.nominal.position[spans].reshape(-1, 3), middle, half, farthest[index])
            found = np.linalg.norm(away, axis=1)
            inwards = np.where(found < farthest[index], 1 / np.maximum(found, 1e-12), 0.0)[:, None] * away
            distance[spans] = np.minimum(found, farthest[index]).reshape(len(spans), -1)
            slope[spans] = np.einsum("skax,skx->ska", cells.nominal.tangents[spans],
                                     inwards.reshape(len(spans), -1, 3))
    return BorderDistance(np.where(cells.inside, distance, -distance), slope)


def _from_pieces(position: Array, middle: Array, half: Array, farthest: float) -> Array:
    """From the nearest of straight pieces to each place (n, 3): (n, 3) in mm; ``farthest`` where it is farther away."""
    reach = np.linalg.norm(half, axis=1)
    near = cKDTree(middle).query(position, distance_upper_bound=farthest + reach.max())[1]
    known = np.flatnonzero(near < len(middle))
    piece = near[known]
    from_middle = position[known] - middle[piece]
    along = half[piece] / np.maximum(reach[piece, None], 1e-12)
    part = np.clip(np.einsum("nx,nx->n", from_middle, along), -reach[piece], reach[piece])
    result = np.full_like(position, farthest)
    result[known] = from_middle - part[:, None] * along
    return result
