# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of the alignment by picked points: three on the scan, the same three on the part."""
from __future__ import annotations

from typing import Any

import FreeCADGui as Gui
import numpy as np
from pivy import coin

from ...errors import FfdsError, InputError
from ...objects.jobs.manual_alignment import prepare
from .. import running
from ..qt import QtCore, QtWidgets
from ..translating import said, tr
from ..view3d.overlay import Overlay, points_node
from ..widgets import Form, ProgressBar, named, warning, wrapped
from .closing import TaskPanel

_PAIRS = 3
_COLOURS = (0xE6194BFF, 0x2F7FC8FF, 0xF0A500FF)
_SIZE = 11.0

Point = tuple[float, float, float]


def open_panel(part: Any, scan: Any) -> None:
    """Open the panel on a part and a scan."""
    if Gui.Control.activeDialog():
        running.tell(tr("Another task is open: finish or close it first."))
        return
    with running.telling():
        Gui.Control.showDialog(PointPairsPanel(part, scan))


class PointPairsPanel(TaskPanel):
    """FreeCAD's task panel. Nothing is written into the document before OK."""

    def __init__(self, part: Any, scan: Any) -> None:
        self._part, self._scan = part, scan
        self._picked: dict[str, list[Point]] = {"scan": [], "part": []}
        self._order: list[str] = []
        self._worker: running.Worker | None = None
        self.form = Form()
        self.form.setWindowTitle(tr("Align by three points"))
        self._hint, self._state, self._message = wrapped("FfdsHint"), wrapped("FfdsPicked"), warning("FfdsMessageLabel")
        self._back = named(QtWidgets.QPushButton(tr("Take back the last point")), "FfdsBack")
        self._refine = named(QtWidgets.QCheckBox(tr("Fine alignment from there")), "FfdsRefine",
                             tr("Go on by closest points; without it the three pairs alone decide"))
        self._refine.setChecked(True)
        self._progress = named(ProgressBar(), "FfdsProgressBar")
        self._progress.setVisible(False)
        column = QtWidgets.QVBoxLayout(self.form)
        for widget in (self._hint, self._state, self._back, self._refine, self._message, self._progress):
            column.addWidget(widget)
        self._back.clicked.connect(self._take_back)
        self._overlay = Overlay(scan.Document.Name)
        Gui.Selection.clearSelection()
        Gui.Selection.addObserver(self)
        self._watch(scan.Document.Name)
        self._show()

    def addSelection(self, document: str, name: str, element: str, place: Point) -> None:
        """A point was picked in the view: it belongs to the scan or to the part, whichever was hit."""
        # Picks in the tree come without a place; a second pick on a selected object would not be told.
        QtCore.QTimer.singleShot(0, lambda: self._picked_at(document, name, tuple(place)))

    def _picked_at(self, document: str, name: str, place: Point) -> None:
        if not self._open or self._worker is not None:
            return
        if self._is_gone():
            self._close()
            return
        Gui.Selection.clearSelection()
        hit = {self._scan.Name: "scan", self._part.Name: "part"}.get(name)
        self._message.setText("")
        if document != self._scan.Document.Name or hit is None:
            self._message.setText(tr("Pick on {scan} or on {part}.").format(scan=self._scan.Label,
                                                                            part=self._part.Label))
        elif place == (0.0, 0.0, 0.0):
            self._message.setText(tr("Pick in the 3D view, not in the tree."))
        elif len(self._picked[hit]) < _PAIRS:
            self._picked[hit].append(place)
            self._order.append(hit)
        self._show()

    def _is_gone(self) -> bool:
        """Whether the part or the scan was deleted while the panel was open."""
        try:
            return not (self._scan.Name and self._part.Name)
        except ReferenceError:
            return True

    def _take_back(self) -> None:
        if self._order:
            self._picked[self._order.pop()].pop()
            self._message.setText("")
            self._show()

    def _show(self) -> None:
        counts = {kind: len(points) for kind, points in self._picked.items()}
        target = next((kind for kind in ("scan", "part") if counts[kind] < _PAIRS), None)
        label = {"scan": self._scan.Label, "part": self._part.Label}
        self._hint.setText(tr("All points are picked: press OK.") if target is None else
                           tr("Pick the {colour} point on <b>{name}</b>.").format(
                               colour=_names()[counts[target]], name=label[target]))
        self._state.setText(tr("{scan}: {on_scan} of {all}, {part}: {on_part} of {all} points. Pair by pair in the "
                               "same order: {colours}.").format(
            scan=label["scan"], on_scan=counts["scan"], part=label["part"], on_part=counts["part"], all=_PAIRS,
            colours=", ".join(_names())))
        self._back.setEnabled(bool(self._order))
        nodes = [_in_front(points_node(np.array(points), np.array(_COLOURS[:len(points)], dtype=np.uint32), _SIZE))
                 for points in self._picked.values() if points]
        self._overlay.show(nodes)

    def _arguments(self) -> tuple[list[Point], list[Point], bool]:
        if any(len(points) < _PAIRS for points in self._picked.values()):
            raise InputError(tr("Pick three points on the scan and three on the part first."))
        return self._picked["scan"], self._picked["part"], self._refine.isChecked()

    def accept(self) -> bool:
        """OK: align in the background, then move the scan in one undo step and close."""
        if self._worker is not None:
            return False
        if self._is_gone():
            return self.reject()
        try:
            work = prepare(self._part, self._scan, *self._arguments())
        except FfdsError as refusal:
            self._message.setText(said(str(refusal)))
            return False
        self._set_busy(True)
        self._worker = running.Worker(work, lambda _: self._finish(), self._failed, self._told)
        return False

    def _finish(self) -> None:
        on_scan, on_part, refine = self._arguments()
        self._close()
        with running.telling():
            running.call(self._scan.Document, "Align scan by points",
                         f"align_by_points({running.name_of(self._part)}, {running.name_of(self._scan)}, {on_scan}, "
                         f"{on_part}, refine={refine})")

    def _failed(self, failure: BaseException) -> None:
        self._worker = None
        self._set_busy(False)
        self._show()
        if not isinstance(failure, FfdsError):
            raise failure
        self._message.setText(said(str(failure)) + " " + tr("Or leave out the fine alignment."))

    def _told(self, text: str) -> None:
        self._hint.setText(text)
        self._progress.step()

    def _set_busy(self, busy: bool) -> None:
        self._progress.setValue(0)
        self._progress.setVisible(busy)
        for widget in (self._back, self._refine):
            widget.setEnabled(not busy)

    def _close(self) -> None:
        if self._open:
            super()._close()
            Gui.Selection.clearSelection()

    def _clean_up(self) -> None:
        self._overlay.remove()
        Gui.Selection.removeObserver(self)

    def _stop(self) -> None:
        if self._worker is not None:
            self._worker.cancel()


def _names() -> tuple[str, ...]:
    """The colours of the pairs."""
    return tr("red"), tr("blue"), tr("yellow")


def _in_front(node: Any) -> Any:
    """The node, drawn over whatever lies before it."""
    front = coin.SoAnnotation()
    front.addChild(node)
    return front
