# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who dresses the document objects in the 3D view. Objects know no GUI; the GUI makes itself known here."""
from __future__ import annotations

import importlib

_dresser: str | None = None


def dress_with(module: str) -> None:
    """Name the module whose ``attach(item, source)`` gives a new object its view; imported when first needed."""
    global _dresser
    _dresser = module


def dress(item: object, source: object) -> None:
    """Give ``item`` its view, with the colours of ``source``; nothing where there is no GUI."""
    if _dresser is not None and getattr(item, "ViewObject", None) is not None:
        importlib.import_module(_dresser).attach(item, source)
