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
"""Of a motion: shifts along the axes of the model's frame, and turns about them."""


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
        rows, off = twist_rows(here, feature.direction(here)) @ basis, feature.distance(here)
        if feature.free_size:  # the radius takes up the means
            rows, off = rows - rows.mean(axis=0), off - off.mean()
        values, turned = singular(rows)
        tells = values > _TOLD * np.sqrt(len(here))
        if not tells.any():
            return pose, 0, basis
        told, left = basis @ turned[tells].T, basis @ turned[~tells].T
        step = told @ np.linalg.lstsq(rows @ turned[tells].T, -off, rcond=None)[0]
        pose = twist_motion(step, np.zeros(3)) @ pose
        if step_length(step, size) < _SETTLED * size:
            break
    return pose, told.shape[1], left


def singular(rows: Array) -> tuple[Array, Array]:
    """Singular values (k,) of ``rows`` (n, k), zeros where n < k, and their directions, a row each: (k, k).

    Those of the triangle of a QR decomposition: the left directions, (n, n), are of no use and too large.
    """
    _, values, turned = np.linalg.svd(np.linalg.qr(rows, mode="r"))
    return np.concatenate([values, np.zeros(len(turned) - len(values))]), turned


def step_length(step: Array, size: float) -> float:
    """How far the twist ``step`` (6,) about the origin moves a part of that ``size`` at most, about, in mm."""
    return float(np.abs(step * np.array([size] * 3 + [1.0] * 3)).max())
