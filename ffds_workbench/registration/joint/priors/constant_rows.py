# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of the normal equations that are the same at every shape: one number per block where x, y and z are equal."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from ...arrays import Array
from ..linear import Pattern, SomeBlocks
from .couplings import CouplingMatrices
from .stiffness import COMPONENTS, SLIDING, Stiffness


@dataclass(frozen=True)
class ConstantRows:
    """Values on a pattern.

    Attributes
    ----------
    scalar, shear, bending : (size,) of edges, poles, frozen faces and pose; of the distance of opposite skins in all
        directions; of bending in all directions. Each holds for x, y and z
    across : (6, size) of bending across the surfaces, for each of `COMPONENTS`
    smooth, dihedral : of the angles of smooth edges and of sharp ones
    """

    scalar: Array
    shear: Array
    bending: Array
    across: Array
    smooth: SomeBlocks
    dihedral: SomeBlocks

    def weighted(self, bending: float, sliding: float, shear: float, dihedral: float) -> Array:
        """The sum of all with their weights, (3, 3, size); ``sliding`` is the trust in `SLIDING`."""
        within = SLIDING * sliding * bending
        blocks = np.empty((3, 3, len(self.scalar)))
        for (a, b), across in zip(COMPONENTS, self.across, strict=True):
            np.multiply(across, bending - within, out=blocks[a, b])
            if a != b:
                blocks[b, a] = blocks[a, b]
        alike = self.scalar + within * self.bending + shear * self.shear
        for a in range(3):
            blocks[a, a] += alike
        self.smooth.add_to(blocks, 1.0)
        self.dihedral.add_to(blocks, dihedral)
        return blocks


def constant_rows(pattern: Pattern, stiffness: Stiffness, scalar: csr_matrix, others: CouplingMatrices
                  ) -> ConstantRows:
    """All of them, for a part.

    Parameters
    ----------
    pattern : of the normal matrix
    stiffness : of its faces
    scalar : (controls, controls) normal matrix of `Couplings`
    others : of its angles and of shear
    """
    every, along = stiffness.bending_blocks()
    across = np.array([pattern.from_spans(along[:, number]) for number in range(len(COMPONENTS))])
    return ConstantRows(pattern.from_scalar(scalar), pattern.from_scalar(others.shear), pattern.from_spans(every),
                        across, pattern.from_vector(others.smooth), pattern.from_vector(others.dihedral))
