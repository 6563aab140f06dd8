# SPDX-License-Identifier: LGPL-2.1-or-later
"""One part of a series: read, registered and delivered by a process that keeps the model and what is prepared of it."""
from __future__ import annotations

import errno
import time
from pathlib import Path

import numpy as np

from .. import api
from ..api.methods import check_names
from ..brep import workpiece
from ..errors import FfdsError, InputError, RefusedError
from ..inspection import write_inspection
from . import folder
from .places import displacement, places_of, write_field
from .setup import REFUSED, Outcome, PartJob, SeriesSetup

_MACHINE = {errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.ENOMEM, errno.EMFILE, errno.ENFILE, errno.ESTALE}
"""What no scan is to blame for."""


class PreparedSeries:
    """The model of a series, read once, and the places at which its parts are compared.

    Raises
    ------
    InputError : the model or the plan cannot be read, or the model has not the faces that the request names
    """

    def __init__(self, setup: SeriesSetup) -> None:
        self.setup = setup
        self.model = api.read_model(setup.model, setup.label)
        self.part = workpiece.read(self.model.shape)
        check_names(self.part, setup.request)
        self.places = places_of(self.part)
        self.plan = None if setup.plan is None else api.read_plan(setup.plan)
        self._step = api.step_keeps_numbers(self.model)

    @property
    def as_built(self) -> str:
        """Name of the file of an as-built model."""
        return folder.AS_BUILT if self._step else str(Path(folder.AS_BUILT).with_suffix(".brep"))

    def do(self, job: PartJob) -> Outcome:
        """Register a part and deliver its folder; every end but one that the machine is to blame for is final."""
        start = time.monotonic()
        standing = folder.outcome(self.setup.folder, job.name)
        if standing is not None:
            return standing
        try:
            result = self._registered(job)
            return folder.deliver(self.setup.folder, self._outcome(job, start),
                                  lambda path: self._write(result, path, job.name))
        except FfdsError as error:
            if _of_the_machine(error):
                return self._outcome(job, start, error, final=False)
            return folder.deliver(self.setup.folder, self._outcome(job, start, error))
        except MemoryError:
            full = RefusedError("There is not enough memory for this part.")
            return folder.deliver(self.setup.folder, self._outcome(job, start, full))

    def _registered(self, job: PartJob) -> api.Result:
        scan = api.read_scan(job.scan, self.setup.scan_unit)
        return api.run(self.setup.request, self.model, scan)

    def _write(self, result: api.Result, path: Path, title: str) -> None:
        api.write(result, path / self.as_built, path / folder.REPORT)
        write_field(path / folder.FIELD, *displacement(result, self.places))
        if self.plan is not None:
            write_inspection(api.inspect_result(result, self.plan).inspection, path, f"Inspection of {title}",
                             [self.as_built, folder.REPORT])

    def _outcome(self, job: PartJob, start: float, error: FfdsError | None = None, final: bool = True) -> Outcome:
        said = "" if error is None else " ".join(str(error).split())
        code = 0 if error is None else InputError.exit_code if isinstance(error, InputError) else REFUSED
        return Outcome(job.scan, job.name, code, said, time.monotonic() - start, final)


def _of_the_machine(error: BaseException | None) -> bool:
    """Whether an error comes from the disk or the system and not from the scan."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in _MACHINE:
            return True
        error = error.__cause__
    return False


def write_places(prepared: PreparedSeries) -> None:
    """Keep where the places of a series are."""
    places = prepared.places.places
    np.savez(prepared.setup.folder / folder.PLACES, position=places.position, normal=places.normal,
             weight=places.weight, owner=places.owner)
