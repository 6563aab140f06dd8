# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the stations of a seam stand: by arc length, closer together where it is curved."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..registration.arrays import Array
from .chains import Seam, Stretch
from .weldment import Weldment

_GAUSS_AT, _GAUSS_WEIGHT = np.polynomial.legendre.leggauss(4)
_LEAST_INTERVALS, _INTERVALS_PER_SPAN, _MOST_INTERVALS = 32, 4, 256


@dataclass(frozen=True)
class Places:
    """Stations as places on edges.

    Attributes
    ----------
    stretch : (n,) index of the stretch in the seam
    fraction : (n,) of the stretch's edge
    arc_length : (n,) in mm from the seam's start
    """

    stretch: Array
    fraction: Array
    arc_length: Array


def sample(weldment: Weldment, seam: Seam, step: float, chord: float) -> Places:
    """Stations with at most ``step`` mm between them and at most ``chord`` mm under each straight line.

    Within a stretch the density is max(1 / step, √(κ / 8 chord)), κ the curvature; the ends of stretches are stations.
    """
    pieces = [_sample_stretch(weldment, stretch, step, chord) for stretch in seam.stretches]
    stretch, fraction, arc_length, start = [], [], [], 0.0
    for number, (fractions, lengths) in enumerate(pieces):
        keep = slice(None) if number == len(pieces) - 1 else slice(-1)
        fraction.append(fractions[keep])
        arc_length.append(start + lengths[keep])
        stretch.append(np.full(len(fractions[keep]), number))
        start += lengths[-1]
    return Places(np.concatenate(stretch), np.concatenate(fraction), np.concatenate(arc_length))


def _sample_stretch(weldment: Weldment, stretch: Stretch, step: float, chord: float) -> tuple[Array, Array]:
    along, lengths = arc_lengths(weldment, stretch)
    curvature = weldment.curve(stretch.edge, stretch.fractions(along)).curvatures
    density = np.maximum(1.0 / step, np.sqrt(curvature / (8.0 * chord)))
    steps = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(lengths))])
    count = max(1, int(np.ceil(steps[-1] - 1e-6)))
    at = np.interp(np.linspace(0.0, steps[-1], count + 1), steps, lengths)
    return stretch.fractions(_inverse(along, lengths, at)), at


def arc_lengths(weldment: Weldment, stretch: Stretch) -> tuple[Array, Array]:
    """Arc length in mm (m,) at places 0…1 (m,) along a stretch, by Gauss quadrature between them."""
    curve = weldment.edges[stretch.edge].Curve
    spans = len(curve.getKnots()) if hasattr(curve, "getKnots") else 1
    intervals = int(np.clip(_INTERVALS_PER_SPAN * spans, _LEAST_INTERVALS, _MOST_INTERVALS))
    along = np.linspace(0.0, 1.0, intervals + 1)
    half = 0.5 / intervals
    inner = (along[:-1] + half)[:, None] + half * _GAUSS_AT
    speed = np.linalg.norm(weldment.curve(stretch.edge, stretch.fractions(inner.ravel())).first, axis=1)
    speed *= abs(stretch.end - stretch.start)
    lengths = half * speed.reshape(inner.shape) @ _GAUSS_WEIGHT
    return along, np.concatenate([[0.0], np.cumsum(lengths)])


def _inverse(along: Array, lengths: Array, at: Array) -> Array:
    """Places 0…1 at arc lengths, exact at both ends."""
    return np.clip(PchipInterpolator(lengths, along)(at), 0.0, 1.0)


def by_arc_length(weldment: Weldment, edge: int, other: Weldment, fractions: Array, backwards: bool) -> Array:
    """Fractions on the same edge of ``other``, which may run ``backwards``, at the same share of its arc length."""
    whole = Stretch(edge, 0.0, 1.0, (0, 0))
    along, lengths = arc_lengths(weldment, whole)
    share = np.interp(fractions, along, lengths / lengths[-1])
    other_along, other_lengths = arc_lengths(other, whole)
    return _inverse(other_along, other_lengths / other_lengths[-1], 1.0 - share if backwards else share)
