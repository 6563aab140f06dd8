# SPDX-License-Identifier: LGPL-2.1-or-later
"""One registration of a part of the document: its inputs, and its result while the inputs stay the same.

A panel computes in the background what the document object then asks for: the last results are remembered by a digest
of everything that goes into them.
"""
from __future__ import annotations

import hashlib
from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ... import api
from ...registration.request import RegistrationRequest
from ...report.stopwatch import Progress
from ..scans import scan_cloud
from ..sources import Source, read_source

_KEPT = 3
_results: OrderedDict[str, api.Result] = OrderedDict()


@dataclass(frozen=True)
class Job:
    """A registration in the part's own frame, so that it does not depend on where the part stands."""

    source: Source
    scan: api.PointCloud
    request: RegistrationRequest

    @cached_property
    def digest(self) -> str:
        """Differs where any input differs."""
        found = hashlib.blake2b(self.source.model.shape.exportBrepToString().encode())
        found.update(self.scan.tobytes())
        found.update(repr(self.request).encode())
        return found.hexdigest()

    def run(self, progress: Progress | None = None) -> api.Result:
        """Register, or recall what the same inputs gave. Touches no document: any thread may run it.

        Raises
        ------
        InputError, RefusedError : as `api.run` does
        """
        if self.digest not in _results:
            result = api.run(self.request, self.source.model, self.scan, progress)
            _ = result.first_report  # measured here, and not where the main thread asks for it
            _results[self.digest] = result
            while len(_results) > _KEPT:
                _results.popitem(last=False)
        return _results[self.digest]


def make_job(item: Any, scan: Any, request: RegistrationRequest) -> Job:
    """The registration of a document object to a Points object (main thread only).

    Raises
    ------
    InputError : the part or the scan cannot be used
    """
    return job_on(item, scan_cloud(scan), request)


def job_on(item: Any, scan: api.PointCloud, request: RegistrationRequest) -> Job:
    """The registration of a document object to a scan in the document's coordinates; see `make_job`."""
    source = read_source(item)
    return Job(source, source.to_part(scan), request)
