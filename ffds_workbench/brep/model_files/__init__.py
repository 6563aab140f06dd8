# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: `model_file` reads and writes them whole, `read_back` compares what was written with what was meant.

For STEP, `step_file` writes, `step_order` (with `step_loops`) and `step_free_shapes` keep the numbers, `step_colours`
names and colours; `document_colours` keeps those in a FreeCAD document. `reading` reads foreign files in a process of
their own, with `reader`.
"""
from __future__ import annotations

from typing import Any

__all__ = ["Model", "outer_placement"]


def __getattr__(name: str) -> Any:
    """What is loaded when it is first asked for (PEP 562), so that `reading` starts without FreeCAD."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import model_file, reader

    return reader.outer_placement if name == "outer_placement" else model_file.Model
