# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: `model_file` reads and writes them whole, `step_colours` keeps names and colours in a STEP file,
`document_colours` in a FreeCAD document.
"""
from .model_file import Model, outer_placement

__all__ = ["Model", "outer_placement"]
