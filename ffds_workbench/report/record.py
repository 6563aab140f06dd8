# SPDX-License-Identifier: LGPL-2.1-or-later
"""The JSON report: plain dictionaries of what a job found, lengths in mm."""
from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..registration.face import FaceRegistration
from ..registration.joint import EdgeRegistration, JointFace, JointRegistration, SensorProfile
from ..scan.cloud import PointCloud
from .deviation import FaceDeviation
from .statistics import statistics
from .versions import versions

Record = dict[str, Any]

_DIGITS = 5


def scan_record(scan: PointCloud, noise: float | None, sensor: SensorProfile | None = None) -> Record:
    """The report's ``scan`` block; ``sensor`` is the profile that the bands rest on, where it is not white noise."""
    record: Record = {"points": len(scan.points), "dropped": scan.dropped, "noise": noise, "unit": scan.unit}
    return record if sensor is None else record | {"sensor": asdict(sensor)}


def figures(deviations: np.ndarray) -> Record | None:
    """A block of deviation figures, or None without points."""
    found = statistics(deviations)
    return None if found is None else found.as_dict()


def all_figures(faces: Sequence[FaceDeviation]) -> Record | None:
    """The figures of all faces together."""
    return figures(np.concatenate([np.empty(0), *(face.deviations for face in faces)]))


def face_records(names: Sequence[str], moved: Collection[str], registrations: Iterable[FaceRegistration | JointFace],
                 before: Sequence[FaceDeviation], after: Sequence[FaceDeviation]) -> list[Record]:
    """The report's ``faces`` of a registration, in the model's order.

    The flag says where the face's shape comes from: ``observed`` by the scan, ``bridged`` in a gap of it, ``carried``
    along with its neighbours, or ``nominal``. The band, in mm, is that of the solve over all faces.
    """
    registered = {item.name: item for item in registrations}
    deviation = {item.name: (item, other) for item, other in zip(before, after, strict=True)}
    records = []
    for name in names:
        entry = registered.get(name)
        first, second = deviation.get(name, (None, None))
        joint = entry if isinstance(entry, JointFace) and name in moved else None
        flag = joint.flag if joint else "nominal" if name not in moved else "observed" if entry else "carried"
        records.append({
            "name": name, "lattice": list(entry.lattice) if entry else None, "points": entry.points if entry else 0,
            "coverage": entry.coverage if entry else 0.0, "flag": flag,
            "band": joint.band if joint and np.isfinite(joint.band) else None,
            "deviation_before": figures(first.deviations) if first else None,
            "deviation_after": figures(second.deviations) if second else None})
    return records


def edge_records(edge_faces: Sequence[Sequence[str]], moved: Sequence[str], observed: Sequence[str]) -> list[Record]:
    """The report's ``edges``: ``observed`` if all faces of the edge are, ``carried`` if one of them moves."""
    records = []
    for number, faces in enumerate(edge_faces, 1):
        if faces and set(faces) <= set(observed):
            flag = "observed"
        else:
            flag = "carried" if set(faces) & (set(moved) | set(observed)) else "nominal"
        records.append({"name": f"Edge{number}", "flag": flag, "band": None})
    return records


def joint_edge_records(edges: Iterable[EdgeRegistration]) -> list[Record]:
    """The report's ``edges`` of a solve over all faces: what each rests on and its band in mm, all in all and at equal
    steps along it. Edges of no face stay where they were."""
    return [{"name": edge.name, "flag": edge.flag if len(edge.points) else "nominal",
             "band": edge.band if len(edge.points) else None,
             "along": {"bands": edge.bands.round(_DIGITS).tolist(), "flags": edge.flags.tolist()}} for edge in edges]


def sheet_record(joint: JointRegistration | None) -> Record:
    """The report's ``sheet``: as-built thickness in mm, one per solid where there are several, strain, and how far the
    part may be off in mm because the scan may show the other skin; motions of solids within their own surface, faces
    that are carried because they did not settle, and edges that stay because they bound no face."""
    if joint is None:
        return {"thickness": None, "strain": None, "unsure": 0.0, "free_motions": [], "torn": [], "loose": []}
    thickness = joint.thickness[0] if len(joint.thickness) == 1 else list(joint.thickness)
    return {"thickness": thickness, "strain": joint.strain, "unsure": joint.unsure,
            "free_motions": list(joint.free_motions), "torn": list(joint.torn),
            "loose": [edge.name for edge in joint.edges if not len(edge.points)]}


def write(record: Mapping[str, Any], path: Path) -> None:
    """Write a report as JSON text, with the versions that it was made with; see resources/docs/report.schema.json."""
    text = json.dumps({**record, "versions": versions()}, indent=1, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", "utf-8")


def read(path: Path) -> Any:
    """What the file of a registration's report holds (InputError where it cannot be read or is not JSON)."""
    try:
        return json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"The report {path} cannot be read: {error.strerror or error}.") from error
    except ValueError as error:
        raise InputError(f"The report {path} is not JSON: name the file that register wrote with --report.") from error
