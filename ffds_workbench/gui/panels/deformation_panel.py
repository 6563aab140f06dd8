# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of the deformation: what is picked and set on one side, the live preview on the other."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import FreeCADGui as Gui
import numpy as np

from ...api.methods import OtherSideError
from ...errors import FfdsError, InputError
from ...objects.as_built import is_as_built, request_of
from ...objects.jobs.registration_job import Job, make_job
from ...objects.sources import Source, standing_for
from ...registration.request import RegistrationRequest
from .. import giving_way, running
from ..preferences import preferences
from ..preview.drawing import PICKED, SHOWN, WRONG, PreviewDrawing, marks
from ..preview.patches import Patch, figures
from ..preview.runner import PreviewRunner
from ..qt import QtCore, QtWidgets
from ..selection import Chosen, chosen, scans_of
from ..translating import said, tr
from ..view3d.colours import good_limit
from ..view3d.overlay import Overlay
from ..view3d.rubber_band import RubberBand
from .closing import TaskPanel
from .deformation_form import DeformationForm
from .picking import Picking, faces_in_box, one_shown
from .result_panel import open_page

_SCAN_TRANSPARENCY = 0.7
"""Of the scans while the panel is open."""


def open_panel(document: Any, item: Any = None, whole: bool = False) -> None:
    """Open the panel on the selection, on the whole part, or on the as-built part ``item`` to change it."""
    giving_way.close()
    if Gui.Control.activeDialog():
        running.tell(tr("Another task is open: finish or close it first."))
        return
    with running.telling():
        Gui.Control.showDialog(DeformationPanel(document, item, whole))


