# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of the deformation: what is picked and set on one side, the live preview on the other."""
from __future__ import annotations

from typing import Any

import FreeCADGui as Gui
import numpy as np

from ..errors import FfdsError, InputError
from ..objects.as_built import settings_of
from ..objects.job import Job, Settings, make_job
from ..objects.sources import Source
from . import running
from .colours import good_limit, packed_colours
from .deformation_form import DeformationForm
from .overlay import Overlay, lattice_nodes, mesh_node
from .preview import Patch, Preview, figures
from .qt import QtCore, QtWidgets
from .selection import Chosen, chosen, scans_of

_REST_MS = 350
"""The preview becomes exact when nothing was touched for so long."""


def open_panel(document: Any, item: Any = None, whole: bool = False) -> None:
    """Open the panel on the selection, on the whole part, or on the as-built part ``item`` to change it."""
    if Gui.Control.activeDialog():
        running.tell("Another task is open: finish or close it first.")
        return
    with running.telling():
        Gui.Control.showDialog(DeformationPanel(document, item, whole))


class DeformationPanel:
    """FreeCAD's task panel. Nothing is written into the document before OK."""

    def __init__(self, document: Any, item: Any, whole: bool) -> None:
        self._document, self._item = document, item
        self._source: Any = None
        self._faces: tuple[str, ...] = ()
        self._hint = ""
        self._preview: Preview | None = None
        self._read: tuple[tuple[Any, Any], Source, Any] | None = None
        self._worker: running.Worker | None = None
        self.form = DeformationForm(scans_of(document), item is not None)
        self._take(item, chosen(), whole)
        self._overlay = Overlay(document.Name)
        self._rest = QtCore.QTimer(self.form)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._show_exact)
        self.form.changed.connect(self._show_coarse)
        Gui.Selection.addObserver(self)
        self._watching = True
        QtCore.QTimer.singleShot(0, self._show_coarse)

    def _take(self, item: Any, selected: Chosen, whole: bool) -> None:
        """Start from an as-built part, or from what is selected."""
        if item is not None:
            self._source = item.Source
            settings = settings_of(item)
            self._faces = settings.faces or ()
            self.form.take(settings, item.Scan)
        else:
            self._pick(selected)
        if whole:
            self._faces = ()
        self.form.set_whole(whole or item is not None and not self._faces)
        self._show_picked()

    def _pick(self, selected: Chosen) -> None:
        """Take over the part, the faces and the scan of a selection; what cannot be used is said."""
        sentence = ""
        if selected.scans:
            self.form.set_scan(selected.scans[-1])
        parts = [self._item.Source if part is self._item else part for part in selected.parts]
        if len(set(parts)) > 1:
            sentence = "Faces of two parts are selected: choose those of one."
        elif parts:
            if self._item is None:
                self._source = parts[0]
            if parts[0] is self._source:
                self._faces = tuple(dict.fromkeys(selected.faces[selected.parts[0].Name])) or self._faces
        if selected.others and not sentence:
            sentence = f"{selected.others[0]} is neither a face nor a point cloud: pick faces of a part, and a scan."
        self._hint = sentence

    def _show_picked(self) -> None:
        self.form.show_picked(self._source.Label if self._source is not None else "", self._faces)

    def addSelection(self, *_: Any) -> None:  # noqa: N802
        """Something was picked in the view or in the tree: read the selection once FreeCAD is done with it."""
        QtCore.QTimer.singleShot(0, self._selection_changed)

    def _selection_changed(self) -> None:
        if not self._watching or self.form.busy:
            return
        self._pick(chosen())
        self._show_picked()
        self._show_coarse()

    def _job(self) -> Job:
        """The registration that is set now (InputError where something is missing)."""
        scan = self.form.scan(self._document)
        if self._source is None:
            raise InputError("Pick faces of the part in the 3D view." if not self.form.whole else
                             "Pick the part in the 3D view.")
        if not self.form.whole and not self._faces:
            raise InputError("Pick the faces to deform in the 3D view; hold Ctrl for more than one.")
        if scan is None:
            raise InputError("The document holds no scan: import one first.")
        settings = self.form.settings(self._faces)
        if self._read is None or self._read[0] != (self._source, scan):
            job = make_job(self._source, scan, settings)
            self._read = ((self._source, scan), job.source, job.points)
            self._preview = Preview(job.source.model.shape, job.points)
        return Job(self._read[1], self._read[2], settings)

    def _show_coarse(self) -> None:
        """The preview of what is set now, on a part of the points; exact when it rests."""
        if not self._watching or self.form.busy:
            return
        self._cancel_work()
        try:
            job = self._job()
            self._draw(job, self._preview.patches(job.settings, coarse=True))
            self._rest.start(_REST_MS)
        except FfdsError as refusal:
            self._draw_nothing(refusal)

    def _show_exact(self) -> None:
        """The preview on all points, computed in the background."""
        if self._watching and not self.form.busy:
            job, preview = self._job(), self._preview
            self._worker = running.Worker(lambda progress: preview.patches(job.settings, coarse=False),
                                          lambda patches: self._draw(job, patches), self._draw_nothing, _silent)

    def _draw_nothing(self, failure: BaseException) -> None:
        if not isinstance(failure, FfdsError):
            raise failure
        self._overlay.show([])
        self._overlay.cover()
        self.form.show_figures(None, self._hint or str(failure))

    def _draw(self, job: Job, patches: list[Patch]) -> None:
        self._overlay.cover(*[self.form.scan(self._document)] if patches else [])
        if not patches:
            self._overlay.show([])
            self.form.show_figures(None, "OK registers all faces together: that takes some seconds.")
            return
        limit = good_limit(np.concatenate([patch.before for patch in patches]))
        nodes = [mesh_node(patch.points, patch.triangles, packed_colours(patch.values, limit)) for patch in patches]
        self.form.show_size(patches[0].size)
        self._overlay.show([*nodes, *lattice_nodes([patch.lattice for patch in patches])], job.source.T_document_part)
        self.form.show_figures(figures(patches), self._hint, np.concatenate([patch.after for patch in patches]), limit)

    def accept(self) -> bool:
        """OK: compute in the background, then write the document in one undo step and close."""
        if self.form.busy:
            return False
        self._read = None
        try:
            job = self._job()
        except FfdsError as refusal:
            running.tell(str(refusal))
            return False
        self._rest.stop()
        self._cancel_work()
        self.form.set_busy(True)
        self._worker = running.Worker(job.run, lambda _: self._finish(job), self._failed, self.form.show_progress)
        return False

    def _finish(self, job: Job) -> None:
        self.form.set_busy(False)
        scan = running.name_of(self.form.scan(self._document))
        arguments = _arguments(job.settings)
        source = running.name_of(self._source)
        item, in_place = self._item, self.form.in_place
        self._close()
        with running.telling():
            if item is not None:
                line = f"change_as_built({running.name_of(item)}, {arguments}, scan={scan})"
            else:
                line = f"{'replace_in_place' if in_place else 'make_as_built'}({source}, {scan}, {arguments})"
            running.call(self._document, "Deform to scan", line)

    def _failed(self, failure: BaseException) -> None:
        self._worker = None
        self.form.set_busy(False)
        if isinstance(failure, FfdsError):
            running.tell(str(failure))
        else:
            raise failure

    def _cancel_work(self) -> None:
        if self._worker is not None:
            self._worker.cancel()
            self._worker = None

    def reject(self) -> bool:
        """Cancel: drop running work and leave the document as it is."""
        self._close()
        return True

    def _close(self) -> None:
        if not self._watching:
            return
        self._watching = False
        try:
            Gui.Selection.removeObserver(self)
            self._rest.stop()
            self._cancel_work()
        finally:
            self._overlay.remove()
            Gui.Selection.clearSelection()
        QtCore.QTimer.singleShot(0, Gui.Control.closeDialog)

    def getStandardButtons(self) -> int:  # noqa: N802
        """OK and Cancel."""
        return int(QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel)


def _arguments(settings: Settings) -> str:
    """The settings as the arguments of a recorded line; defaults are left out."""
    plain = Settings()
    shown = [f"faces={list(settings.faces) if settings.faces else None}"]
    shown += [f"{name}={getattr(settings, name)!r}"
              for name in ("freeze", "method", "lattice", "source_points", "isometry")
              if getattr(settings, name) != getattr(plain, name)]
    return ", ".join(shown)


def _silent(text: str) -> None:
    """The preview does not say what it is doing."""
