# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many spans the displacement of every face needs, from the size of its solid and from its own shape.

A solid deforms as a whole: the lengths over which its displacement changes follow its size, not that of its faces. A
tube of 1 m needs a dozen spans along and one across, a clip of 10 mm as many as a bracket of 100 mm.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Index
from ...face_geometry import FaceGeometry

LEAST_CLOSED_SPANS = 8
"""On a direction that closes on itself. *theory*: four follow how a ring moves and turns, eight how it becomes oval."""
_PROBES_PER_SIDE = 17
"""Places per direction at which a face is measured (theory: lengths of arcs are right to 1 %)."""
_MOST_TURN = 0.5 * np.pi
"""Largest turn of the normal over a span, in rad. *theory*: cubics follow a quarter of a circle, not half of one."""
_SPARE = 0.25
"""Part of a span that may be missing. *unit*: spans a little longer than wanted rather than one more."""


@dataclass(frozen=True)
class _Extent:
    """Of one face: ``length`` (2,) in mm and ``turn`` (2,) of the normal in rad, in u and v; of the cells of a grid
    over it ``middle`` (n, 3) in mm and ``area`` (n,) in mm²."""

    length: Array
    turn: Array
    middle: Array
    area: Array


def solid_sizes(faces: Sequence[FaceGeometry], solids: Sequence[Index]) -> Array:
    """Size in mm of the solid of every face, (faces,): the diagonal of the block whose surface has the same radius of
    gyration, in all frames.

    Parameters
    ----------
    solids : faces (k,) of each solid
    """
    result = np.ones(len(faces))
    for solid in solids:
        result[solid] = _size([_extent(faces[index]) for index in solid])
    return result


def span_counts(faces: Sequence[FaceGeometry], sizes: Array, spans: float, turning: float,
                least: float, finer: Mapping[int, int] | None = None) -> list[tuple[int, int]]:
    """Numbers of spans in u and v of every face.

    Parameters
    ----------
    sizes : (faces,) size in mm of the solid of every face
    spans : over the size of a solid
    turning : largest turn of the normal over a span in rad, where a face is as round as its solid is large
    least : size of a span in mm that the scan fills
    finer : by face, the number by which its spans are divided; long and narrow ones along their longer sides alone
    """
    finer = finer or {}
    extents = [_extent(face) for face in faces]
    counts = [_counts(face, extent, own, max(own / spans, least), turning)
              for face, extent, own in zip(faces, extents, sizes, strict=True)]
    return [_divided(count, extent, finer.get(index, 1))
            for index, (count, extent) in enumerate(zip(counts, extents, strict=True))]


def _counts(face: FaceGeometry, extent: _Extent, size: float, span: float, turning: float) -> tuple[int, int]:
    """Spans of one face. On an arc a turn of the solid moves the surface by a sine of the angle, times the radius; what
    a cubic misses of it goes with the fourth power of a span (de Boor, A Practical Guide to Splines, chapter XII)."""
    radius = extent.length / np.maximum(extent.turn, 1e-9)
    turns = extent.turn / np.minimum(turning * (0.5 * size / radius) ** 0.25, _MOST_TURN)
    wanted = np.ceil(np.maximum(extent.length / span, turns) - _SPARE).astype(int)
    closed = face.surface.periodic_u, face.surface.periodic_v
    u, v = (max(int(count), LEAST_CLOSED_SPANS if periodic else 1)
            for count, periodic in zip(wanted, closed, strict=True))
    return u, v


def _divided(counts: tuple[int, int], extent: _Extent, number: int) -> tuple[int, int]:
    """``counts`` times a number, but where spans are more than that many times as long the one way as the other."""
    sides = extent.length / np.array(counts)
    u, v = (count * number if side * number > sides.max() else count
            for count, side in zip(counts, sides, strict=True))
    return u, v


def _size(extents: Sequence[_Extent]) -> float:
    """Size in mm of the solid with these faces."""
    middle, area = (np.concatenate([getattr(extent, name) for extent in extents]) for name in ("middle", "area"))
    centre = np.average(middle, axis=0, weights=area)
    return float(np.sqrt(12 * np.average(((middle - centre) ** 2).sum(axis=1), weights=area)))


def _extent(face: FaceGeometry) -> _Extent:
    u0, u1, v0, v1 = face.surface.range
    grid = face.surface.on_grid(np.linspace(u0, u1, _PROBES_PER_SIDE), np.linspace(v0, v1, _PROBES_PER_SIDE))
    cross = np.cross(grid[1:, 1:] - grid[:-1, :-1], grid[:-1, 1:] - grid[1:, :-1])
    area = np.linalg.norm(cross, axis=2, keepdims=True)
    normal = np.divide(cross, area, out=np.zeros_like(cross), where=area > 1e-12)
    lengths, turns = [], []
    for axis in range(2):
        lengths.append(np.linalg.norm(np.diff(grid, axis=axis), axis=2).sum(axis=axis).max())
        step = np.linalg.norm(np.diff(normal, axis=axis), axis=2)
        turns.append((2 * np.arcsin(np.clip(step / 2, 0, 1))).sum(axis=axis).max())
    middle = 0.25 * (grid[1:, 1:] + grid[1:, :-1] + grid[:-1, 1:] + grid[:-1, :-1])
    return _Extent(np.array(lengths), np.array(turns), middle.reshape(-1, 3), 0.5 * area.ravel())
