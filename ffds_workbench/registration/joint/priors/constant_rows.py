# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of the normal equations that are the same at every shape: one number per block where x, y and z are alike."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import blas

from ...arrays import Array, Index
from ..linear import Pattern
from .couplings import Couplings
from .stiffness import COMPONENTS, SLIDING, Stiffness


@dataclass(frozen=True)
class ConstantRows:
    """Values on a pattern.

    Attributes
    ----------
    scalar, shear, bending : (size,) of edges, poles, frozen faces and pose; of the distance of opposite skins in all
        directions; of bending in all directions. Each holds for x, y and z
    across : (size, 3, 3) of bending across the surfaces
    smooth, dihedral : places (n,) and blocks (n, 3, 3) of the angles of smooth edges and of sharp ones
    """

    scalar: Array
    shear: Array
    bending: Array
    across: Array
    smooth: tuple[Index, Array]
    dihedral: tuple[Index, Array]

    def weighted(self, bending: float, sliding: float, shear: float, dihedral: float) -> Array:
        """The sum of all with their weights, (size, 3, 3); ``sliding`` is the trust in `SLIDING`."""
        within = SLIDING * sliding * bending
        blocks = (bending - within) * self.across
        alike = self.scalar + within * self.bending + shear * self.shear
        for component in (0, 4, 8):
            blas.daxpy(alike, blocks.ravel(), offy=component, incy=9)
        for (place, rows), weight in ((self.smooth, 1.0), (self.dihedral, dihedral)):
            blocks[place] += weight * rows
        return blocks


def constant_rows(pattern: Pattern, stiffness: Stiffness, couplings: Couplings) -> ConstantRows:
    """All of them, for a part.

    Parameters
    ----------
    pattern : of the normal matrix
    stiffness : of its faces
    couplings : of its faces with each other
    """
    every, along = stiffness.bending_blocks()
    across = np.empty((pattern.size, 3, 3))
    for number, (a, b) in enumerate(COMPONENTS):
        across[:, a, b] = across[:, b, a] = pattern.from_spans(along[:, number])
    return ConstantRows(pattern.from_scalar(couplings.scalar), pattern.from_scalar(couplings.shear),
                        pattern.from_spans(every), across, (pattern.places(couplings.smooth), couplings.smooth.data),
                        (pattern.places(couplings.dihedral), couplings.dihedral.data))
