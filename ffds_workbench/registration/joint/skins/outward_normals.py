# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outward normals of scan points: which side of a thin part each shows.

A sheet that moved by its own thickness lies where its far side was. Neighbouring scan points show the same side, so
each connected piece of the scan has one sign, which the piece as a whole determines, since no part of a sheet moves
without its neighbours. Normals of the scan determine it as well. Where nothing does, both sides are candidates.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ...robust_weights import NOISE_ENDS_SIGMAS
from ..problem import Problem
from ..surfaces import normals
from .skin_points import SkinPoints, skin_points
from .smooth_pieces import smooth_pieces

_TOO_THICK = 3.0
"""In a sheet thicker than this many times the expected displacement, the two sides cannot be confused (unit)."""
# What is clearly less is a judgement (unit), tried on the sheets of tests/registration/test_joint_skins.py.
_CLOSER = 0.85
"""A sign is chosen for a piece if its points then lie closer to the part, by this factor, than with the other sign
(calibrated: by hand, on the sheets of tests/registration/test_joint_skins.py)."""
_LOST_RATIO, _LOST_FLOOR = 0.5, 0.004
"""Also if fewer points, by the first factor, find no counterpart on the part. Both counts are first raised by the
second number times the size of the piece (calibrated: by hand, on the sheets of
tests/registration/test_joint_skins.py)."""
_LEAST_NEAR_POINTS, _LEAST_PIECE_POINTS = 100, 30
"""Points near the part without which nothing is decided, and points of a piece whose mean is trusted (theory: a share
of 30 is known to a tenth)."""
_DOUBTFUL_RATIO, _LARGE_PIECE_SHARE = 0.75, 0.2
"""Both signs are tried where the distances differ by less than the first factor and the piece holds more than the
second share of the points (calibrated: by hand, on the sheets of tests/registration/test_joint_skins.py)."""
_AGREEMENT = 0.5
"""Mean of the signs within a smooth piece above which they are trusted (unit: three of four agree)."""
_MUCH_CLOSER = 0.5
"""A piece that lies closer to the part by this factor is believed even against the scan's normals (calibrated: by hand,
on the sheets of tests/registration/test_joint_skins.py)."""
_NORMALS_AGREE, _TELLING_NORMALS_SHARE, _CONTRADICTION_SHARE = 0.7, 0.5, 0.1
"""The scan's normals are trusted on a smooth piece if their mean cosine with the piece's own normals is above the first
number, and at all only if such pieces hold the second share of the scan. Both sides are tried if the points contradict
the normals on more than the third share (unit: 45°, most of the scan, a tenth of it)."""
_NORMAL_REACH_IN_SPACINGS = 3.0
"""A scan point takes the normal of a point of the sketch within this many mean spacings (unit)."""


def candidate_outward_normals(problem: Problem) -> tuple[list[Array | None], bool]:
    """Outward unit normals at the points of the problem's sample, zero where they are unknown: (n, 3).

    Two of them where a large piece is in doubt, the nearer side first, or, if the scan's normals tell the side, theirs;
    None where no sheet is so thin that its sides could be mixed up, or the noise hides them. The second result is
    whether the scan's normals tell.
    """
    thickness, reach = _thinnest(problem), problem.lengths.reach
    if thickness > _TOO_THICK * reach:
        return [None], False
    inside = problem.cells.inside
    place = problem.cells.nominal.position[inside]
    normal = normals(problem.cells.nominal, problem.cells.outward)[0][inside]
    generator = np.random.default_rng(problem.settings.seed)
    sketch = skin_points(problem.scan, cKDTree(place), reach, problem.statistics, thickness, generator)
    if len(sketch.points) < _LEAST_NEAR_POINTS:
        return [None], False
    tree = cKDTree(sketch.points)
    distance, nearest = tree.query(problem.sample, workers=-1)
    known = (distance < _NORMAL_REACH_IN_SPACINGS * np.median(tree.query(sketch.points, k=2)[0][:, 1]))[:, None]
    pieces = smooth_pieces(sketch.points, sketch.normals)
    signs, sure = _signs(place, normal, sketch, 2 * reach)
    sides = [_one_sign_each(pieces, item[sketch.piece]) for item in signs]
    by_scan = np.zeros(len(sketch.points))
    if problem.sample_normals is not None:
        cosines = _cosines(sketch, nearest, known * problem.sample_normals)
        by_scan = _signs_of_scan_normals(pieces, cosines, sure[sketch.piece])
    if by_scan.any():
        theirs = np.where(by_scan == 0, sides[0], by_scan)
        sides = [theirs, *(side for side in sides if (side * theirs < 0).mean() > _CONTRADICTION_SHARE)][:2]
    return [np.where(known, (side[:, None] * sketch.normals)[nearest], 0.0) for side in sides
            if side is sides[0] or (side != sides[0]).any()], bool(by_scan.any())


