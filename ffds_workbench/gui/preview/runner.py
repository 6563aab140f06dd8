# SPDX-License-Identifier: LGPL-2.1-or-later
"""When the preview is computed: immediately and coarsely while a control moves, exactly once it rests; in the
background if that takes time."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...objects.jobs.registration_job import Job
from .. import running
from ..qt import QtCore
from ..translating import tr
from .patches import Patch, Preview

_REST_MS = 350
"""The preview becomes exact when nothing was touched for so long."""
_PATIENCE_MS = 700
"""What takes longer than this is said."""


class PreviewRunner(QtCore.QObject):
    """Computes the preview of the newest job.

    Parameters
    ----------
    drawn : called with a job and its patches
    failed : called with what went wrong
    told : called with what is being done, "" for nothing
    """

    def __init__(self, drawn: Callable[[Job, list[Patch]], None], failed: Callable[[BaseException], None],
                 told: Callable[[str], None]) -> None:
        super().__init__()
        self._drawn, self._failed, self._told = drawn, failed, told
        self._of: tuple[Any, Any] | None = None
        self._preview: Preview | None = None
        self._coarse: running.Worker | None = None
        self._exact: running.Worker | None = None
        self._next: Job | None = None
        self._job: Job | None = None
        self._rest = QtCore.QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._refine)
        self._patience = QtCore.QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(lambda: self._told(tr("Refining the preview")))

    def preview_of(self, job: Job) -> Preview:
        """The preview of a job's part and scan, kept as long as they stay the same."""
        if self._preview is None or self._of is None or self._of[0] is not job.source or self._of[1] is not job.scan:
            self._of, self._preview = (job.source, job.scan), Preview(job.source.model.shape, job.scan)
        return self._preview

    def ask(self, job: Job) -> None:
        """Preview this job. Faces by themselves are drawn before this returns (FfdsError where they cannot be)."""
        self._drop_exact()
        self._job = job
        preview = self.preview_of(job)
        if job.request.faces is not None:
            self._next = None
            self._drawn(job, preview.patches(job.request, True, _silent))
            self._rest.start(_REST_MS)
        elif self._coarse is not None:
            self._next = job
        else:
            self._begin(job)

    def stop(self) -> None:
        """Drop all work."""
        self._drop_exact()
        self._next = None
        if self._coarse is not None:
            self._coarse.cancel()
            self._coarse = None
        self._told("")

    def _begin(self, job: Job) -> None:
        preview = self.preview_of(job)
        self._told(tr("Computing the preview"))
        self._coarse = running.Worker(lambda progress: preview.patches(job.request, True, progress),
                                      lambda patches: self._came(job, patches), self._missed, _silent)

    def _came(self, job: Job, patches: list[Patch]) -> None:
        self._coarse = None
        if self._next is None:
            self._told("")
            self._rest.start(_REST_MS)
        self._drawn(job, patches)
        self._go_on()

    def _missed(self, failure: BaseException) -> None:
        self._coarse = None
        self._told("")
        if self._next is None:
            self._failed(failure)
        self._go_on()

    def _go_on(self) -> None:
        if self._next is not None:
            job, self._next = self._next, None
            self._begin(job)

    def _refine(self) -> None:
        job = self._job
        if job is None:
            return
        preview = self.preview_of(job)
        self._patience.start(0 if job.request.faces is None else _PATIENCE_MS)
        self._exact = running.Worker(lambda progress: preview.patches(job.request, False, progress),
                                     lambda patches: self._refined(job, patches), self._not_refined, _silent)

    def _refined(self, job: Job, patches: list[Patch]) -> None:
        self._end_exact()
        self._drawn(job, patches)

    def _not_refined(self, failure: BaseException) -> None:
        self._end_exact()
        self._failed(failure)

    def _end_exact(self) -> None:
        self._exact = None
        self._patience.stop()
        self._told("")

    def _drop_exact(self) -> None:
        self._rest.stop()
        if self._exact is not None:
            self._exact.cancel()
            self._end_exact()


def _silent(text: str) -> None:
    """The preview does not say what it is doing in detail."""
