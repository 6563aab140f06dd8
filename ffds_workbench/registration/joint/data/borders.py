# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the scan visibly ends: at a sharp edge between a face that was seen and one that was not.

Data along the normal say nothing about where an edge lies within its face. The outermost scan points in the plane of
the seen face do.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ...scan_points import end_of_scan, outermost_points, weight_of_end
from ..lengths import Lengths
from ..priors import SharedEdgePlaces
from ..surfaces import FacePlaces, SpanGrid, by_face, concatenate

_LARGEST_OFFSET = 6.0, 0.7
"""A border farther from its edge than this many spacings of points, or this part of the reach, whichever is more, is
ignored; scan points within twice as far belong to the nearest edge sample (calibrated: by hand, on the families of
``./ffds benchmark accuracy``)."""
_POINTS_LAST = 0.6
"""Points keep their edge samples until the edges have moved by this many spacings (theory: the samples are farther
apart)."""
_BORDERS_LAST = 0.1
"""Borders are kept until the edges have moved by this many spacings of points (theory: half of what a border is
uncertain by)."""
_SHARP_COSINE = 0.7
"""Cosine of the normals below which an edge is sharp (unit: 45°)."""
_ASIDE = float(np.sqrt(2.0) - 1) / 2
"""The cell beside a sample is looked for this far along the edge, in steps between samples. It is no ratio of whole
numbers: samples and cells lie on grids, and rounding must not choose between two cells that are equally near
(theory)."""
_LARGEST_RANK = 3
"""Noise carries points over the edge: up to the third outermost is used, and no end is seen where there are fewer
(unit: denser scans are rare)."""
_DENSITY_BAND = (1.5, 6.0)
"""Distance inside the outermost points, in spacings, between which the density is counted (theory: from where the end
no longer thins the points, over a few of them)."""
_LEAST_BAND_POINTS = 12
"""Points in that band around a sample (theory: the density is known to 30 %, 1/√n)."""
_SEEN_BEYOND_SHARE = 0.1511
"""Density of points beyond the edge, over that on the face, from which the scan does not end there (calibrated: by
hand, on the families of ``./ffds benchmark accuracy``). It is no ratio of two small numbers: counts are compared, and a
tie would hang on rounding."""
_LEAST_UNCERTAINTY = 0.2
"""Standard deviation of a visible border in spacings of points, at least (unit: mixed pixels, edge radii)."""
_USUAL_LOSS = 1.0
"""Sensors lose points at edges and never see any beyond them: an end farther inside than this, in spacings, gets less
weight (unit)."""
_HUBER_SIGMAS = 2.0
"""Standard deviations from which a border's weight falls (theory: Huber's loss, at 95 % of normal noise)."""
_DISCARD_HUBERS = 3.0
"""Multiple of that from which it has none (theory: normal noise never reaches there)."""
_EDGE_NEIGHBOURS = 4
"""Edge samples on either side whose median tells whether one of them is an outlier (theory: of nine, four may be)."""
_MOST_POINTS = 250_000
"""Scan points that are looked at (unit: time)."""


@dataclass(frozen=True)
class Borders:
    """Rows m·d = along at places on edges.

    Attributes
    ----------
    samples : the places, on the seen face
    direction : (n, 3) m, out of the face and in its plane
    along : (n,) displacement in mm
    weight : (n,) 1/mm²
    shape : (k, 3) the sharp edges when they were looked for

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    """

    samples: FacePlaces
    direction: Array
    along: Array
    weight: Array
    shape: Array

    def offset(self, control_points: Array) -> Array:
        """How far the borders lie outside the edges of the current shape: (n,) in mm."""
        return self.along - np.einsum("nx,nx->n", self.direction, self.samples.displacement(control_points))


@dataclass(frozen=True)
class EdgeSides:
    """Which way the faces lie at the edge samples.

    Attributes
    ----------
    sign : (2, n) m = sign · (t × n) points out of the first and of the second face
    sharp : (n,) the edge is convex and sharp
    cell : (2, n) the nearest cell of the first and of the second face that holds points, by its flat number; -1 where
        the face has none
    """

    sign: Array
    sharp: NDArray[np.bool_]
    cell: Index


