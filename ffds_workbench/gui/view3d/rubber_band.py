# SPDX-License-Identifier: LGPL-2.1-or-later
"""A box that is drawn over the 3D view with the mouse, and the faces that lie in it."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui as Gui
import Part

from ..qt import QtCore, QtWidgets

_ALONG_EDGE = 6
"""Points of each edge that have to lie in the box."""


class RubberBand(QtCore.QObject):
    """Takes the next drag with the left button in the view for itself.

    Parameters
    ----------
    document_name : of the document whose active view it is
    done : called with the box, a QRect of the view's pixels; an empty one where the mouse did not move
    """

    def __init__(self, document_name: str, done: Callable[[Any], None]) -> None:
        super().__init__()
        self._done = done
        self._viewport = Gui.getDocument(document_name).ActiveView.graphicsView().viewport()
        self._band = QtWidgets.QRubberBand(QtWidgets.QRubberBand.Rectangle, self._viewport)
        self._start: Any = None
        self._viewport.installEventFilter(self)
        self._viewport.setCursor(QtCore.Qt.CrossCursor)

    def eventFilter(self, watched: Any, event: Any) -> bool:
        """As Qt asks: nothing of the drag reaches FreeCAD."""
        kind = event.type()
        if kind == QtCore.QEvent.MouseButtonPress and event.button() == QtCore.Qt.LeftButton:
            self._start = event.pos()
            self._band.setGeometry(QtCore.QRect(self._start, self._start))
            self._band.show()
        elif kind == QtCore.QEvent.MouseMove and self._start is not None:
            self._band.setGeometry(QtCore.QRect(self._start, event.pos()).normalized())
        elif kind == QtCore.QEvent.MouseButtonRelease and self._start is not None:
            box = QtCore.QRect(self._start, event.pos()).normalized()
            self.stop()
            self._done(box)
        else:
            return False
        return True

    def stop(self) -> None:
        """Take no drag any more."""
        if self._viewport is not None:
            self._viewport.removeEventFilter(self)
            self._viewport.unsetCursor()
            self._band.hide()
            self._band.deleteLater()
            self._viewport = None


def faces_within(document_name: str, box: Any, shape: Part.Shape) -> list[str]:
    """Names of the faces of a shape, in the document's coordinates, whose edges lie in a box of the view's pixels."""
    view = Gui.getDocument(document_name).ActiveView
    viewport, (width, height) = view.graphicsView().viewport(), view.getSize()

    def inside(point: FreeCAD.Vector) -> bool:
        x, y = view.getPointOnScreen(point)
        return box.contains(round((x + 0.5) / width * viewport.width()),
                            round((1 - (y + 0.5) / height) * viewport.height()))

    return [f"Face{number}" for number, face in enumerate(shape.Faces, 1)
            if all(inside(point) for edge in face.Edges if not edge.Degenerated
                   for point in edge.discretize(_ALONG_EDGE))]
