# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan lies: `aligning` it by its shape, or by `datums` and reference points."""
from .aligning import AlignedScan, align_scan, target_of_shape

__all__ = ["AlignedScan", "align_scan", "target_of_shape"]
