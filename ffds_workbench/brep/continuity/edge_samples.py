# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points on a workpiece's edges and faces, where the local field takes its data from."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...registration.arrays import Array, Index
from ..topology import points_on_edge
from ..workpiece import Workpiece, WorkpieceFace

_LEAST_SAMPLES, _LARGEST_SAMPLES = 5, 400
"""Samples of an edge, at least and at the most (unit: time)."""
_SAMPLES_PER_SIDE = 48
"""Samples along the longer side of a face (unit: time)."""


@dataclass(frozen=True)
class EdgeSamples:
    """Points along edges, dense enough for a given purpose.

    Attributes
    ----------
    edges : (n,) index of the edge
    fractions : (n,) position in its parameter range, 0…1, ascending within an edge
    points : (n, 3) in mm
    lengths : (n,) length of edge in mm that each point stands for
    """

    edges: NDArray[np.intp]
    fractions: Array
    points: Array
    lengths: Array

    @property
    def at_vertices(self) -> NDArray[np.bool_]:
        """(n,) whether a sample is an end of its edge."""
        return (self.fractions == 0.0) | (self.fractions == 1.0)

    def take(self, chosen: Index | NDArray[np.bool_]) -> EdgeSamples:
        """The samples at an index or mask array."""
        return EdgeSamples(self.edges[chosen], self.fractions[chosen], self.points[chosen], self.lengths[chosen])


def join_samples(parts: Iterable[EdgeSamples]) -> EdgeSamples:
    """Several sets of samples as one."""
    parts = list(parts)
    if not parts:
        return EdgeSamples(np.empty(0, dtype=np.intp), np.empty(0), np.empty((0, 3)), np.empty(0))
    return EdgeSamples(np.concatenate([part.edges for part in parts]),
                       np.concatenate([part.fractions for part in parts]),
                       np.concatenate([part.points for part in parts]),
                       np.concatenate([part.lengths for part in parts]))


def along_edge(workpiece: Workpiece, edge: int, spacing: Callable[[Array], Array]) -> EdgeSamples:
    """Samples of one edge, no farther apart than asked.

    Parameters
    ----------
    workpiece : the shape
    edge : index of the edge
    spacing : ``points (n, 3) -> (n,)``, the largest distance in mm allowed around each point; at most 400 samples are
        taken, whatever it says
    """
    curve = workpiece.edges[edge]
    fractions = np.linspace(0.0, 1.0, _LEAST_SAMPLES)
    points = points_on_edge(curve, fractions)
    if curve.Degenerated:
        return EdgeSamples(np.array([edge]), np.zeros(1), points[:1], spacing(points[:1]))
    for _ in range(4):
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        allowed = np.maximum(spacing(points), 1e-9)
        pieces = np.ceil(steps / np.minimum(allowed[:-1], allowed[1:])).clip(1, 16).astype(int)
        if pieces.sum() > _LARGEST_SAMPLES:
            pieces = np.maximum(pieces * _LARGEST_SAMPLES // pieces.sum(), 1)
        if pieces.max() == 1:
            break
        fractions = np.append(np.concatenate([a + (b - a) * np.arange(k) / k for a, b, k in
                                              zip(fractions[:-1], fractions[1:], pieces, strict=True)]), 1.0)
        points = points_on_edge(curve, fractions)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    lengths = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
    return EdgeSamples(np.full(len(points), edge), fractions, points, lengths)


def inside(trims: Iterable[Array], uv: Array) -> NDArray[np.bool_]:
    """Which parameters lie inside closed polylines, by the even-odd rule: (n, 2) to (n,)."""
    odd = np.zeros(len(uv), dtype=bool)
    for polyline in trims:
        (u0, v0), (u1, v1) = polyline[:-1].T, polyline[1:].T
        crosses = (v0[:, None] > uv[:, 1]) != (v1[:, None] > uv[:, 1])
        segment, point = np.nonzero(crosses)
        slope = (u1[segment] - u0[segment]) / (v1[segment] - v0[segment])
        left = uv[point, 0] < u0[segment] + slope * (uv[point, 1] - v0[segment])
        odd ^= np.bincount(point[left], minlength=len(uv)) % 2 == 1
    return odd


@dataclass(frozen=True)
class FaceSamples:
    """A grid of points on a face.

    Attributes
    ----------
    uv : (n, 2) parameters inside the trims
    points : (n, 3) in mm
    coarse : (n,) a few of them that still show every span of the displacement
    """

    uv: Array
    points: Array
    coarse: NDArray[np.bool_]


def on_face(face: WorkpieceFace, spans: tuple[int, int]) -> FaceSamples:
    """Samples of a face at about 1/48 of its size, and among them a grid of about two to each of ``spans``."""
    lengths = np.array(side_lengths(face))
    counts = np.ceil(_SAMPLES_PER_SIDE * lengths / np.linalg.norm(lengths)).clip(4, _SAMPLES_PER_SIDE).astype(int)
    box = face.box
    u, v = _middles(box.u0, box.u1, counts[0]), _middles(box.v0, box.v1, counts[1])
    few_u, few_v = (_few(len(x), 2 * n) for x, n in zip((u, v), spans, strict=True))
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    kept = inside(face.trims, uv)
    return FaceSamples(uv[kept], face.at(uv[kept]), np.logical_and.outer(few_u, few_v).ravel()[kept])


def side_lengths(face: WorkpieceFace) -> tuple[float, float]:
    """Largest length in mm of the face's parameter box along u and along v."""
    box = face.box
    grid = face.on_grid(np.linspace(box.u0, box.u1, 9), np.linspace(box.v0, box.v1, 9))
    along_u = np.linalg.norm(np.diff(grid, axis=0), axis=2).sum(axis=0).max()
    along_v = np.linalg.norm(np.diff(grid, axis=1), axis=2).sum(axis=1).max()
    return float(along_u), float(along_v)


def _middles(start: float, end: float, count: int) -> Array:
    return start + (end - start) * (np.arange(count) + 0.5) / count


def _few(count: int, wanted: int) -> NDArray[np.bool_]:
    chosen = np.zeros(count, dtype=bool)
    chosen[np.linspace(0, count - 1, min(count, int(np.clip(wanted, 9, 25)))).round().astype(int)] = True
    return chosen
