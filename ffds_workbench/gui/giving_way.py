# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages in the place of the task panel that only show something: they give way to whatever is done next."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCADGui as Gui

_open: list[Callable[[], Any]] = []


def opened(let_go: Callable[[], Any]) -> None:
    """A page has opened; ``let_go`` is called when it has to leave nothing behind."""
    _open[:] = [let_go]


def closed() -> None:
    """The page has gone."""
    _open.clear()


def is_open() -> bool:
    """Whether what is in the place of the task panel gives way."""
    return bool(_open)


def close() -> None:
    """Close the page, if one is open."""
    if _open:
        let_go = _open.pop()
        let_go()
        Gui.Control.closeDialog()
