# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes a task panel together with its document, which FreeCAD leaves open and pointing at nothing."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD

from .qt import QtCore


class WithDocument:
    """Calls ``close`` when the document of that name was closed, until it is released."""

    def __init__(self, name: str, close: Callable[[], Any]) -> None:
        self._name, self._close = name, close
        FreeCAD.addDocumentObserver(self)

    def slotDeletedDocument(self, document: Any) -> None:  # noqa: N802
        """FreeCAD tells of a document that goes; the panel may only close when FreeCAD is done with it."""
        if document.Name == self._name:
            QtCore.QTimer.singleShot(0, self._close)

    def release(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)
