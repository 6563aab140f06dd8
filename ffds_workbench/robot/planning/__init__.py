# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths: `seam_path` along one `course`, from its `holds` by the `ladder`, and `failure` where there is none.

`leaving` leads down to a seam and away, `transfers` through the air, and `remedies` says what would help.
"""
from .course import Course
from .failure import APPROACH, PROCESS, SEARCH, TRANSFER, Failure
from .leaving import leaving, within_branch
from .remedies import remedy
from .seam_path import SeamPath, plan_path, replay
from .transfers import transfer

__all__ = ["APPROACH", "PROCESS", "SEARCH", "TRANSFER", "Course", "Failure", "SeamPath", "leaving", "plan_path",
           "remedy", "replay", "transfer", "within_branch"]
