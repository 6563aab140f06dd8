# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes a task panel with Esc and with its document, where FreeCAD would leave it open.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ..qt import QtCore, shortcut


class Closing:
    """Ends a panel when Esc is pressed, wherever the focus is, or its document is closed, until it is released.

    Parameters
    ----------
    name : of the document
    stop : called at once: from then on nothing may touch the document
    close : closes the panel; not called before FreeCAD is done with the document
    """

    def __init__(self, name: str, stop: Callable[[], Any], close: Callable[[], Any]) -> None:
        self._name, self._stop, self._close = name, stop, close
        self.gone = False
        self._escape = shortcut(QtCore.Qt.Key_Escape, Gui.getMainWindow())
        self._escape.activated.connect(close)
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
        self._escape.setEnabled(False)
        self._escape.deleteLater()
