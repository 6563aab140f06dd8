# SPDX-License-Identifier: LGPL-2.1-or-later
"""The size of a control lattice that a scan can determine."""
from __future__ import annotations

import numpy as np

from .raster import Raster
from .splines import DEGREE, SplineSurface
from .start import Layers

_SPAN_IN_LENGTHS = 4.0
_LARGEST_TURN = np.radians(25)
_FEWEST, _MOST = 5, 48
_LEAST_NOISE = 0.02


def automatic_lattice(surface: SplineSurface, raster: Raster, layers: Layers, stiffness: float) -> tuple[int, int]:
    """(N_i, N_j): spans just fine enough for what the fit can tell from noise.

    Parameters
    ----------
    stiffness : weight of the bending energy in chi-square units

    Notes
    -----
    A smoothing spline with bending weight λ on ρ points per mm² of noise σ averages over the length (λ σ² / ρ)^¼; spans
    of four such lengths leave nothing of the signal out and follow none of the noise.
    """
    noise = max(layers.noise, _LEAST_NOISE)
    span = _SPAN_IN_LENGTHS * (stiffness * noise**2 / layers.density) ** 0.25
    size = []
    for axis in (0, 1):
        length = raster.size[axis] * raster.shape[axis]
        curvature = np.abs(raster.curvature).max(axis=1)
        turn = float(np.median(curvature)) * length
        spans = max(length / span, min(turn, 2 * np.pi) / _LARGEST_TURN)
        extra = 0 if raster.periodic[axis] else DEGREE
        size.append(int(np.clip(np.ceil(spans) + extra, _FEWEST, _MOST)))
    return size[0], size[1]
