# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes a task panel together with its document, which FreeCAD leaves open and pointing at nothing."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD

from ..qt import QtCore


class WithDocument:
    """Ends a panel when the document of that name is closed, until it is released.

    Parameters
    ----------
    name : of the document
    stop : called at once: from then on nothing may touch the document
    close : called when FreeCAD is done with the document; not before that may the panel close
    """

    def __init__(self, name: str, stop: Callable[[], Any], close: Callable[[], Any]) -> None:
        self._name, self._stop, self._close = name, stop, close
        self.gone = False
        FreeCAD.addDocumentObserver(self)

    def slotDeletedDocument(self, document: Any) -> None:
        """FreeCAD tells of a document that goes."""
        if document.Name == self._name:
            self.gone = True
            QtCore.QTimer.singleShot(0, self._close)
            self._stop()

    def release(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)
