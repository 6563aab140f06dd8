# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of seams: which come into the programs, in which order, and what each is like."""
from __future__ import annotations

import json
from typing import Any

import FreeCADGui as Gui
import numpy as np

from ...objects.seams import chosen_names, keys_of, stations_of
from .. import giving_way, running
from ..qt import QtCore, QtWidgets
from ..translating import tr
from ..view3d.overlay import Overlay, bright_node
from ..widgets import Form, named, wrapped
from .closing import TaskPanel

_KEY = QtCore.Qt.UserRole


def open_panel(item: Any) -> None:
    """Open the panel of a Seams object."""
    giving_way.close()
    if Gui.Control.activeDialog():
        running.tell(tr("Another task is open: finish or close it first."))
    elif item.Report:
        Gui.Control.showDialog(SeamsPanel(item))


class SeamsPanel(TaskPanel):
    """FreeCAD's task panel. Nothing is written into the document before OK."""

    def __init__(self, item: Any) -> None:
        self._item = item
        self.form = Form()
        self.form.setWindowTitle(tr("Weld seams"))
        self._list = named(QtWidgets.QTreeWidget(), "FfdsSeams", tr(
            "Ticked seams come into the programs, in this order: drag them. A click shows the seam."))
        self._list.setHeaderLabels([tr("Seam"), tr("joint"), tr("mm"), tr("gap"), tr("verdict")])
        self._list.setRootIsDecorated(False)
        self._list.setDragDropMode(QtWidgets.QAbstractItemView.InternalMove)
        self._list.setMinimumHeight(220)
        self._notes = wrapped("FfdsSeamNotes")
        self._notes.setText("<br>".join(item.Notes))
        column = QtWidgets.QVBoxLayout(self.form)
        column.addWidget(self._list)
        column.addWidget(self._notes)
        self._fill()
        self._overlay = Overlay(item.Document.Name)
        self._list.currentItemChanged.connect(self._light)
        Gui.Selection.clearSelection()
        self._watch(item.Document.Name)

    def _fill(self) -> None:
        """One row per seam, those of the programs first and in their order."""
        records = dict(zip(keys_of(self._item), json.loads(self._item.Report)["seams"], strict=True))
        chosen = chosen_names(self._item)
        for key in (*chosen, *(key for key in records if key not in chosen)):
            row = QtWidgets.QTreeWidgetItem(self._list, [key, *_cells(records[key])])
            row.setData(0, _KEY, key)
            row.setFlags(row.flags() & ~QtCore.Qt.ItemIsDropEnabled | QtCore.Qt.ItemIsUserCheckable)
            row.setCheckState(0, QtCore.Qt.Checked if key in chosen else QtCore.Qt.Unchecked)
            for column in range(self._list.columnCount()):
                row.setToolTip(column, row.text(4))  # the panel is often too narrow for it
            row.setData(4, _KEY, bool(records[key]["exceeded"]))
        for column in range(self._list.columnCount()):
            self._list.resizeColumnToContents(column)

    def _light(self, row: Any, *_: Any) -> None:
        """Draw the seam of a row in front of everything."""
        if row is None or not self._open:
            return
        stations = stations_of(self._item)
        number = np.unique(stations["seam"])[keys_of(self._item).index(row.data(0, _KEY))]
        points = np.stack([stations[axis] for axis in "xyz"], axis=1)[stations["seam"] == number]
        self._overlay.show([bright_node(points)])

    def accept(self) -> bool:
        """OK: write what comes into the programs, in one undo step."""
        rows = [self._list.topLevelItem(k) for k in range(self._list.topLevelItemCount())]
        ticked = [row for row in rows if row.checkState(0) == QtCore.Qt.Checked]
        if not ticked:
            running.tell(tr("No seam is ticked: tick those that the robot is to weld."))
            return False
        names = [row.data(0, _KEY) for row in ticked]
        failing = any(row.data(4, _KEY) for row in ticked)
        self._let_go()
        running.call(self._item.Document, "Choose seams",
                     f"choose_seams({running.name_of(self._item)}, {names}, keep_failing={failing})")
        return True

    def _clean_up(self) -> None:
        self._overlay.remove()


def _cells(record: dict[str, Any]) -> list[str]:
    """Joint, length, gap and verdict of a seam's record."""
    gap, words = record["largest"]["gap"], _words()
    verdict = {None: tr("nothing to compare"), "pass": tr("within all limits")}.get(
        record["verdict"], tr("beyond: {names}").format(names=", ".join(words[name] for name in record["exceeded"])))
    return [words.get(record["joint"], record["joint"]), f"{record['length']:.1f}",
            "–" if gap is None else f"{gap:.2f}", verdict]


def _words() -> dict[str, str]:
    """What joints and figures are called."""
    return {"edge": tr("edge"), "T": tr("T"), "lap": tr("lap"), "corner": tr("corner"), "butt": tr("butt"),
            "pipe": tr("pipe"), "lateral": tr("lateral"), "normal": tr("normal"), "longitudinal": tr("longitudinal"),
            "gap": tr("gap"), "opening": tr("opening"), "rotation": tr("rotation")}