def edge_sides(edges: SharedEdgePlaces, cells: SpanGrid, face_of_span: Index, holds: NDArray[np.bool_]) -> EdgeSides:
    """Sides of the nominal edges, as the faces' loops run, and the cells beside them that hold points.

    Parameters
    ----------
    cells : places on all faces, span by span
    face_of_span : (spans,) number of the face
    holds : (spans, k) whether a cell may hold points
    """
    span, place = np.nonzero(holds)
    tree = cKDTree(by_face(cells.nominal.position[span, place], face_of_span[span]))
    aside = _ASIDE * edges.length[:, None] * edges.direction
    beside = [(side.face, tree.query(by_face(side.nominal[0] + aside, side.face), workers=-1)[1])
              for side in (edges.first, edges.second)]
    cell = np.stack([np.where(face_of_span[span[near]] == face, span[near] * holds.shape[1] + place[near], -1)
                     for face, near in beside])
    normal = [side.nominal_normals for side in (edges.first, edges.second)]
    sign = np.where(edges.left, 1.0, -1.0)
    convex = np.einsum("nx,nx->n", sign[0][:, None] * np.cross(edges.direction, normal[0]), normal[1]) > 0
    return EdgeSides(sign, edges.angled & convex & (np.einsum("nx,nx->n", *normal) < _SHARP_COSINE), cell)


@dataclass(frozen=True)
class NearEdges:
    """Scan points near the sharp edges.

    Attributes
    ----------
    points : (n, 3) in mm
    row : (n,) the nearest edge sample
    place : (samples, 3) where the sharp edges were when the points were looked for
    """

    points: Array
    row: Index
    place: Array


