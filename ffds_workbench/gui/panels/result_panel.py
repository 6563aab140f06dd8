# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result page: the verdict on an as-built part, its faces in a table, what to look at, and where to go on."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...objects.as_built import report_of
from ...objects.boolean_check import RUNNING
from ...report import verdict
from .. import giving_way
from ..qt import QtCore, QtGui, QtWidgets, number_of
from ..translating import said, tr
from ..widgets import DOUBTFUL, Form, named, wrapped
from .closing import Closing

_GOOD = "#2e7d43"
_NAME = QtCore.Qt.UserRole


def _heads() -> list[str]:
    return [tr("Face"), tr("before"), tr("after"), tr("±"), tr("seen"), tr("from")]


def _flags() -> dict[str, str]:
    return {"observed": tr("scan"), "bridged": tr("bridged"), "carried": tr("carried"), "nominal": tr("nominal")}


def open_page(item: Any) -> None:
    """Open the page of an as-built part in the place of the task panel; nothing where another task is open."""
    giving_way.close()
    if not Gui.Control.activeDialog() and report_of(item):
        page = ResultPage(item)
        Gui.Control.showDialog(page)
        giving_way.opened(page.let_go)


class ResultPage:
    """FreeCAD's task panel. It only shows, and gives way to any command."""

    def __init__(self, item: Any) -> None:
        self._item, self._open = item, True
        self.form = Form()
        self.form.setWindowTitle(tr("Result"))
        self._verdict, self._check = wrapped("FfdsVerdict"), wrapped("FfdsBooleanCheck")
        self._table = named(_Table(), "FfdsFaces", tr(
            "Mean deviation of each face in mm, half the width of its 95 % band (±), how much of it the scan shows, "
            "and where its shape comes from. A click shows the face."))
        self._advice = QtWidgets.QVBoxLayout()
        column = QtWidgets.QVBoxLayout(self.form)
        for widget in (self._verdict, self._table, self._check):
            column.addWidget(widget)
        column.addLayout(self._advice)
        column.addLayout(self._ways_on())
        self._table.itemClicked.connect(lambda entry: self._look_at([entry.data(_NAME)]))
        FreeCAD.addDocumentObserver(self)
        self._closing = Closing(item.Document.Name, self.let_go, self._close)
        self.form.destroyed.connect(self.let_go)
        self._fill()

    def _ways_on(self) -> Any:
        """Buttons that lead on; each begins with the part selected."""
        grid = QtWidgets.QGridLayout()
        ways = ((tr("Deviation"), "FFDS_ShowDeviation"), (tr("Weld seams…"), "FFDS_FindSeams"),
                (tr("Export…"), "FFDS_ExportAsBuilt"), (tr("Settings…"), "FFDS_DeformFaces"),
                (tr("Report…"), "FFDS_ExportReport"))
        for number, (text, command) in enumerate(ways):
            button = named(QtWidgets.QPushButton(text), f"{command}_Way")
            button.clicked.connect(lambda _=False, command=command: self._go_on(command))
            grid.addWidget(button, *divmod(number, 2))
        return grid

    def _go_on(self, command: str) -> None:
        item = self._item
        self._close()
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(item.Document.Name, item.Name)
        QtCore.QTimer.singleShot(0, lambda: Gui.runCommand(command))

    def _fill(self) -> None:
        """Show what the part's report says now."""
        report = report_of(self._item)
        good = verdict.fits(report, report["deviation_after"])
        self._verdict.setText(f"<b>{self._item.Label}</b><br><span style='color: {_GOOD if good else DOUBTFUL}'>"
                              f"{said(verdict.verdict_sentence(report))}</span><br>"
                              + tr("All faces, edges and corners are those of the nominal part."))
        self._table.fill(report)
        running = self._item.BooleanCheck == RUNNING
        self._check.setText(tr("The check for Boolean operations goes on in the background.") if running else
                            tr("Check for Boolean operations: {verdict}.").format(
                                verdict=said(self._item.BooleanCheck)))
        while self._advice.count():
            self._advice.takeAt(0).widget().deleteLater()
        for number, entry in enumerate(verdict.advice(report)):
            self._advice.addWidget(self._row(number, entry))

    def _row(self, number: int, entry: verdict.Advice) -> Any:
        """A sentence, and the button that does what it proposes."""
        holder = QtWidgets.QWidget()
        row = QtWidgets.QHBoxLayout(holder)
        row.setContentsMargins(0, 0, 0, 0)
        label = wrapped(f"FfdsAdvice{number}")
        label.setText(said(entry.text))
        row.addWidget(label, 1)
        does = {verdict.SHOW: (tr("Show"), lambda: self._look_at(entry.faces)),
                verdict.DEVIATION: (tr("Deviation"), lambda: self._go_on("FFDS_ShowDeviation")),
                verdict.SCAN: (tr("Import scan…"), lambda: self._go_on("FFDS_ImportScan"))}
        text, action = does[entry.proposes]
        if entry.faces or entry.proposes != verdict.SHOW:
            button = named(QtWidgets.QToolButton(), f"FfdsAdviceButton{number}")
            button.setText(text)
            button.clicked.connect(action)
            row.addWidget(button)
        return holder

    def _look_at(self, names: Any) -> None:
        """Light faces of the part and bring them near."""
        Gui.Selection.clearSelection()
        for name in names:
            Gui.Selection.addSelection(self._item.Document.Name, self._item.Name, name)
        Gui.SendMsgToActiveView("ViewSelection")

    def slotChangedObject(self, item: Any, name: str) -> None:
        """FreeCAD tells of a property: the check has ended, or the part was computed anew."""
        if self._open and item is self._item and name == "BooleanCheck":
            self._fill()

    def slotDeletedObject(self, item: Any) -> None:
        """FreeCAD tells of an object that goes, by undo for instance."""
        if self._open and item is self._item:
            self.let_go()
            QtCore.QTimer.singleShot(0, Gui.Control.closeDialog)

    def let_go(self, *_: Any) -> None:
        """Leave nothing behind, also where FreeCAD closed the page without asking it."""
        if self._open:
            self._open = False
            giving_way.closed()
            FreeCAD.removeDocumentObserver(self)
            self._closing.release()

    def _close(self) -> None:
        self.let_go()
        Gui.Control.closeDialog()

    def reject(self) -> bool:
        """Close."""
        self.let_go()
        return True

    def getStandardButtons(self) -> int:
        """Close."""
        return number_of(QtWidgets.QDialogButtonBox.Close)

    def isAllowedAlterDocument(self) -> bool:
        """Undo and the like go on working."""
        return True

    def isAllowedAlterSelection(self) -> bool:
        """As `isAllowedAlterDocument`."""
        return True

    def isAllowedAlterView(self) -> bool:
        """As `isAllowedAlterDocument`."""
        return True


