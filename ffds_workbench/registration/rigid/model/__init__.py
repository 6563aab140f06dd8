# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nominal part as the alignment sees it: `part_samples` on its faces, made by `sampling`, and the `rims` where
faces visibly end.
"""
from .part_samples import SurfaceSamples, Target, kept_with_target
from .rims import Rims
from .sampling import target_of

__all__ = ["Rims", "SurfaceSamples", "Target", "kept_with_target", "target_of"]
