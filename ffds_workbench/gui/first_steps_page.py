# SPDX-License-Identifier: LGPL-2.1-or-later
"""The first steps: a small window that stays in front while one walks through the example."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui

from .qt import QtCore, QtWidgets
from .translating import tr
from .widgets import named, wrapped

_WIDE = 340
"""Pixels."""


def _steps() -> list[tuple[str, tuple[str, ...]]]:
    """What each step is, and the commands that do it."""
    return [
        (tr("<b>Load the example</b>: a sheet-metal bracket, and a scan of it as it came out of the press, in blue."),
         ("FFDS_LoadExample",)),
        (tr("<b>Click the upright face</b> in the 3D view, through the scan that lies on it: FFDS takes the face that "
            "the scan shows. Ctrl adds more faces."), ()),
        (tr("<b>Deform it</b>: the preview follows every setting. Press OK when you like it; or deform the whole part, "
            "where faces that the scan does not see are carried along."), ("FFDS_DeformFaces", "FFDS_DeformWorkpiece")),
        (tr("<b>Read the result</b>: a verdict in a sentence, a table of the faces, and what to look at. A click on a "
            "row shows its face."), ("FFDS_ShowResult",)),
        (tr("<b>Look at the deviation</b>, before and after, and read values under the cursor."),
         ("FFDS_ShowDeviation",)),
        (tr("<b>Go on</b>: find weld seams, or write the as-built part. Everything is one undo step: Ctrl+Z."),
         ("FFDS_FindSeams", "FFDS_ExportAsBuilt"))]


def show_page() -> None:
    """Show the page, or bring it to the front where it is open."""
    page = Gui.getMainWindow().findChild(QtWidgets.QDialog, "FfdsFirstSteps") or _page()
    page.show()
    page.raise_()


def _page() -> Any:
    page = named(QtWidgets.QDialog(Gui.getMainWindow()), "FfdsFirstSteps")
    page.setWindowTitle(tr("First steps with FFDS"))
    page.setWindowFlag(QtCore.Qt.Tool)
    rows = QtWidgets.QGridLayout(page)
    rows.setColumnStretch(1, 1)
    rows.setVerticalSpacing(3)
    line = 0
    for number, (text, commands) in enumerate(_steps(), 1):
        figure = QtWidgets.QLabel(f"<b>{number}</b>")
        rows.addWidget(figure, line, 0, QtCore.Qt.AlignTop)
        label = wrapped(f"FfdsStep{number}")
        label.setText(text)
        rows.addWidget(label, line, 1)
        row = QtWidgets.QHBoxLayout()
        for command in commands:
            row.addWidget(_button(command))
        row.addStretch(1)
        rows.addLayout(row, line + 1, 1)
        line += 2
    page.resize(_WIDE, page.sizeHint().height())
    window = Gui.getMainWindow().geometry()
    page.move(window.right() - _WIDE - 40, window.top() + 160)
    return page


def _button(command: str) -> Any:
    """A button that runs a command of the workbench, with its icon and its words."""
    known = Gui.Command.get(command).getInfo()
    button = named(QtWidgets.QPushButton(Gui.getIcon(known["pixmap"]),
                                         FreeCAD.Qt.translate(command, known["menuText"])), f"{command}_Step")
    button.clicked.connect(lambda: Gui.runCommand(command))
    return button
