# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preparation of scans in a document: cropped, cleaned, thinned, several of them fused."""
from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ... import api
from ...brep.model_files import model_file
from ...errors import InputError
from ...report.stopwatch import Progress
from ..scans import scan_cloud, set_points
from ..sources import standing_for
from ..waiting import wait_for

_last: dict[str, api.PreparedScan] = {}


def prepare_scan(scans: Sequence[Any], part: Any = None, **settings: Any) -> Any:
    """Prepare a scan, the first of ``scans``, in place; the others, if any, go into it and are hidden.

    Parameters
    ----------
    scans : Points objects; several are fused where they lie
    part : what ``near`` is a distance from; the scans must lie on it
    settings : ``fuse=True`` matches several scans with each other first; the others are of `PreparationSettings`

    Raises
    ------
    InputError : the scans, the part or the settings cannot be used, or open3d is not installed
    RefusedError : nothing of the scan would be left, or the scans do not overlap
    """
    prepared = wait_for(scans[0].Label if scans else "", prepare(scans, part, **settings)).scan
    set_points(scans[0], prepared.points, prepared.normals)
    for other in scans[1:]:
        other.Visibility = False
    return scans[0]


def prepare(scans: Sequence[Any], part: Any = None, fuse: bool = False,
            **settings: Any) -> Callable[[Progress | None], api.PreparedScan]:
    """The preparation as a function that touches no document, for any thread (call this on the main thread).

    It gives the scan in the document's coordinates. Raises as `prepare_scan` does.
    """
    if not scans:
        raise InputError("There is no scan to prepare: select one.")
    nested = next((scan for scan in scans if scan.getParentGeoFeatureGroup() is not None), None)
    if nested is not None:
        raise InputError(f"{nested.Label} lies in a part: drag it out into the document before preparing it.")
    clouds = [scan_cloud(scan) for scan in scans]
    model = None if part is None else model_file.from_object(standing_for(part))
    if fuse:
        settings["poses"] = tuple(np.eye(4) for _ in clouds)
    contents = [repr((fuse, sorted(settings.items()))).encode(), *(cloud.tobytes() for cloud in clouds),
                b"" if model is None else model.shape.exportBrepToString().encode()]
    key = "".join(hashlib.blake2b(content).hexdigest() for content in contents)

    def run(progress: Progress | None = None) -> api.PreparedScan:
        if key not in _last:
            found = api.prepare(clouds, model, progress or (lambda text: None), **settings)
            _last.clear()
            _last[key] = found
        return _last[key]

    return run
