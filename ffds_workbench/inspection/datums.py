# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part on its datums, one after the other, and what each leaves free (ISO 5459)."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from .features import InspectedFeature
from .frames import FREE, Frame
from .zones import MOVES, least_zone

_STEPS = 12
_STILL = 1e-11


@dataclass(frozen=True)
class DatumFrame:
    """A part on its datums.

    Attributes
    ----------
    frame : where the as-built part lies then, in the nominal model's coordinates
    free : (6, m) motions that the datums leave
    stations : of each datum, what `follow` needs: the errors' rows, and the motions that it takes away
    """

    frame: Frame
    free: Array
    stations: tuple[tuple[InspectedFeature, Array, Array], ...] = ()

    def follow(self, draws: Sequence[Array]) -> Array:
        """How the part moves on its datums where their points err: motions (d, 6) for ``draws`` (d, n, 3) of each
        datum's points, by least squares."""
        motion = np.zeros((len(draws[0]) if draws else 1, 6))
        for (_, normals, rows), errors in zip(self.stations, draws, strict=True):
            off = np.einsum("dnx,nx->dn", errors @ self.frame.rotation.T, normals) + motion @ rows[:6]
            motion = motion - off @ rows[6:].T
        return motion


def on_datums(start: Frame, datums: Sequence[InspectedFeature]) -> DatumFrame:
    """Put a part onto its datums.

    Parameters
    ----------
    start : where it lies before
    datums : the primary one first; each takes what the ones before have left

    Notes
    -----
    A plane is touched from outside of the material, so that it is as near to all of it as it can be (Chebyshev); other
    surfaces lie where the squares of distances are least, cylinders whatever their size is.
    """
    frame, free, stations = start, FREE, []
    for datum in datums:
        rows = np.zeros((0, 0))
        for _ in range(_STEPS):
            residual, normals, jacobian = height_rows(datum, frame)
            rows = jacobian @ free
            if datum.kind == "plane":
                motion = free @ _touching(residual, rows)
            else:
                motion = free @ _least_squares(residual, rows, datum.kind == "cylinder")
            frame = frame.moved(motion)
            if np.abs(motion).max(initial=0.0) <= _STILL:
                break
        _, normals, jacobian = height_rows(datum, frame)
        inverse = free @ _pseudo_inverse(jacobian @ free, datum.kind == "cylinder")
        stations.append((datum, normals, np.vstack([jacobian.T, inverse])))
        free = free @ _null_space(jacobian @ free)
    return DatumFrame(frame, free, tuple(stations))


def height_rows(feature: InspectedFeature, frame: Frame) -> tuple[Array, Array, Array]:
    """Heights (n,) of a face's points over the nominal surface, its normals (n, 3) and the change (n, 6) of the heights
    with a motion."""
    assert feature.heights is not None
    moved = frame(feature.points)
    residual, normals = feature.heights(moved)
    return residual, normals, frame.jacobian(moved, normals)


def _least_squares(residual: Array, rows: Array, any_size: bool) -> Array:
    return -_pseudo_inverse(rows, any_size) @ residual


def _touching(residual: Array, rows: Array) -> Array:
    """The motion by which a plane is touched from outside; where earlier datums do not let it come, it only turns."""
    try:
        return least_zone(residual, rows, "contact")[1]
    except RefusedError:
        return least_zone(residual, rows, "width")[1]


def _pseudo_inverse(rows: Array, any_size: bool) -> Array:
    """Of the motion's part of rows (n, m), with a size beside it where it is free: (m, n)."""
    full = np.hstack([rows, np.ones((len(rows), 1))]) if any_size else rows
    left, values, right = np.linalg.svd(full, full_matrices=False)
    inverse = np.where(values > MOVES * np.sqrt(len(rows)), 1.0 / np.maximum(values, 1e-300), 0.0)
    return np.asarray(((right.T * inverse) @ left.T)[: rows.shape[1]])


def _null_space(rows: Array) -> Array:
    """Motions (m, k) that change nothing."""
    _, values, vectors = np.linalg.svd(rows, full_matrices=True)
    rank = int((values > MOVES * np.sqrt(len(rows))).sum())
    return np.asarray(vectors[rank:].T)
