# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose of a part that is not rigid: `displacement_field` (what a material may do), `deformation_match` (the
deformation that a scan asks for at a pose) and `deformed_pose` (the pose that fits all of the deformed part).
"""
from .deformation_match import NOT, SOFT, STIFF, Match, Rounds, match
from .deformed_pose import settle
from .displacement_field import Deformation

__all__ = ["NOT", "SOFT", "STIFF", "Deformation", "Match", "Rounds", "match", "settle"]
