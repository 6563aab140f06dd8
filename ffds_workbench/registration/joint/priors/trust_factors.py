# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much each prior counts: factors on their weights."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PriorTrust:
    """Factors on the weights of the priors. Bending across a surface always has its weight: it only keeps it smooth.

    Attributes
    ----------
    isometry : that lengths stay
    thickness, shear : that the skins of a sheet keep their distance, and do not slide along each other
    dihedral : that edges keep their angles
    sliding : that nothing bends within a surface
    """

    isometry: float = 1.0
    thickness: float = 1.0
    shear: float = 1.0
    dihedral: float = 1.0
    sliding: float = 1.0
