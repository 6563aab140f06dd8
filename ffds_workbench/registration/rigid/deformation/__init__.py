# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose of a part that is not rigid: `displacement_field` (what a material may do), `deformation_match` (the
deformation that a scan asks for at a pose) and `deformed_pose` (the pose that fits all of the deformed part).
"""
from .deformation_match import Match, match_deformed
from .deformed_pose import pose_of_deformed_part
from .displacement_field import DisplacementField

__all__ = ["DisplacementField", "Match", "match_deformed", "pose_of_deformed_part"]
