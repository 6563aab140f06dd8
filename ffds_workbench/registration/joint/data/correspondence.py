# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which scan point belongs to which cell: nearest current cell centre, one Newton step in its frame, gate and trim.

The tree is built over the cells of the current shape, not over the scan, so that its size does not grow with the scan.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ..surfaces import BorderDistance, Jet, Lattices, SpanGrid, normals

_WITHIN_CELL = 0.75
"""Sizes of a cell from its centre within which foot points belong to it (theory: half, and a quarter for neighbours'
curved borders)."""
_LOT = 65536
"""Points that are matched together: those of a large scan would take more memory than all else (unit: memory)."""
_LEAST_WIDTH = 1e-3
"""Half width of a face that no cell shows to be wider, over the widest margin (unit)."""
_NEGLIGIBLE_SHARE = 0.002
"""Share of the points up to which those on the wrong side are left out rather than matched again (unit: time)."""


@dataclass(frozen=True)
class Frames:
    """What a foot point needs of the active cells, one row per cell.

    Attributes
    ----------
    cell : (m,) flat number (span · k + cell in the span)
    position, normal : (m, 3)
    step : (m, 2, 3) rows that turn an offset in mm into a step in (u, v)
    form : (m, 3) second fundamental form, uu, uv and vv
    size : (m, 2) of the cell in (u, v)
    inside : (m,) how far the cell lies inside the part of its face that holds points, in mm
    slope : (m, 2) how that grows with u and v, in mm
    beside : how far from the centre of its cell a foot point may lie, in mm
    """

    cell: Index
    position: Array
    normal: Array
    step: Array
    form: Array
    size: Array
    inside: Array
    slope: Array
    beside: float


@dataclass(frozen=True)
class Correspondence:
    """Scan points with their cells.

    Attributes
    ----------
    point : (n,) index of the scan point
    cell : (n,) flat number of its cell
    height : (n,) signed distance from the surface along its outward normal, in mm
    nearest : (points,) row of the nearest frame for every scan point asked for, used again while the shape hardly moves
    """

    point: Index
    cell: Index
    height: Array
    nearest: Index


def make_frames(lattices: Lattices, cells: SpanGrid, jet: Jet, margin: Array, border: BorderDistance) -> Frames:
    """Frames of all cells within the trims.

    Parameters
    ----------
    lattices : of all faces
    cells : the raster over them
    jet : the current shape at the cells
    margin : (spans,) distance in mm from the border that foot points must keep
    border : how far the cells lie from it
    """
    per_span = int(np.sqrt(cells.inside.shape[1]))
    span, place = np.nonzero(border.distance > 0)
    normal = normals(jet, cells.outward)[0][span, place]
    tangents, seconds = jet.tangents[span, place], jet.seconds[span, place]
    e, f, g = (np.einsum("nx,nx->n", tangents[:, i], tangents[:, j]) for i, j in ((0, 0), (0, 1), (1, 1)))
    det = np.maximum(e * g - f * f, 1e-12)
    step = np.stack([g[:, None] * tangents[:, 0] - f[:, None] * tangents[:, 1],
                     e[:, None] * tangents[:, 1] - f[:, None] * tangents[:, 0]], axis=1) / det[:, None, None]
    size = lattices.step[span] / per_span
    beside = _WITHIN_CELL * np.sqrt(np.maximum(e, 0) * size[:, 0] ** 2 + np.maximum(g, 0) * size[:, 1] ** 2)
    return Frames(span * cells.inside.shape[1] + place, jet.position[span, place], normal, step,
                  np.einsum("npx,nx->np", seconds, normal), size, border.distance[span, place] - margin[span],
                  border.slope[span, place], float(beside.max(initial=0.0)))


def correspond(points: Array, frames: Frames, gate: float, nearest: Index | None = None,
               outward: Array | None = None) -> Correspondence:
    """Match points (n, 3) to cells within ``gate`` mm; ``nearest`` (n,) is known where the shape hardly moved since.

    ``outward`` (n, 3) are outward normals of the points, zero where unknown: a point keeps to cells of its own side.

    Parameters
    ----------
    frames : of the cells that hold points
    """
    if nearest is None:
        tree = cKDTree(frames.position, balanced_tree=False, compact_nodes=False)
        nearest = tree.query(points, distance_upper_bound=gate + frames.beside, workers=-1)[1]
        if outward is not None:
            nearest = _rematch_wrong_side(points, outward, frames, nearest, gate)
    point = np.flatnonzero(nearest < len(frames.position))
    lots = [point[start : start + _LOT] for start in range(0, max(len(point), 1), _LOT)]
    height, good = (np.concatenate(part) for part in zip(*(_heights(points[lot], nearest[lot], frames, gate)
                                                           for lot in lots), strict=True))
    return Correspondence(point[good], frames.cell[nearest[point[good]]], height[good], nearest)


def _heights(points: Array, row: Index, frames: Frames, gate: float) -> tuple[Array, NDArray[np.bool_]]:
    """Heights of points (n, 3) over the frames with these rows (n,), and whether these may hold them: (n,) each."""
    offset = points - frames.position[row]
    step = np.einsum("nax,nx->na", frames.step[row], offset)
    bend = frames.form[row]
    sag = 0.5 * (bend[:, 0] * step[:, 0] ** 2 + 2 * bend[:, 1] * step[:, 0] * step[:, 1] + bend[:, 2] * step[:, 1] ** 2)
    height = np.einsum("nx,nx->n", frames.normal[row], offset) - sag
    inside = frames.inside[row] + np.einsum("na,na->n", frames.slope[row], step)
    good = ((inside > 0) & (np.abs(height) < gate)
            & (np.abs(step) < _WITHIN_CELL * frames.size[row]).all(axis=1))
    return height, good


def _rematch_wrong_side(points: Array, outward: Array, frames: Frames, nearest: Index, gate: float) -> Index:
    """``nearest`` with the points that face away from their cell matched again, by place and normal together."""
    none = len(frames.position)
    cosine = np.einsum("nx,nx->n", outward, np.append(frames.normal, np.zeros((1, 3)), axis=0)[nearest])
    wrong = np.flatnonzero(cosine < 0)
    result = nearest.copy()
    result[wrong] = none
    if len(wrong) > _NEGLIGIBLE_SHARE * len(points):
        # Opposite sides are 4 gates apart, farther than anything is looked for.
        tree = cKDTree(np.hstack([frames.position, 2 * gate * frames.normal]), balanced_tree=False, compact_nodes=False)
        result[wrong] = tree.query(np.hstack([points[wrong], 2 * gate * outward[wrong]]),
                                   distance_upper_bound=2 * gate, workers=-1)[1]
    return result


def trim_margin(lattices: Lattices, distance: Array, most: float) -> Array:
    """How far from the border a face holds points: ``most`` mm, or half of its half width if that is less: (spans,).

    Parameters
    ----------
    lattices : of all faces
    distance : (spans, k) of the cells from the border of their face in mm, negative outside
    """
    widest = np.zeros(len(lattices.faces))
    np.maximum.at(widest, lattices.face_of_span, distance.max(axis=1))
    return np.minimum(most, np.maximum(0.5 * widest, _LEAST_WIDTH * most))[lattices.face_of_span]