def outward_normals_of_all(problem: Problem, outward: Array | None) -> Array | None:
    """Outward unit normals at all scan points, zero where they are unknown, from those of the sample (m, 3): (n, 3).

    None where noise carries no point over the middle of a sheet.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    outward : (m, 3) at the points of the sample, zero where they are unknown
    """
    if outward is None or NOISE_ENDS_SIGMAS * problem.statistics.noise < 0.5 * _thinnest(problem):
        return None
    return np.asarray(outward[cKDTree(problem.sample).query(problem.scan, workers=-1)[1]])


def _thinnest(problem: Problem) -> float:
    """Thickness in mm of the thinnest sheet, infinite where there is none."""
    return min((t for t in problem.couplings.pairs.solid_thickness if t), default=np.inf)


def _signs(place: Array, normal: Array, sketch: SkinPoints, most: float) -> tuple[list[Array], Array]:
    """Sign of every piece of the sketch, from what it finds on the nominal part: +1, −1, or 0 where it is undecided:
    (pieces,).

    With the wrong sign a wall finds nothing with its normal within ``most`` mm, and a skin finds the far one. Where a
    large piece is in doubt, its other sign comes second, with those of all other doubtful pieces. The signs that are
    clear even against the scan's normals are returned separately.
    """
    tree = cKDTree(np.hstack([place, most * normal]), balanced_tree=False, compact_nodes=False)
    both = [tree.query(np.hstack([sketch.points, sign * most * sketch.normals]), distance_upper_bound=most,
                       workers=-1)[0] for sign in (1.0, -1.0)]
    lost = [np.bincount(sketch.piece, weights=np.isinf(found).astype(float)) for found in both]
    distance = [np.bincount(sketch.piece, weights=np.minimum(found, most)) for found in both]
    size = np.bincount(sketch.piece).astype(float)
    by_loss = _clearly_less(lost[0] + _LOST_FLOOR * size, lost[1] + _LOST_FLOOR * size, _LOST_RATIO)
    near = np.where(by_loss == 0, _clearly_less(distance[0], distance[1], _CLOSER), by_loss)
    doubtful = (by_loss == 0) & (_clearly_less(distance[0], distance[1], _DOUBTFUL_RATIO) == 0)
    main = doubtful & (size > _LARGE_PIECE_SHARE * size.sum())
    first = np.where(main & (near == 0), np.where(distance[0] <= distance[1], 1.0, -1.0), near)
    clear = np.where(by_loss == 0, _clearly_less(distance[0], distance[1], _MUCH_CLOSER), by_loss)
    return [first, np.where(doubtful, -first, first)] if main.any() else [near], clear


def _clearly_less(first: NDArray[np.number], second: NDArray[np.number], factor: float) -> Array:
    """+1 where the first is less by that factor, −1 where the second is, else 0."""
    return np.where(first < factor * second, 1.0, np.where(second < factor * first, -1.0, 0.0))


def _one_sign_each(pieces: tuple[Index, Array], signs: Array, agreed: float = _AGREEMENT) -> Array:
    """One sign for each smooth piece, that of most of its points, 0 where they contradict each other: (n,).

    Signs carried around the edge of a thin sheet may go astray; across a smooth surface they do not.
    """
    piece, side = pieces
    size = np.bincount(piece)
    mean = np.bincount(piece, weights=signs * side) / np.maximum(size, 1)
    trusted = (np.abs(mean) > agreed) & (size >= _LEAST_PIECE_POINTS)
    return np.where(trusted, np.sign(mean), 0.0)[piece] * side


def _cosines(sketch: SkinPoints, nearest: Index, given: Array) -> Array:
    """Mean cosine of the sketch's normals to those given (m, 3), some of them zero, of the nearest points: (n,)."""
    count = len(sketch.points)
    total = np.bincount(nearest, np.einsum("nx,nx->n", given, sketch.normals[nearest]), count)
    return total / np.maximum(np.bincount(nearest, given.any(axis=1), count), 1)


def _signs_of_scan_normals(pieces: tuple[Index, Array], cosine: Array, sure: Array) -> Array:
    """Signs (n,) that the scan's normals give to the sketch's, 0 where they do not decide.

    They point out of the material, or all into it: then the sides that are ``sure`` (n,) from the points contradict
    them. Where these contradict a part of them, or neighbours do each other, nobody knows what they mean.
    """
    signs = _one_sign_each(pieces, cosine, _NORMALS_AGREE)
    compared = np.count_nonzero(sure * signs)
    agreed = float((sure * signs).sum()) / compared if compared >= _LEAST_PIECE_POINTS else 1.0
    if np.count_nonzero(signs) < _TELLING_NORMALS_SHARE * len(signs) or abs(agreed) < _AGREEMENT:
        return np.zeros(len(signs))
    return np.sign(agreed) * signs
