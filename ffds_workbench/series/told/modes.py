# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shapes in which parts of a series differ: principal components, weighted by the surface they stand for."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from ...registration.arrays import Array
from .scatter import SeriesPlaces

_MOST_MODES = 8
_LEAST_SHARE = 0.01
"""Of the variance over parts: what is less than a hundredth is not told."""
_CERTAIN = float(norm.ppf(0.975))


@dataclass(frozen=True)
class Mode:
    """One shape in which parts differ.

    Attributes
    ----------
    shape : (n, 3) displacement in mm of a part that is one standard deviation off the mean
    scores : (parts,) how far each part is off along it, in standard deviations
    size : root mean square over the part's surface of ``shape``, in mm
    interval : 95 % interval of ``size``
    share : of the variance over parts, 0…1
    certain : whether it is the process's, and cannot be the measurement's
    """

    shape: Array
    scores: Array
    size: float
    interval: tuple[float, float]
    share: float
    certain: bool


@dataclass(frozen=True)
class Modes:
    """All modes that are told.

    Attributes
    ----------
    modes : the largest first
    rest : (parts,) rms over the surface in mm of what the modes leave of each part
    measurement : variance in mm² that the measurement explains, over the part's surface; 0 where it is not known
    """

    modes: tuple[Mode, ...]
    rest: Array
    measurement: float


def find_modes(moved: Array, sigma: Array, places: SeriesPlaces) -> Modes:
    """The principal components of displacements, in the metric of the part's surface.

    Parameters
    ----------
    moved : (parts, n, 3) in mm
    sigma : (parts, n) standard deviation of each measurement in mm, NaN where it is not known
    places : of the n places

    Notes
    -----
    With weights w that add up to one, parts are compared by ∫ a·b over the surface, so that neither a dense lattice
    nor a small face counts for more than it is. The variance of a component has, for many parts, the standard
    deviation √(2/(parts − 1)) of itself (Anderson, *Asymptotic theory for principal component analysis*, Annals of
    Mathematical Statistics 34, 1963). The measurement can put into one component no more than all it has over the
    surface, Σ w σ²: a component that is larger with 97.5 % is certain.
    """
    parts = len(moved)
    root = np.sqrt(places.weight)[:, None]
    off = ((moved - moved.mean(axis=0)) * root).reshape(parts, -1)
    known = np.where(np.isfinite(sigma), sigma, 0.0) ** 2
    measurement = float((known.mean(axis=0) * places.weight).sum())
    gram = off @ off.T
    values, vectors = np.linalg.eigh(gram)
    values, vectors = np.maximum(values[::-1], 0.0) / max(parts - 1, 1), vectors[:, ::-1]
    total, spread = float(values.sum()), float(np.sqrt(2.0 / max(parts - 1, 1)))
    found: list[Mode] = []
    for value, vector in zip(values[: min(_MOST_MODES, parts - 1)], vectors.T, strict=False):
        if total <= 0.0 or value < _LEAST_SHARE * total:
            break
        vector = vector * (1.0 if vector[np.argmax(np.abs(vector))] > 0 else -1.0)
        scores = vector * np.sqrt(max(parts - 1, 1))
        shape = np.einsum("p,pnx->nx", scores, moved - moved.mean(axis=0)) / max(parts - 1, 1)
        low, high = value / (1.0 + _CERTAIN * spread), value / max(1.0 - _CERTAIN * spread, 1e-3)
        found.append(Mode(shape, scores, float(np.sqrt(value)), (float(np.sqrt(low)), float(np.sqrt(high))),
                          float(value / total), bool(low > measurement)))
    used = np.stack([mode.scores for mode in found]) if found else np.zeros((0, parts))
    shapes = np.stack([(mode.shape * root).ravel() for mode in found]) if found else np.zeros((0, off.shape[1]))
    rest = np.linalg.norm(off - used.T @ shapes, axis=1)
    return Modes(tuple(found), rest, measurement)
