# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which skin of a thin sheet the scan shows: `outward_normals` of its points (one or two candidates, by the side of
each of its `smooth_pieces`, decided from even `skin_points`), and the `skin_choice` between two fits.
"""
from .outward_normals import candidate_outward_normals, outward_normals_of_all
from .skin_choice import choose_skin

__all__ = ["candidate_outward_normals", "choose_skin", "outward_normals_of_all"]
