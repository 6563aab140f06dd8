# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of the preparation: steps on one side, what each takes away and leaves in the view on the other."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCADGui as Gui
import numpy as np
from numpy.typing import NDArray

from ... import api
from ...errors import FfdsError
from ...objects.jobs.preparation_job import prepare
from ...objects.scans import scan_points
from ...scan.preparation.spacing import spacing
from .. import running
from ..qt import QtCore
from ..translating import said, tr
from ..view3d.overlay import Overlay, points_node
from .closing import TaskPanel
from .preparation_form import GOES, STAYS, PreparationForm, titles

_REST_MS = 400
"""The preview begins when nothing was touched for so long."""
_SIZES = {GOES: 2.0, STAYS: 3.0}
"""Of the points in the view, pixels."""


def open_panel(scans: Sequence[Any], part: Any = None) -> None:
    """Open the panel on one scan or several of one part, which is needed for cropping to it alone."""
    with running.telling():
        Gui.Control.showDialog(PreparationPanel(scans, part))


class PreparationPanel(TaskPanel):
    """FreeCAD's task panel. Nothing is written into the document before OK."""

    def __init__(self, scans: Sequence[Any], part: Any) -> None:
        self._scans, self._part = list(scans), part
        self._document = scans[0].Document
        self._given = np.concatenate([scan_points(scan) for scan in scans])
        self._origin = np.round(self._given.mean(axis=0))
        self._found: api.PreparedScan | None = None
        self._worker: running.Worker | None = None
        self._view = Gui.getDocument(self._document.Name).ActiveView
        self.form = PreparationForm([scan.Label for scan in scans], part.Label if part is not None else "",
                                    self._given, spacing(self._given), self._eye)
        self._rest = QtCore.QTimer(self.form)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._begin)
        self.form.changed.connect(self._changed)
        self.form.looked_at.connect(self._draw)
        Gui.Selection.clearSelection()
        self._overlay = Overlay(self._document.Name)
        self._overlay.cover(*scans)
        self._watch(self._document.Name)
        self._draw()
        self._changed()

    def _eye(self) -> tuple[float, ...]:
        return self._view.getCameraNode().position.getValue().getValue()

    def _changed(self) -> None:
        self._stop()
        self._found = None
        self._rest.start(_REST_MS)

    def _begin(self) -> None:
        wanted = self.form.settings()
        if not wanted:
            self.form.offer([])
            self.form.tell(tr("{count} points. Choose what shall be done.").format(count=f"{len(self._given):,}"))
            self._draw()
            return
        try:
            work = prepare(self._scans, self._part if "near" in wanted else None, **wanted)
        except FfdsError as refusal:
            self.form.refuse(said(str(refusal)))
            return
        self.form.show_progress(True)
        self._worker = running.Worker(work, self._came, self._failed, lambda _: self.form.step_progress())

    def _came(self, found: api.PreparedScan) -> None:
        self._worker, self._found = None, found
        self.form.show_progress(False)
        named = titles()
        self.form.offer([(named[step.name], step.name) for step in found.steps])
        rows = "".join(f"<tr><td>{named[step.name]}</td><td align='right'>&nbsp; {step.before:,} →</td>"
                       f"<td align='right'>&nbsp;{step.after:,}</td></tr>" for step in found.steps)
        notes = "".join(f"<p>{said(step.note)}</p>" for step in found.steps if step.note)
        self.form.tell(f"<table>{rows}</table>{notes}" + tr(
            "One point every {before} mm, now {after} mm. Light blue stays, red goes.").format(
            before=f"{found.spacing[0]:.3g}", after=f"{found.spacing[1]:.3g}"))
        self._draw()

    def _failed(self, failure: BaseException) -> None:
        self._worker = None
        self.form.show_progress(False)
        if not isinstance(failure, FfdsError):
            raise failure
        self.form.refuse(said(str(failure)))
        self._draw()

    def _draw(self) -> None:
        """Show the step that is looked at; of points in the same place the first that are drawn are seen."""
        name, state = self.form.shown
        before, after = self._of_step(name)
        drawn = {"before": [(before, GOES)], "after": [(after, STAYS)],
                 "both": [(after, STAYS), (before, GOES)]}[state if self._found is not None else "after"]
        frame = np.eye(4)
        frame[:3, 3] = self._origin
        self._overlay.show([points_node(points - self._origin, np.full(len(points), colour, dtype=np.uint32),
                                        _SIZES[colour]) for points, colour in drawn], frame)

    def _of_step(self, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The points (n, 3) before and after a step, or all of them."""
        if self._found is None:
            return self._given, self._given
        clouds = [self._given, *(step.points for step in self._found.steps)]
        number = next((k for k, step in enumerate(self._found.steps, 1) if step.name == name), None)
        return (clouds[0], clouds[-1]) if number is None else (clouds[number - 1], clouds[number])

    def accept(self) -> bool:
        """OK: prepare in the background where that has not happened yet, then write the points in one undo step."""
        wanted = self.form.settings()
        if not wanted:
            self._rest.stop()
            self.form.refuse(tr("Choose what shall be done first."))
            return False
        part = self._part if "near" in wanted else None
        self._close()
        names = ", ".join(running.name_of(scan) for scan in self._scans)
        settings = "".join(f", {name}={value!r}" for name, value in wanted.items())
        with running.telling():
            running.call(self._document, "Prepare scan",
                         f"prepare_scan([{names}], {running.name_of(part)}{settings})")
        return False

    def _clean_up(self) -> None:
        self._overlay.remove()

    def _stop(self) -> None:
        if self._worker is not None:
            self._worker.cancel()
            self._worker = None
