# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the GUI runs things: one undo step per command, work in the background, refusals as one sentence."""
from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import FreeCADGui as Gui

from ..errors import FfdsError, RefusedError
from .qt import QtCore, QtWidgets, execute
from .translating import said, tr
from .widgets import ProgressBar, named

ACTIONS = "ffds_workbench.objects.actions"
WORKER = "FfdsWorker"
"""Name of the threads in which work is done."""
_POLL_MS = 15
_PATIENCE = 0.3
"""Seconds."""


class Cancelled(RefusedError):
    """The user does not want the result any more."""

    def __init__(self) -> None:
        super().__init__(tr("It was cancelled: recompute to take it up again."))


@contextmanager
def telling() -> Iterator[None]:
    """What is refused within goes to the user as a sentence; a cancellation ends quietly."""
    try:
        yield
    except Cancelled:
        return
    except FfdsError as refusal:
        tell(said(str(refusal)))


def tell(*sentences: str) -> None:
    """Show a sentence in a dialog, or several as a list."""
    if len(sentences) > 1:
        execute(_listing("FFDS", sentences, QtWidgets.QDialogButtonBox.Ok))
        return
    box = QtWidgets.QMessageBox(QtWidgets.QMessageBox.Warning, "FFDS", sentences[0], QtWidgets.QMessageBox.Ok,
                                Gui.getMainWindow())
    box.setObjectName("FfdsMessage")
    execute(box)


def ask(title: str, sentences: Sequence[str], answers: Sequence[str]) -> int:
    """Show sentences as a list, and ask what to do; the number of the answer.

    Raises
    ------
    Cancelled : the user pressed Cancel
    """
    dialog = _listing(title, sentences, QtWidgets.QDialogButtonBox.Cancel)
    buttons = dialog.findChild(QtWidgets.QDialogButtonBox)
    for number, text in enumerate(answers, 1):
        button = buttons.addButton(text, QtWidgets.QDialogButtonBox.ActionRole)
        button.clicked.connect(lambda _=False, number=number: dialog.done(number))
    chosen = execute(dialog)
    if not chosen:
        raise Cancelled
    return chosen - 1


def _listing(title: str, sentences: Sequence[str], standard: Any) -> Any:
    """A dialog with sentences below each other, and a button to end it."""
    dialog = named(QtWidgets.QDialog(Gui.getMainWindow()), "FfdsMessage")
    dialog.setWindowTitle(title)
    listed = named(QtWidgets.QListWidget(), "FfdsSentences")
    listed.setWordWrap(True)
    listed.setAlternatingRowColors(True)
    listed.addItems(list(sentences))
    buttons = named(QtWidgets.QDialogButtonBox(standard), "FfdsAnswers")
    buttons.accepted.connect(dialog.accept)
    buttons.rejected.connect(dialog.reject)
    column = QtWidgets.QVBoxLayout(dialog)
    column.addWidget(listed)
    column.addWidget(buttons)
    dialog.resize(600, 90 + 40 * min(len(sentences), 8))
    return dialog


def name_of(item: Any) -> str:
    """Python text that finds a document object again; None for none."""
    return f"FreeCAD.getDocument({item.Document.Name!r}).getObject({item.Name!r})" if item is not None else "None"


def call(document: Any, title: str, line: str) -> None:
    """Run a recordable line of Python that calls `ACTIONS`, as one undo step; a failure leaves nothing behind."""
    document.openTransaction(tr(title))
    try:
        record(line)
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()


def record(line: str, name: str = "") -> None:
    """Run a line of Python that calls `ACTIONS`, and record it with its import; ``name`` keeps what it gives.

    ``Gui.addModule`` would record the import once per session, and macros that start later would lack it.
    """
    Gui.doCommand(f"import {ACTIONS}")
    Gui.doCommand(f"{name} = {ACTIONS}.{line}" if name else f"{ACTIONS}.{line}")


class Worker(QtCore.QObject):
    """Runs ``work(progress)`` in a thread and reports on the main one.

    Parameters
    ----------
    work : touches no document; the thread ends at the next ``progress`` after a cancellation
    done : called with the result
    failed : called with the exception
    told : called with what is being done, in the user's language
    """

    def __init__(self, work: Callable[[Callable[[str], None]], Any], done: Callable[[Any], None],
                 failed: Callable[[BaseException], None], told: Callable[[str], None]) -> None:
        super().__init__()
        self._calls = {"done": done, "failed": failed, "told": told}
        self._work = work
        self._news: queue.SimpleQueue = queue.SimpleQueue()
        self._cancelled = threading.Event()
        self._timer = QtCore.QTimer(self)
        self._timer.timeout.connect(self._report)
        self._timer.start(_POLL_MS)
        self._thread = threading.Thread(target=self._run, name=WORKER, daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Let the work go on for so long, or until it has ended, and report."""
        self._thread.join(seconds)
        self._report()

    def cancel(self) -> None:
        """Drop the result; nothing more is reported."""
        self._cancelled.set()
        self._timer.stop()

    def _run(self) -> None:
        try:
            self._news.put(("done", self._work(self._progress)))
        except BaseException as failure:
            self._news.put(("failed", failure))

    def _progress(self, text: str) -> None:
        if self._cancelled.is_set():
            raise Cancelled
        self._news.put(("told", text))

    def _report(self) -> None:
        while not self._cancelled.is_set() and not self._news.empty():
            kind, value = self._news.get()
            if kind != "told":
                self._timer.stop()
            self._calls[kind](said(value) if kind == "told" else value)


def in_background(title: str, work: Callable[[Callable[[str], None]], Any]) -> Any:
    """The value of ``work(progress)``, while FreeCAD stays alive behind a dialog with a Cancel button.

    What is done within `_PATIENCE` shows no dialog; nothing else happens in FreeCAD before there is one.

    Raises
    ------
    Cancelled : the user pressed Cancel
    Exception : whatever the work raised
    """
    dialog = QtWidgets.QProgressDialog(title, tr("Cancel"), 0, 0, Gui.getMainWindow())
    bar = ProgressBar()
    dialog.setBar(bar)
    dialog.setObjectName("FfdsProgress")
    dialog.setWindowTitle("FFDS")
    dialog.setWindowModality(QtCore.Qt.ApplicationModal)
    dialog.setRange(bar.minimum(), bar.maximum())
    dialog.setMinimumDuration(0)
    dialog.setAutoReset(False)
    loop = QtCore.QEventLoop()
    outcome: dict[str, Any] = {}

    def ended(kind: str, value: Any) -> None:
        outcome.setdefault(kind, value)
        loop.quit()

    def told(text: str) -> None:
        dialog.setLabelText(text)
        bar.step()

    worker = Worker(work, lambda value: ended("value", value), lambda failure: ended("failure", failure), told)
    dialog.canceled.connect(lambda: ended("failure", Cancelled()))
    try:
        worker.wait(_PATIENCE)
        if not outcome:
            dialog.setValue(0)
            dialog.show()
            execute(loop)
    finally:
        worker.cancel()
        dialog.close()
        dialog.deleteLater()
    if "value" in outcome:
        return outcome["value"]
    raise outcome["failure"]


def computing(label: str, work: Callable[[Callable[[str], None]], Any]) -> Any:
    """What an object that is named so asks for while it is recomputed: `in_background`, with its name."""
    return in_background(tr("Computing {part}").format(part=label), work)
