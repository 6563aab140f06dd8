# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes a task panel with Esc and with its document, where FreeCAD would leave it open, and leaves nothing behind."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ..qt import QtCore, QtWidgets, number_of, shortcut


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


class TaskPanel:
    """A task panel that ends once, whoever closes it.

    A subclass makes ``form``, calls `_watch` once it has drawn and listens, and undoes both in `_clean_up`.
    """

    form: Any
    _open = False

    def _watch(self, document_name: str) -> None:
        """From now on the panel ends with Esc, with its document, and where FreeCAD closes it without asking it."""
        self._open = True
        self._closing = Closing(document_name, self._stop, self._close)
        self.form.destroyed.connect(self._let_go)

    def reject(self) -> bool:
        """Cancel: drop running work and leave the document as it is."""
        self._close()
        return True

    def _close(self) -> None:
        if self._open:
            self._let_go()
            QtCore.QTimer.singleShot(0, Gui.Control.closeDialog)

    def _let_go(self, *_: Any) -> None:
        if not self._open:
            return
        self._open = False
        try:
            self._closing.release()
            self._stop()
        finally:
            self._clean_up()

    def _stop(self) -> None:
        """Drop what is being computed; called at once when the document goes."""

    def _clean_up(self) -> None:
        """Take everything out of the view, and listen to nothing any more."""

    def getStandardButtons(self) -> int:
        """OK and Cancel."""
        return number_of(QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel)