class _Table(QtWidgets.QTableWidget):
    """The faces of a report, those first that the scan shows."""

    def __init__(self) -> None:
        super().__init__(0, len(_heads()))
        self.setHorizontalHeaderLabels(_heads())
        self.verticalHeader().hide()
        self.setEditTriggers(self.NoEditTriggers)
        self.setSelectionBehavior(self.SelectRows)
        self.horizontalHeader().setSectionResizeMode(QtWidgets.QHeaderView.ResizeToContents)
        self.horizontalHeader().setStretchLastSection(True)
        self.setMinimumHeight(180)

    def fill(self, report: dict[str, Any]) -> None:
        """Show a report's faces."""
        faces = sorted(report["faces"], key=lambda face: not face["points"])
        self.setRowCount(len(faces))
        for row, face in enumerate(faces):
            before, after = face["deviation_before"], face["deviation_after"]
            cells = [face["name"], _length(before and before["mean"]), _length(after and after["mean"]),
                     _length(face["band"]), f"{100 * face['coverage']:.0f} %", _flags()[face["flag"]]]
            for column, text in enumerate(cells):
                entry = QtWidgets.QTableWidgetItem(text)
                entry.setData(_NAME, face["name"])
                if 0 < column < len(cells) - 1:
                    entry.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
                if column == 2 and after:
                    entry.setForeground(QtGui.QColor(_GOOD if verdict.fits(report, after) else DOUBTFUL))
                self.setItem(row, column, entry)


def _length(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
