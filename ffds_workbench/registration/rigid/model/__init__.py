# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nominal part as the alignment sees it: `part_samples` on its faces, made by `sampling`, the `rims` where faces
visibly end, and the `nearest_field` that tells the sample nearest to a place without a tree.
"""
from .nearest_field import NearestField, nearest_field
from .part_samples import SurfaceSamples, Target, kept_with_target
from .rims import Rims
from .sampling import target_of

__all__ = ["NearestField", "Rims", "SurfaceSamples", "Target", "kept_with_target", "nearest_field", "target_of"]
