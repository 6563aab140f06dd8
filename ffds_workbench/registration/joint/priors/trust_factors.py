# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far each prior counts: factors on their weights."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PriorTrust:
    """Factors on the weights of the priors: of isometry, of the thickness of sheets and their resistance to shear
    through the thickness, of the angles of edges, and of what bends within a surface. Bending across it always has its
    weight: it only keeps surfaces smooth."""

    isometry: float = 1.0
    thickness: float = 1.0
    shear: float = 1.0
    dihedral: float = 1.0
    sliding: float = 1.0
