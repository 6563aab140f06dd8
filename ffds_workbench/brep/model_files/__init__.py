# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: `model_file` reads and writes them whole, `read_back` compares what was written with what was meant.

For STEP, `step_file` writes, `step_order` (with `step_loops`) and `step_free_shapes` keep the numbers, `step_colours`
names and colours; `document_colours` keeps those in a FreeCAD document.
"""
from .model_file import Model, outer_placement

__all__ = ["Model", "outer_placement"]
