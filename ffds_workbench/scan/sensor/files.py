# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulated scans as files."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ...registration.splines import Array


def write_ply(path: Path, points: Array) -> None:
    """Points (n, 3) in mm as a binary PLY of doubles."""
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\nend_header\n")
    path.write_bytes(header.encode() + np.ascontiguousarray(points, dtype="<f8").tobytes())
