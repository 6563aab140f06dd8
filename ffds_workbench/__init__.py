# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS: surface-based free-form deformation of CAD models to scans.

Version and paths only: FreeCAD imports this package at every start.
"""
from pathlib import Path

__version__ = "0.1.0"

ROOT = Path(__file__).resolve().parent.parent
RESOURCES = ROOT / "resources"