class DeformationPanel(TaskPanel):
    """FreeCAD's task panel. Nothing is written into the document before OK."""

    def __init__(self, document: Any, item: Any, whole: bool) -> None:
        self._document, self._item = document, item
        self._adding = False
        self._band: RubberBand | None = None
        self._read: tuple[tuple[Any, Any], Source, Any] | None = None
        self._drawn_of: tuple[Any, Any] | None = None
        self._worker: running.Worker | None = None
        self._wished = preferences()
        self.form = DeformationForm(scans_of(document), item is not None)
        self._picking = Picking(item, self.form)
        self._take(item, chosen(), whole)
        Gui.Selection.clearSelection()
        self._overlay = Overlay(document.Name)
        self._overlay.pick_through(scans_of(document))
        self._overlay.fade(scans_of(document), _SCAN_TRANSPARENCY)
        self._drawing = PreviewDrawing(self._overlay)
        self._runner = PreviewRunner(self._draw, self._draw_nothing, self._told)
        self.form.changed.connect(self._preview)
        self.form.by_box.clicked.connect(self._draw_box)
        Gui.Selection.addObserver(self)
        self._watch(document.Name)
        QtCore.QTimer.singleShot(0, self._preview)

    def _take(self, item: Any, selected: Chosen, whole: bool) -> None:
        """Start from an as-built part, or from what is selected."""
        if item is not None:
            request = request_of(item)
            self._picking.faces = request.faces or ()
            self.form.take(request, item.Scan)
        else:
            self._picking.take(selected)
        if whole:
            self._picking.faces = ()
        self.form.set_whole(whole or item is not None and not self._picking.faces)
        self._picking.show()

    def addSelection(self, *_: Any) -> None:
        """Something was picked in the view or in the tree: read the selection once FreeCAD is done with it."""
        self._adding = bool(QtWidgets.QApplication.keyboardModifiers() & QtCore.Qt.ControlModifier)
        QtCore.QTimer.singleShot(0, self._selection_changed)

    def _selection_changed(self) -> None:
        if not self._open or self.form.busy:
            return
        selected = chosen()
        if not (selected.parts or selected.scans or selected.others or selected.refusal):
            return
        self._picking.take(selected, self._adding)
        Gui.Selection.clearSelection()  # what is selected would shine through the preview
        self._picking.show()
        self._preview()

    def _draw_box(self) -> None:
        """The next drag in the view picks the faces in its box."""
        if self._band is not None:
            self._band.stop()
        self._band = RubberBand(self._document.Name, self._boxed)

    def _boxed(self, box: Any) -> None:
        """Pick the faces in a box that the scan shows; all of them where it shows none."""
        with running.telling():
            part = self._picking.source or one_shown(self._document)
            scan = self.form.scan(self._document)
            self._picking.hint = ""
            faces = faces_in_box(self._document.Name, box, part, scan)
            self._picking.pick(standing_for(part), faces, False)
            self._picking.show()
            self._preview()

    def _job(self) -> Job:
        """The registration that is set now (InputError where something is missing)."""
        scan = self.form.scan(self._document)
        if self._picking.source is None:
            raise InputError(tr("Pick the part in the 3D view.") if self.form.whole else
                             tr("Pick faces of the part in the 3D view."))
        if not self.form.whole and not self._picking.faces:
            raise InputError(tr("Pick the faces to deform in the 3D view; hold Ctrl for more than one."))
        if scan is None:
            raise InputError(tr("The document holds no scan: import one first."))
        request = self.form.request(self._picking.faces)
        if self._read is None or self._read[0] != (self._picking.source, scan):
            job = make_job(self._picking.source, scan, request)
            self._read = ((self._picking.source, scan), job.source, job.scan)
        return Job(self._read[1], self._read[2], request)

    def _preview(self) -> None:
        """Preview what is set now."""
        if not self._open or self._closing.gone or self.form.busy:
            return
        try:
            job = self._job()
            if self._drawn_of != self._read[0]:  # figures and colours of another scan would deceive
                self._clear("")
                self._drawn_of = self._read[0]
            if self._wished.preview:
                self._runner.ask(job)
            else:
                self.form.found.show_figures(None, self._picking.hint)
        except FfdsError as refusal:
            self._runner.stop()
            self._draw_nothing(refusal)

    def _told(self, text: str) -> None:
        if self._open:
            self.form.show_progress(text)

    def _draw_nothing(self, failure: BaseException) -> None:
        if not isinstance(failure, FfdsError):
            raise failure
        if not self._open:
            return
        other_side = isinstance(failure, OtherSideError)
        self._clear(self._picking.hint or said(str(failure)),
                    {failure.named: WRONG, failure.shown: SHOWN} if other_side else None)
        if other_side:
            self.form.found.offer(failure.shown, lambda: self._take_other_side(failure))

    def _clear(self, sentence: str, marked: Mapping[str, int] | None = None) -> None:
        """Draw no preview but marked faces, and say why."""
        faces = dict.fromkeys(self._picking.faces, PICKED) if marked is None else marked
        if self._read is not None and self._read[0][0] is self._picking.source:
            source = self._read[1]
            self._overlay.show(marks(source.model.shape, faces), source.T_document_part)
        else:
            self._overlay.show([])
        self._overlay.cover()
        self.form.found.show_figures(None, sentence)

    def _take_other_side(self, refused: OtherSideError) -> None:
        """Deform the face that the scan shows instead of the one on the other side of its sheet."""
        self._picking.take_other_side(refused.named, refused.shown)
        self._picking.show()
        self._preview()

    def _draw(self, job: Job, patches: list[Patch]) -> None:
        if not self._open:
            return
        after = np.concatenate([patch.after for patch in patches])
        limit = good_limit(after)
        self._overlay.cover(*self._covered(job))
        self._drawing.show(job, patches, limit, self._wished.lattice)
        if job.request.faces is not None:
            self.form.show_size(patches[0].size)
        self.form.found.show_figures(figures(patches), self._picking.hint, after, limit)

    def _covered(self, job: Job) -> list[Any]:
        """What would hide the preview: the scan, the part and, when it is being changed, the as-built part."""
        return [item for item in (self.form.scan(self._document), self._picking.source, job.source.item, self._item)
                if item is not None]

    def accept(self) -> bool:
        """OK: compute in the background, then write the document in one undo step and close."""
        if not self._open or self.form.busy:
            return False
        self._read = None
        try:
            job = self._job()
        except FfdsError as refusal:
            running.tell(said(str(refusal)))
            return False
        self._runner.stop()
        self.form.set_busy(True)
        self._worker = running.Worker(job.run, lambda _: self._finish(job), self._failed, self.form.show_progress)
        return False

    def _finish(self, job: Job) -> None:
        self.form.set_busy(False)
        scan = running.name_of(self.form.scan(self._document))
        arguments = _arguments(job.request)
        source = running.name_of(self._picking.source)
        item, in_place = self._item, self.form.in_place
        self._close()
        with running.telling():
            if item is not None:
                line = f"change_as_built({running.name_of(item)}, {arguments}, scan={scan})"
            else:
                line = f"{'replace_in_place' if in_place else 'make_as_built'}({source}, {scan}, {arguments})"
            running.call(self._document, "Deform to scan", line)
            made = item or (self._picking.source if in_place else self._newest())
            Gui.Selection.addSelection(made.Document.Name, made.Name)
            if is_as_built(made):
                QtCore.QTimer.singleShot(0, lambda: open_page(made))

    def _newest(self) -> Any:
        """The as-built part that was made last."""
        return [item for item in self._document.Objects if is_as_built(item)][-1]

    def _failed(self, failure: BaseException) -> None:
        self._worker = None
        self.form.set_busy(False)
        if not isinstance(failure, FfdsError):
            raise failure
        self._draw_nothing(failure)
        running.tell(said(str(failure)))

    def _close(self) -> None:
        if self._open:
            super()._close()
            Gui.Selection.clearSelection()

    def _clean_up(self) -> None:
        self._overlay.remove()
        Gui.Selection.removeObserver(self)

    def _stop(self) -> None:
        self._runner.stop()
        if self._band is not None:
            self._band.stop()
        if self._worker is not None:
            self._worker.cancel()


def _arguments(request: RegistrationRequest) -> str:
    """A request as the arguments of a recorded line; defaults are left out."""
    plain = vars(RegistrationRequest())
    shown = [f"faces={list(request.faces) if request.faces else None}"]
    shown += [f"{name}={value!r}" for name, value in vars(request).items() if name != "faces" and value != plain[name]]
    return ", ".join(shown)
