# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulated scans as files."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ...registration.arrays import Array


def write_ply(path: Path, points: Array, normals: Array | None = None) -> None:
    """Points (n, 3) in mm, and their unit normals (n, 3), as a binary PLY of doubles."""
    columns = ["x", "y", "z"] if normals is None else ["x", "y", "z", "nx", "ny", "nz"]
    rows = points if normals is None else np.hstack([points, normals])
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(points)}\n" + "".join(f"property double {name}\n" for name in columns)
              + "end_header\n")
    path.write_bytes(header.encode() + np.ascontiguousarray(rows, dtype="<f8").tobytes())
