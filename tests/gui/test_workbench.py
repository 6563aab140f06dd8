# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's GUI knows the workbench and opens it without a warning."""
from __future__ import annotations

from pathlib import Path

import FreeCAD
import FreeCADGui as Gui

from ffds_workbench.gui.commands import GROUPS
from ffds_workbench.gui.commands.weld.find_seams import FindSeams
from ffds_workbench.gui.qt import QtCore, QtGui, QtWidgets, execute


def _report_view() -> str:
    loop = QtCore.QEventLoop()
    QtCore.QTimer.singleShot(300, loop.quit)
    execute(loop)
    views = Gui.getMainWindow().findChildren(QtWidgets.QTextEdit, "Report view")
    return "\n".join(view.toPlainText() for view in views)


def test_the_workbench_opens_without_a_warning():
    Gui.activateWorkbench("NoneWorkbench")
    before = _report_view()
    Gui.activateWorkbench("FFDSWorkbench")
    assert Gui.activeWorkbench().name() == "FFDSWorkbench"
    new = _report_view()[len(before):]
    assert not [line for line in new.splitlines() if "arning" in line or "rror" in line or "Traceback" in line]


def test_the_documentation_opens_built_or_not(monkeypatch, tmp_path):
    from ffds_workbench.gui.commands.learn import show_documentation

    opened = []

    class Services:
        @staticmethod
        def openUrl(url):
            opened.append(Path(url.toLocalFile()))
            return True

    monkeypatch.setattr(show_documentation.QtGui, "QDesktopServices", Services)
    monkeypatch.setattr(show_documentation, "ROOT", tmp_path)
    show_documentation.ShowDocumentation().run()
    built = tmp_path / "out" / "docs" / "index.html"
    built.parent.mkdir(parents=True)
    built.write_text("")
    show_documentation.ShowDocumentation().run()
    assert opened[0].name == "index.md" and opened[0].is_file() and opened[1] == built


def test_the_workbench_has_an_icon_and_a_name():
    workbench = Gui.getWorkbench("FFDSWorkbench")
    assert Path(workbench.Icon).is_file()
    assert workbench.MenuText == "FFDS"


def test_no_button_is_cut_off_and_a_grey_one_says_why(hands):
    window = Gui.getMainWindow()
    window.showNormal()
    window.resize(1280, 780)
    hands.wait(300)
    Gui.activateWorkbench("NoneWorkbench")
    Gui.activateWorkbench("FFDSWorkbench")
    hands.wait(300)
    bars = [window.findChild(QtWidgets.QToolBar, f"FFDS {title}") for title in GROUPS]
    assert all(bar.isVisible() and bar.width() >= bar.sizeHint().width() for bar in bars)
    grey = window.findChild(QtGui.QAction, FindSeams.NAME)
    hands.until(lambda: "Select one part, or edges of one, first." in grey.toolTip(), 5)
    document = FreeCAD.newDocument("Live")
    Gui.Selection.addSelection(document.addObject("Part::Box", "Box"))
    document.recompute()
    hands.until(grey.isEnabled, 5)
    assert "Select one part" not in grey.toolTip()


def test_the_first_steps_load_the_example(hands):
    hands.choose("FFDS", "Learn", "First steps")
    hands.click(hands.find("FFDS_LoadExample_Step"))
    hands.until(lambda: FreeCAD.ActiveDocument is not None and len(FreeCAD.ActiveDocument.Objects) == 2, 10)
    hands.screenshot("first_steps")
    hands.find("FfdsFirstSteps").close()
