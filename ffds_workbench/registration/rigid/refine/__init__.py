# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local refinement of a pose: `icp` (point to surface, coarse to fine) and `scan_rims` (where the scan ends)."""
from .icp import gauss_newton, refine
from .scan_rims import Ends, beside, find_ends

__all__ = ["Ends", "beside", "find_ends", "gauss_newton", "refine"]
