# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks for Boolean operations that go on after their part is there: they are noted, and said, when they end."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ..objects import boolean_check
from .qt import QtCore
from .translating import said, tr

_LOOK_MS = 300
_SHOWN_MS = 15_000
_followed: dict[tuple[str, str], Any] = {}
_timer = QtCore.QTimer()


def follow(item: Any, result: Any) -> None:
    """Note the outcome of the check of an object's result when it has ended, unless a newer result has come.

    Undoing the result keeps it, in case it is done again, as long as its document is open.
    """
    _followed[item.Document.Name, item.Name] = result
    _timer.start(_LOOK_MS)


def _look() -> None:
    """Note what has ended."""
    for (document, name), result in list(_followed.items()):
        if document not in FreeCAD.listDocuments():
            del _followed[document, name]
            continue
        item = FreeCAD.getDocument(document).getObject(name)
        if item is not None and result.checks.done:
            del _followed[document, name]
            boolean_check.note(item, result)
            _say(item)
    if not _followed:
        _timer.stop()


def _say(item: Any) -> None:
    text = tr("{part}: the check for Boolean operations has ended: {verdict}").format(
        part=item.Label, verdict=said(item.BooleanCheck))
    Gui.getMainWindow().statusBar().showMessage(text, _SHOWN_MS)


_timer.timeout.connect(_look)
