# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local refinement of a pose: `icp` (point to surface, coarse to fine) and `scan_rims` (where the scan ends)."""
from .icp import gauss_newton, refine
from .scan_rims import ScanEnds, find_scan_ends, points_near_rims

__all__ = ["ScanEnds", "find_scan_ends", "gauss_newton", "points_near_rims", "refine"]