def find_near_edges(points: Array, edges: SharedEdgePlaces, sides: EdgeSides, control_points: Array,
                    lengths: Lengths, known: NearEdges | None) -> NearEdges:
    """The scan points (at most some 250 000, evenly taken) near any sharp edge of the current shape; those that are
    ``known`` while the edges hardly move.

    Parameters
    ----------
    sides : which way the faces lie at their edges
    control_points : (controls, 3) of the displacement in mm
    lengths : of the solve
    """
    sharp = np.flatnonzero(sides.sharp)
    place = _sharp_edges(edges, sides, control_points)
    if known is not None and np.abs(place - known.place).max(initial=0.0) < _POINTS_LAST * lengths.spacing:
        return known
    points = points[:: 1 + len(points) // _MOST_POINTS]
    if not len(sharp):
        return NearEdges(points[:0], sharp, place)
    nearest = cKDTree(place).query(points, distance_upper_bound=2 * _largest_offset(lengths), workers=-1)[1]
    near = np.flatnonzero(nearest < len(sharp))
    return NearEdges(points[near], sharp[nearest[near]], place)


def find_borders(near: NearEdges, edges: SharedEdgePlaces, sides: EdgeSides, control_points: Array, lengths: Lengths,
                 spread: Array, held: Array, known: Borders | None) -> Borders:
    """Visible borders at the current shape, from the scan points near its edges; those that are ``known`` while the
    edges lie where they were looked for. ``spread`` (faces,) is that of the points about the shape as it is, in mm,
    ``held`` (cells,) the points per mm² that the cells hold.

    Parameters
    ----------
    sides : which way the faces lie at their edges
    control_points : (controls, 3) of the displacement in mm
    lengths : of the solve
    """
    shape = _sharp_edges(edges, sides, control_points)
    if known is not None and np.abs(shape - known.shape).max(initial=0.0) < _BORDERS_LAST * lengths.spacing:
        return known
    points, row = near.points, near.row
    pairs = (edges.first, edges.second), (edges.second, edges.first)
    density = [_running(np.nansum, edges.edge, np.append(held, 0.0)[cell]) for cell in sides.cell]
    found = [_one_side(points, row, edges, seen, other, sides.sign[[k, 1 - k]],
                       sides.sharp & (density[1 - k] < _SEEN_BEYOND_SHARE * density[k]), control_points, lengths,
                       spread)
             for k, (seen, other) in enumerate(pairs)]
    rows = [np.flatnonzero(weight > 0) for _, _, weight in found]
    samples = concatenate(edges.first.take(rows[0]), edges.second.take(rows[1]))
    direction, offset, weight = (np.concatenate([side[k][r] for side, r in zip(found, rows, strict=True)])
                                 for k in range(3))
    along = offset + np.einsum("nx,nx->n", direction, samples.displacement(control_points))
    return Borders(samples, direction, along, weight, shape)


def _largest_offset(lengths: Lengths) -> float:
    """How far a border may lie from its edge, in mm."""
    return max(_LARGEST_OFFSET[0] * lengths.spacing, _LARGEST_OFFSET[1] * lengths.reach)


def _sharp_edges(edges: SharedEdgePlaces, sides: EdgeSides, control_points: Array) -> Array:
    """Current places of the samples on sharp edges: (n, 3)."""
    sharp = edges.first.take(np.flatnonzero(sides.sharp))
    return sharp.nominal[0] + sharp.displacement(control_points)


def _one_side(points: Array, row: Index, edges: SharedEdgePlaces, seen: FacePlaces, other: FacePlaces, sign: Array,
              sharp: NDArray[np.bool_], control_points: Array, lengths: Lengths, spread: Array
              ) -> tuple[Array, Array, Array]:
    """Direction, offset and weight at every edge sample for one of its faces; weight 0 where nothing can be said."""
    count, spacing = len(edges.edge), lengths.spacing
    first, last = spacing * _DENSITY_BAND[0], spacing * _DENSITY_BAND[1]
    place = seen.nominal[0] + seen.displacement(control_points)
    normal, out = _across(edges, seen, sign[0], control_points)
    beyond, away = _across(edges, other, sign[1], control_points)
    nothing = out, np.zeros(count), np.zeros(count)
    if not sharp.any() or not len(points):
        return nothing
    local = points - place[row]
    across = np.einsum("nx,nx->n", local, out[row])
    on_seen = np.abs(np.einsum("nx,nx->n", local, normal[row])) < 4 * spread[seen.face[row]]
    on_other = (np.abs(np.einsum("nx,nx->n", local, beyond[row])) < 4 * spread[other.face[row]]) & (
        np.einsum("nx,nx->n", local, away[row]) < -first)
    unlike = ~on_seen & (on_other | (across > -first))
    outermost, number = outermost_points(row[on_seen], across[on_seen], count, _LARGEST_RANK)
    inside = outermost[-1, row] - across
    population, strange, samples = (
        _running(np.nansum, edges.edge, values) for values in
        (_count(row[on_seen & (inside > first) & (inside < last)], count),
         _count(row[unlike], count), np.ones(count)))
    per_mm = np.maximum(population, 1.0) / samples / (last - first)
    offset, sigma = end_of_scan(outermost, per_mm, lengths.noise)
    good = (sharp & (number >= _LARGEST_RANK) & (population >= _LEAST_BAND_POINTS)
            & (strange < _SEEN_BEYOND_SHARE * population)
            & (np.abs(offset) < _largest_offset(lengths)))
    if not good.any():
        return nothing
    sigma = np.hypot(_LEAST_UNCERTAINTY * spacing, sigma)
    around = _running(np.nanmedian, edges.edge, np.where(good, offset, np.nan))
    off = np.abs(offset - around) / (_HUBER_SIGMAS * sigma)
    good &= off < _DISCARD_HUBERS
    weight = weight_of_end(around, sigma, _USUAL_LOSS * spacing) / np.maximum(off, 1.0)
    return out, np.where(good, offset, 0.0), np.where(good, weight, 0.0)


def _across(edges: SharedEdgePlaces, side: FacePlaces, sign: Array, control_points: Array) -> tuple[Array, Array]:
    """Current normal of a face along its edges, and the direction in the face out of it."""
    normal = side.normals(control_points)
    out = sign[:, None] * np.cross(edges.along(side.nominal[0] + side.displacement(control_points)), normal)
    return normal, out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)


def _count(row: Index, count: int) -> Array:
    return np.bincount(row, minlength=count).astype(float)


def _running(gather: Callable[..., Array], edge: Index, values: Array) -> Array:
    """``gather``, which passes over NaN, of the values around every sample on the same edge: (n,)."""
    shifts = range(-_EDGE_NEIGHBOURS, _EDGE_NEIGHBOURS + 1)
    window = np.stack([np.where(np.roll(edge, k) == edge, np.roll(values, k), np.nan) for k in shifts])
    known = np.isfinite(window).any(axis=0)
    result = np.full(len(edge), np.nan)
    result[known] = gather(window[:, known], axis=0)
    return result
