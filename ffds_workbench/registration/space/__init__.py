# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth vector fields in space through scattered vectors: `space_lattice` is the field, `scattered` fits it."""
from .scattered import fit
from .space_lattice import SpaceField

__all__ = ["SpaceField", "fit"]
