# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells: `cell` is one, `read_cell` reads its file, `torch` is what the robot holds."""
from .cell import FREE, Cell, default_base
from .read_cell import read_cell
from .torch import Torch

__all__ = ["FREE", "Cell", "Torch", "default_base", "read_cell"]
