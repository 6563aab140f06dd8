# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a series tells, written beside its parts: series.json, mean_field.csv, tables and a page."""
from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..output import replacing
from ..registration.arrays import Array
from ..report import record as reports
from . import folder as layout
from .inspected import characteristics, charts, sentences
from .setup import Outcome
from .told import (Modes, SeriesPlaces, find_change, find_modes, find_outliers, find_scatter, group_difference,
                   owner_scatter)

_MOST_PARTS = 2000
"""Parts whose fields are held at once; of more, so many are taken at equal steps, which the record says."""
Labelled = Sequence[tuple[Outcome, Mapping[str, str]]]


def write_summary(folder: Path, parts: Labelled, places: SeriesPlaces) -> dict[str, Any]:
    """Write what a series tells; what ``series.json`` holds.

    Parameters
    ----------
    folder : of the series
    parts : what became of each part, and its labels
    places : at which their fields are known

    Raises
    ------
    RefusedError : the disk is full
    """
    entries = [_entry(folder, part, labels) for part, labels in parts]
    done = [(part, labels) for part, labels in parts if not part.exit]
    step = max(1, -(-len(done) // _MOST_PARTS))
    used = done[::step]
    fields = [_field(folder / part.name / layout.FIELD) for part, _ in used]
    record: dict[str, Any] = {"parts": entries, "mean": None, "modes": [], "told": []}
    mean_lines: list[list[Any]] = []
    if fields:
        moved, sigma = (np.stack(arrays).astype(float) for arrays in zip(*fields, strict=True))
        record |= _told(moved, sigma, places, [part.name for part, _ in used], [labels for _, labels in used])
        record["characteristics"] = characteristics(folder, [part.name for part, _ in used])
        record["told"] += sentences(record["characteristics"])
        scatter = find_scatter(moved, sigma, places)
        mean_lines = np.column_stack([places.position, scatter.mean, scatter.sigma]).tolist()
    from .page import series_page

    targets = [folder / name for name in (layout.SERIES, layout.MEAN, "parts.csv", layout.PAGE)]
    with replacing(*targets) as temporary:
        reports.write(record, temporary[0])
        _table(temporary[1], ["x", "y", "z", "dx", "dy", "dz", "sigma"], mean_lines)
        _table(temporary[2], ["scan", "name", "exit", "said", "seconds"],
               [[entry[name] for name in ("scan", "name", "exit", "said", "seconds")] for entry in entries])
        temporary[3].write_text(series_page(folder.name, record), "utf-8")
    return record


def _entry(folder: Path, part: Outcome, labels: Mapping[str, str]) -> dict[str, Any]:
    report = str(folder / part.name / layout.REPORT) if part.exit == 0 else None
    return {"scan": str(part.scan), "name": part.name, "exit": part.exit, "said": part.said, "report": report,
            "seconds": round(part.seconds, 3), "labels": dict(labels)}


def _field(path: Path) -> tuple[Array, Array]:
    with np.load(path) as arrays:
        return arrays["displacement"], arrays["sigma"]


def _told(moved: Array, sigma: Array, places: SeriesPlaces, names: Sequence[str],
          labels: Sequence[Mapping[str, str]]) -> dict[str, Any]:
    """The record's blocks beside the parts."""
    scatter, modes = find_scatter(moved, sigma, places), find_modes(moved, sigma, places)
    faces, means = face_means(moved, places)
    outliers = find_outliers(_scores(modes), means, faces)
    runs = {f"mode {number}": mode.scores for number, mode in enumerate(modes.modes, 1)}
    changes = {name: asdict(change) | {"part": names[change.at]} for name, figures in runs.items()
               if (change := find_change(figures)) is not None}
    groups = {label: {name: asdict(difference) for name, figures in runs.items() if (difference := group_difference(
        figures, [own.get(label, "") for own in labels])) is not None}
        for label in dict.fromkeys(key for own in labels for key in own)}
    record = {
        "mean": {"field": layout.MEAN, "parts": len(moved),
                 "owners": [asdict(owner) for owner in owner_scatter(scatter, places)]},
        "modes": [{"size": mode.size, "interval": mode.interval, "share": mode.share, "certain": mode.certain,
                   "scores": dict(zip(names, mode.scores.round(4).tolist(), strict=True))} for mode in modes.modes],
        "measurement": modes.measurement**0.5,
        "changes": changes, "groups": {label: found for label, found in groups.items() if found},
        "charts": {name: charts(figures) for name, figures in runs.items()},
        "outliers": [asdict(outlier) | {"part": names[outlier.part]} for outlier in outliers]}
    return record | {"told": _sentences(record)}


def face_means(moved: Array, places: SeriesPlaces) -> tuple[Any, Array]:
    """Names (m,) of the faces, and the mean displacement (parts, m) of each along its normal in mm."""
    along = np.einsum("pnx,nx->pn", moved, places.normal)
    names = list(dict.fromkeys(places.owner[places.weight > 0].tolist()))
    means = [along[:, places.owner == name].mean(axis=1) for name in names]
    return np.array(names), np.stack(means, axis=1) if means else np.zeros((len(moved), 0))


def _scores(modes: Modes) -> Array:
    """What tells a part from the others: along the modes, and the logarithm of what they leave."""
    rest = np.log(np.maximum(modes.rest, 1e-3 * max(float(modes.rest.max(initial=0.0)), 1e-300)))
    return np.column_stack([*(mode.scores for mode in modes.modes), rest])


def _sentences(record: Mapping[str, Any]) -> list[str]:
    """The series in words."""
    lines = []
    for number, mode in enumerate(record["modes"], 1):
        sure = "" if mode["certain"] else "; it may be the measurement's"
        lines.append(f"Mode {number}: {mode['size']:.3f} mm ({mode['interval'][0]:.3f} to {mode['interval'][1]:.3f}), "
                     f"{mode['share']:.0%} of what varies{sure}.")
    for name, change in record["changes"].items():
        verb = "steps" if change["kind"] == "step" else "begins to drift"
        lines.append(f"{name.capitalize()} {verb} at {change['part']}, by {change['size']:.2g} standard deviations.")
    for label, found in record["groups"].items():
        lines += [f"{name.capitalize()} differs with {label}." for name, group in found.items() if group["differ"]]
    lines += [f"{outlier['part']} is unlike the others: {outlier['where']} is {outlier['off']:+.3f} mm off them."
              for outlier in record["outliers"]]
    return lines


def _table(path: Path, heads: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(heads)
        writer.writerows([f"{value:.9g}" if isinstance(value, float) else value for value in row] for row in rows)
