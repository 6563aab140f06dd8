# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the GUI tests share: waiting, the Report view, mouse and keyboard, and documents that leave nothing behind."""
from __future__ import annotations

import os
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui
import pytest
from pivy import coin  # before a scene graph is asked for: FreeCAD 1.1 hands none out without it

from ffds_workbench.api import certified
from ffds_workbench.compat import qt
from ffds_workbench.gui import giving_way, running
from ffds_workbench.gui.qt import QtCore, QtGui, QtWidgets, execute

QtTest = qt("QtTest")

SHOTS = os.environ.get("FFDS_SCREENSHOTS")


class Hands:
    """Mouse, keyboard and eyes."""

    def __init__(self) -> None:
        self._known = ""

    def wait(self, milliseconds: int = 100) -> None:
        """Let FreeCAD go on."""
        loop = QtCore.QEventLoop()
        QtCore.QTimer.singleShot(milliseconds, loop.quit)
        execute(loop)

    def until(self, done: Callable[[], bool], seconds: float = 60.0) -> None:
        """Wait for something to happen."""
        clock = QtCore.QElapsedTimer()
        clock.start()
        while not done():
            assert clock.elapsed() < 1000 * seconds, "it did not happen in time"
            self.wait(50)

    def at_rest(self) -> None:
        """Wait until the view has stopped turning and moving."""
        seen: list[str] = []

        def still() -> bool:
            seen.append(Gui.ActiveDocument.ActiveView.getCamera())
            return len(seen) > 4 and len(set(seen[-4:])) == 1

        self.until(still, 20)

    def idle(self) -> None:
        """Wait until nothing is computed in the background any more, and let FreeCAD hear of it."""
        self.until(lambda: not [thread for thread in threading.enumerate() if thread.name == running.WORKER])
        self.wait()

    def find(self, name: str, kind: type = QtWidgets.QWidget) -> QtWidgets.QWidget:
        """A visible widget by its object name."""
        found = [item for item in QtWidgets.QApplication.allWidgets()
                 if item.objectName() == name and isinstance(item, kind) and item.isVisible()]
        assert found, f"no visible widget {name}"
        return found[0]

    def says(self, name: str) -> str:
        """The text of a label, "" while it is hidden."""
        found = [item for item in QtWidgets.QApplication.allWidgets()
                 if item.objectName() == name and item.isVisible()]
        return found[0].text() if found else ""

    def click(self, widget: QtWidgets.QWidget, place: QtCore.QPoint | None = None) -> None:
        """Left click, at its middle unless told."""
        QtTest.QTest.mouseClick(widget, QtCore.Qt.LeftButton, QtCore.Qt.NoModifier,
                                place or widget.rect().center(), 10)
        self.wait()

    def check(self, name: str) -> None:
        """Click the box of a check box."""
        box = self.find(name)
        self.click(box, QtCore.QPoint(8, box.height() // 2))

    def button(self, role: QtWidgets.QDialogButtonBox.StandardButton) -> QtWidgets.QPushButton:
        """A button of the open task panel."""
        boxes = [item for item in Gui.getMainWindow().findChildren(QtWidgets.QDialogButtonBox) if item.isVisible()]
        return boxes[0].button(role)

    def ok(self) -> None:
        """Press OK and wait until the panel has closed, or given its place to the result."""
        self.click(self.button(QtWidgets.QDialogButtonBox.Ok))
        self.until(lambda: not Gui.Control.activeDialog() or giving_way.is_open())
        self.wait(300)

    def choose(self, *texts: str) -> None:
        """Click through the menus: ``choose("FFDS", "Scan", "Import scan…")``."""
        bar = Gui.getMainWindow().menuBar()
        for text in texts:
            found = [item for item in bar.actions() if item.text().replace("&", "") == text]
            assert found, f"no '{text}' among {[item.text() for item in bar.actions()]}"
            self.until(found[0].isEnabled, 5)
            QtTest.QTest.mouseClick(bar, QtCore.Qt.LeftButton, QtCore.Qt.NoModifier,
                                    bar.actionGeometry(found[0]).center(), 10)
            self.wait(200)
            bar = QtWidgets.QApplication.activePopupWidget()

    def press(self, key: int, modifier: int = QtCore.Qt.ControlModifier) -> None:
        """A shortcut of the main window, which without a window manager does not become active by itself."""
        Gui.getMainWindow().activateWindow()
        self.wait()
        QtTest.QTest.keyClick(Gui.getMainWindow(), key, modifier, 10)
        self.wait(300)

    def name_file(self, path: Path) -> list[str]:
        """Paste a path into the next file dialog and press Enter."""
        def enter(dialog: QtWidgets.QWidget) -> None:
            field = dialog.findChild(QtWidgets.QLineEdit, "fileNameEdit")
            QtWidgets.QApplication.clipboard().setText(str(path))
            field.selectAll()
            QtTest.QTest.keyClick(field, QtCore.Qt.Key_V, QtCore.Qt.ControlModifier)
            QtTest.QTest.keyClick(field, QtCore.Qt.Key_Return)

        return self.answer(enter)

    def drawn(self) -> bytes:
        """The coordinates of what the newest top node of the view draws."""
        graph = Gui.ActiveDocument.ActiveView.getSceneGraph()
        search = coin.SoSearchAction()
        search.setType(coin.SoCoordinate3.getClassTypeId())
        search.setInterest(coin.SoSearchAction.ALL)
        search.apply(graph.getChild(graph.getNumChildren() - 1))
        paths = search.getPaths()
        fields = [paths[k].getTail().point for k in range(paths.getLength())]
        places = [field[k].getValue() for field in fields for k in range(0, field.getNum(), 1 + field.getNum() // 9)]
        return repr(places).encode()

    def command(self, name: type) -> None:
        """Trigger the command's entry in the workbench's menu, once it is no longer grey."""
        text = name.MENU
        actions = [action for action in Gui.getMainWindow().findChildren(QtGui.QAction) if action.text() == text]
        assert actions, f"there is no '{text}'"
        self.until(actions[0].isEnabled, 5)
        actions[0].trigger()
        self.wait(200)

    def pick(self, point: tuple[float, float, float], modifier: int = QtCore.Qt.NoModifier) -> None:
        """Click in the 3D view where a point of the document is seen."""
        view = Gui.ActiveDocument.ActiveView
        window = view.graphicsView()  # held: in Qt 6 its viewport goes with the name of the window
        viewport = window.viewport()
        (x, y), (width, height) = view.getPointOnScreen(FreeCAD.Vector(*point)), view.getSize()
        place = QtCore.QPoint(round((x + 0.5) / width * viewport.width()),
                              round((1 - (y + 0.5) / height) * viewport.height()))  # the view's pixels may be smaller
        QtTest.QTest.mouseMove(viewport, place)
        self.wait(200)
        QtTest.QTest.mouseClick(viewport, QtCore.Qt.LeftButton, modifier, place, 10)
        self.wait(400)

    def answer(self, press: Callable[[QtWidgets.QWidget], None], kind: type = QtWidgets.QWidget) -> list[str]:
        """Answer the next modal dialog, of that kind; returns a list that will hold its text."""
        said: list[str] = []

        def look() -> None:
            dialog = QtWidgets.QApplication.activeModalWidget()
            if not isinstance(dialog, kind):
                QtCore.QTimer.singleShot(100, look)
                return
            said.append(dialog.text() if hasattr(dialog, "text") else dialog.windowTitle())
            press(dialog)

        QtCore.QTimer.singleShot(200, look)
        return said

    def report(self) -> str:
        """What the Report view says."""
        self.wait(250)
        views = Gui.getMainWindow().findChildren(QtWidgets.QTextEdit, "Report view")
        return "\n".join(view.toPlainText() for view in views)

    def news(self) -> str:
        """What the Report view has said since it was asked last."""
        before, self._known = self._known, self.report()
        return self._known[len(before):]

    def screenshot(self, name: str) -> None:
        """A picture of the whole screen into the folder $FFDS_SCREENSHOTS, if there is one."""
        if SHOTS:
            for dock in Gui.getMainWindow().findChildren(QtWidgets.QDockWidget):
                if dock.objectName() in ("Report view", "Python console"):
                    dock.hide()
            self.wait(500)
            subprocess.run(["import", "-window", "root", str(Path(SHOTS) / f"{name}.png")], check=True)

    def nodes(self) -> int:
        """Top nodes of the active view's scene graph, and those of the group in which FreeCAD 1.0 holds the objects."""
        graph = Gui.ActiveDocument.ActiveView.getSceneGraph()
        top = [graph.getChild(k) for k in range(graph.getNumChildren())]
        return sum(node.getNumChildren() if node.getTypeId().getName() == "Group" else 1 for node in top)


def _task_dock():
    """Where the task panels are: the combo view, or in FreeCAD 1.0 a dock of their own."""
    window = Gui.getMainWindow()
    return window.findChild(QtWidgets.QDockWidget, "Combo View") or window.findChild(QtWidgets.QDockWidget, "Tasks")


@pytest.fixture
def hands(monkeypatch):
    """Hands in an open workbench; afterwards all documents are closed and the Report view must hold no error.

    Checks for Boolean operations are given up at once: they would keep the machine busy for what other tests measure.
    `test_boolean_check` looks at how long one is waited for.
    """
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)
    used = Hands()
    Gui.getMainWindow().showMaximized()
    Gui.activateWorkbench("FFDSWorkbench")
    used.news()
    used.until(_task_dock, 5)
    _task_dock().show()
    yield used
    if Gui.Control.activeDialog():
        Gui.Control.closeDialog()
        used.wait()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    new = used.news()
    assert not [line for line in new.splitlines() if "rror" in line or "Traceback" in line or "xception" in line], new


@pytest.fixture
def plate_document(hands, plate):
    """A document with the plate and its scan, imported as a user does but for the file dialog; seen from above."""
    import Part

    from ffds_workbench.objects import actions

    document = FreeCAD.newDocument("Plate")
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = Part.read(str(plate[0]))
    actions.import_scan(document, str(plate[1]))
    document.recompute()
    document.clearUndos()
    view = Gui.ActiveDocument.ActiveView
    view.viewIsometric()
    view.fitAll()
    hands.wait(300)
    return document
