# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose that meets datums in their order, A|B|C: each takes the degrees of freedom that those before it leave free.

ISO 5459: the primary datum is met as well as its points allow; the secondary one under the orientation that the first
has given, and so on. Each is met by least squares over its points. What a feature cannot tell (a plane its own
sliding and turning) is the null space of its rows, as its nominal form moves into itself then.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motions import apply, twist_motion, twist_rows
from .features import DatumFeature

_STEPS = 12
"""Gauss-Newton steps of a datum (theory: three to five do, as the start is near)."""
_SETTLED = 1e-10
"""Size of a step, over the part, that is none (unit: rounding)."""
_TOLD = 1e-3
"""Singular values, over those of the whole part's turning, below which a datum tells nothing (unit: noise)."""
FREEDOMS = ("tx", "ty", "tz", "rx", "ry", "rz")


@dataclass(frozen=True)
class DatumFit:
    """How a datum is met.

    Attributes
    ----------
    points : of the scan that show it
    rms, mean : of their distances from it in mm; of a cylinder or sphere from their own mean radius
    told : degrees of freedom that it took
    """

    points: int
    rms: float
    mean: float
    told: int


@dataclass(frozen=True)
class DatumPose:
    """The pose of a scan.

    Attributes
    ----------
    T_model_scan : (4, 4)
    datums : how each is met, in their order
    free : how many degrees of freedom none of them tells and none is locked: these stay as they were
    """

    T_model_scan: Array
    datums: tuple[DatumFit, ...]
    free: int


def align_on_datums(features: Sequence[DatumFeature], points: Sequence[Array], start: Array, size: float,
                    locked: Sequence[str] = ()) -> DatumPose:
    """The pose that meets datums in their order.

    Parameters
    ----------
    features : nominal datums
    points : (n, 3) in mm, of the scan, that show each of them; where there are none it tells nothing
    start : (4, 4) T_model_scan to start from
    size : of the part in mm
    locked : of `FREEDOMS`, in the frame of the model: they stay as they are in ``start``
    """
    pose, basis, fits = start, free_twists(locked, size), []
    for feature, own in zip(features, points, strict=True):
        pose, told, basis = _meet(feature, own, pose, basis, size)
        left = feature.distance(apply(pose, own)) if len(own) else np.zeros(1)
        if feature.free_size:
            left = left - left.mean()
        fits.append(DatumFit(len(own), float(np.sqrt((left**2).mean())), float(left.mean()), told))
    return DatumPose(pose, tuple(fits), basis.shape[1])


def free_twists(locked: Sequence[str], size: float) -> Array:
    """Twists about the model's origin that are not locked, of a length that moves the part's end by 1 mm: (6, k)."""
    scale = np.array([2.0 / size] * 3 + [1.0] * 3)
    order = (*FREEDOMS[3:], *FREEDOMS[:3])
    return np.diag(scale)[:, [k for k, name in enumerate(order) if name not in locked]]


def _meet(feature: DatumFeature, points: Array, pose: Array, basis: Array, size: float) -> tuple[Array, int, Array]:
    """The pose that meets one datum, how many freedoms that took, and the twists (6, k) that are left."""
    if not len(points) or not basis.shape[1]:
        return pose, 0, basis
    told = left = basis
    for _ in range(_STEPS):
        here = apply(pose, points)
        told, left = _split(twist_rows(here, feature.direction(here)) @ basis, basis, len(here), feature.free_size)
        if not told.shape[1]:
            return pose, 0, basis
        rows, off = _centred(twist_rows(here, feature.direction(here)) @ told, feature.distance(here),
                             feature.free_size)
        step = told @ np.linalg.lstsq(rows, -off, rcond=None)[0]
        pose = twist_motion(step, np.zeros(3)) @ pose
        if np.abs(step * np.array([size] * 3 + [1.0] * 3)).max() < _SETTLED * size:
            break
    return pose, told.shape[1], left


def _split(rows: Array, basis: Array, count: int, free_size: bool) -> tuple[Array, Array]:
    """Twists of a basis that rows (n, k) tell, and those that they do not."""
    centred, _ = _centred(rows, np.zeros(count), free_size)
    _, values, turned = np.linalg.svd(centred, full_matrices=True)
    values = np.concatenate([values, np.zeros(len(turned) - len(values))]) / np.sqrt(count)
    told = values > _TOLD
    return basis @ turned[told].T, basis @ turned[~told].T


def _centred(rows: Array, off: Array, free_size: bool) -> tuple[Array, Array]:
    """Rows and distances without their means, where a radius takes these up."""
    return (rows - rows.mean(axis=0), off - off.mean()) if free_size else (rows, off)
