# SPDX-License-Identifier: LGPL-2.1-or-later
"""The alignment of a scan with a part of the document, remembered while both stay as they are."""
from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

from ... import api
from ...brep.model_files import model_file
from ...report.stopwatch import Progress
from ..scans import scan_cloud

_last: dict[str, api.AlignedScan] = {}


def prepare(source: Any, scan: Any, mode: str) -> Callable[[Progress | None], api.AlignedScan]:
    """The alignment as a function that touches no document, for any thread (call this on the main thread).

    Raises
    ------
    InputError : the part or the scan cannot be used
    """
    model, cloud = model_file.from_object(source), scan_cloud(scan)
    key = hashlib.blake2b(model.shape.exportBrepToString().encode() + cloud.tobytes() + mode.encode()).hexdigest()

    def run(progress: Progress | None = None) -> api.AlignedScan:
        if key not in _last:
            found = api.align_scan(model, cloud, mode, progress)
            _last.clear()
            _last[key] = found
        return _last[key]

    return run


def find(source: Any, scan: Any, mode: str) -> api.AlignedScan:
    """The scan on the part, in the document's coordinates; raises as `api.align_scan` does."""
    return prepare(source, scan, mode)(None)
