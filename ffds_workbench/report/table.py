# SPDX-License-Identifier: LGPL-2.1-or-later
"""The short tables that the command line prints: the deviation and the topology before and after."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def deviation_table(report: Mapping[str, Any]) -> str:
    """One line per observed face and one for all, of a registration's or a deviation's report."""
    compared = "deviation_before" in report
    columns = ("deviation_before", "deviation_after") if compared else ("deviation",)
    rows = [face for face in report["faces"] if face[columns[0]] is not None]
    heads = ["before: mean", "p95", "after: mean", "p95"] if compared else ["mean", "rms", "p95", "max", "signed"]
    lines = [_row("|deviation|, mm", "points", heads)]
    for row in [*rows, {"name": "all", "points": sum(face["points"] for face in rows), **report}]:
        lines.append(_row(row["name"], str(row["points"]), _figures(row, columns)))
    return "\n".join(lines)


def _figures(row: Mapping[str, Any], columns: Sequence[str]) -> list[str]:
    names = ("mean", "p95") if len(columns) > 1 else ("mean", "rms", "p95", "max", "signed_mean")
    blocks = (row.get(column) for column in columns)
    return [f"{block[name]:.4f}" if block else "–" for block in blocks for name in names]


def _row(name: str, points: str, figures: Sequence[str]) -> str:
    return f"{name:<16}{points:>9}" + "".join(f"{figure:>14}" for figure in figures)


def doubts(report: Mapping[str, Any]) -> str:
    """What a registration could not decide, a sentence each; empty if there is nothing."""
    sheet = report["sheet"]
    free = [f"{motion} without any scan showing it, so it stays where it was." for motion in sheet["free_motions"]]
    torn = [f"{name} fits its scan points in more than one place: it is carried by its neighbours, not registered."
            for name in sheet["torn"]]
    loose = [f"{name} bounds no face: it stays where it was." for name in sheet["loose"]]
    return "\n".join([*free, *torn, *loose, *([_skin_doubt(sheet["unsure"])] if sheet["unsure"] else [])])


def _skin_doubt(unsure: float) -> str:
    return (f"Which skin of the sheet the scan shows is a guess: everything may be off by its thickness, {unsure:.2f} "
            f"mm, and the bands allow for that. Scan some of its border as well, or use a scan with normals.")


def topology_table(topology: Mapping[str, Any]) -> str:
    """Counts before and after, and what the certificate says."""
    before, after = topology["before"], topology["after"]
    lines = [f"{'topology':<16}" + "".join(f"{kind:>10}" for kind in before),
             f"{'before':<16}" + "".join(f"{count:>10}" for count in before.values()),
             f"{'after':<16}" + "".join(f"{after[kind]:>10}" for kind in before)]
    gap, tolerance, check = topology["max_edge_gap"], topology["max_tolerance"], topology["boolean_check"]
    lines.append(f"order {'kept' if topology['order_kept'] else 'CHANGED'}, "
                 f"{'valid' if topology['valid'] else 'NOT VALID'}, {'closed' if topology['closed'] else 'open'}; "
                 f"largest edge gap {gap['before']:.1e} → {gap['after']:.1e} mm, "
                 f"tolerance {tolerance['before']:.1e} → {tolerance['after']:.1e} mm; "
                 f"Boolean check: {_errors(check['before'])} → {_errors(check['after'])}")
    return "\n".join(lines)


def _errors(count: int | None) -> str:
    if count is None:
        return "not finished in time"
    return "no errors" if count == 0 else f"{count} errors"
