# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the world benchmark asks, line by line, and its tables."""
from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..accuracy_study.accuracy_lines import AccuracyLine
from ..pages.page import Section, Table
from .judge import FLAGS

Row = Mapping[str, Any]

_WRITTEN, _GOOD = 0.97, 0.90
_VISIBLE, _EDGES = 0.015, 0.05
"""Means in mm on a share `_GOOD` of all files, at six views and σ = 0.08 mm."""
_HELD = {"observed": 0.93, "bridged": 0.90, "carried": 0.90}
_NAMED = re.compile(r"\b(Face|Edge|Vertex|Solid)\d+")


def outcome(row: Row) -> str:
    """One word for what came of a case: written, refused (exit 3), input (exit 2), crash, timeout, silent (an exit
    without a line), no case (it could not be made), not judged."""
    if row["step"] == "make":
        return "no case"
    if row["step"] == "judge":
        return "written" if row["exit"] == 0 else "not judged"
    if row["exit"] is None:
        return "timeout"
    if row["exit"] in (2, 3):
        return ("input" if row["exit"] == 2 else "refused") if row["sentence"] else "silent"
    return "crash"


def lines(rows: Sequence[Row]) -> list[AccuracyLine]:
    """What holds and what does not, of all lines for which there are cases."""
    tried = [row for row in rows if row["outcome"] != "no case"]
    written = [row for row in tried if row["outcome"] == "written"]
    refused = [row for row in tried if row["outcome"] == "refused"]
    shares: list[tuple[str, Sequence[Row], Callable[[Row], bool], float]] = [
        ("Cases written", tried, lambda row: row["outcome"] == "written", _WRITTEN),
        ("Refusals that name a sub-shape", refused, lambda row: bool(_NAMED.search(row["sentence"])), 1),
        ("Written that keep every number as read back", written, lambda row: not row["lost"], 1),
        ("Written that are valid and closed as before", written, lambda row: not _unsound(row), 1),
        ("Written whose faces mesh and whose mesh closes as before", written, lambda row: not _unmeshed(row), 1),
        (f"Written with a visible mean of at most {_VISIBLE} mm", written,
         lambda row: mean(row, "visible") <= _VISIBLE, _GOOD),
        (f"Written with a mean of edges of at most {_EDGES} mm", written, lambda row: mean(row, "edges") <= _EDGES,
         _GOOD)]
    found = [_at_least(what, sum(map(holds, chosen)) / len(chosen), asked) for what, chosen, holds, asked in shares
             if chosen]
    bad = sum(row["outcome"] in ("crash", "timeout", "silent", "not judged", "no case") for row in rows)
    found.append(AccuracyLine("Crashes, kills, steps without an end, exits without a line", float(bad), "at most 0",
                              bad == 0))
    for key, where in (("bands", "faces"), ("edge_bands", "edges")):
        for flag in FLAGS:
            places, held = (sum(row[key][flag][what] for row in written if key in row) for what in ("places", "held"))
            if places:
                found.append(_at_least(f"95 % bands of {where}, {flag}", held / places, _HELD[flag]))
    return found


def mean(row: Row, what: str) -> float:
    """A mean in mm; zero where there is nothing to be off, endless where it could not be judged."""
    if what not in row:
        return float("inf")
    return float(row[what]["mean"]) if row[what] else 0.0


def sections(rows: Sequence[Row]) -> list[Section]:
    """The page."""
    asked = lines(rows)
    verdict = Table("Lines", ["", "found", "asked", ""], [
        [line.what, f"{line.found:.4g}", line.asked, "met" if line.met else "NOT MET"] for line in asked])
    head = ["file", "deformation", "faces", "outcome", "s", "MB", "visible mean", "p95", "max", "nominal's", "hidden",
            "nominal's", "edges mean", "p95", "max", "nominal's", "as lines", "gap", "tolerance", "read back"]
    cases = Table("Cases, mm", head, [_cells(row) for row in rows])
    others = [[row["file"], row["deformation"], row["step"], str(row["exit"]), row["sentence"]] for row in rows
              if row["outcome"] != "written"]
    text = ["Each file as it is and deformed, with a scan of six views and σ = 0.08 mm unless told otherwise; seconds "
            "of reading, registering and writing by one thread, with the machine as busy as it was. Distances are "
            "those of true points from the faces of the file as it reads back, evaluated by OCCT; nominal's: of the "
            "same points from the nominal model. A seam, where a face meets itself, is no line on the part: it is "
            "judged across the surface; as lines: with seams as lines, too."]
    exactly = [[row["file"], row["deformation"], row["step_refused"]] for row in rows
               if row["outcome"] == "written" and "step_refused" in row]
    if exactly:
        text.append(f"Where its STEP file is refused, a model is written as BREP: {len(exactly)} of {len(rows)} cases.")
    tables = [Table("Not written", ["file", "deformation", "step", "exit", "what it said"], others),
              Table("Written as BREP", ["file", "deformation", "why not as STEP"], exactly)]
    return [Section("Results", text, tables=[verdict, cases, *(table for table in tables if table.rows)])]


def _cells(row: Row) -> list[str]:
    head = [row["file"], row["deformation"], str(row.get("faces_count", "–")), row["outcome"],
            *(f"{row[key]:.0f}" if key in row else "–" for key in ("seconds", "megabytes"))]
    if row["outcome"] != "written":
        return [*head, *["–"] * 14]
    before = row["nominal"]
    blocks = [_block(row.get(what), keys) + _block(before[what], ("mean",)) for what, keys in
              (("visible", ("mean", "p95", "max")), ("hidden", ("mean",)), ("edges", ("mean", "p95", "max")))]
    return [*head, *(cell for block in blocks for cell in block), *_block(row.get("edge_lines"), ("mean",)),
            f"{max(0.0, row['gap'][1] - row['gap'][0]):.1e}",
            f"{row['tolerance'][1]:.1e}", "; ".join([*row["lost"], *_unsound(row), *_unmeshed(row)]) or "kept"]


def _block(figures: Mapping[str, float] | None, keys: Sequence[str]) -> list[str]:
    return [f"{figures[key]:.4f}" if figures else "–" for key in keys]


def _unsound(row: Row) -> list[str]:
    """What is no longer sound."""
    return ["not valid"] * (row["nominal_valid"] and not row["valid"]) + ["opened"] * bool(row["opened"])


def _unmeshed(row: Row) -> list[str]:
    """Faces that no longer mesh, and the mesh if it no longer closes."""
    before, after = row["mesh"]
    faces = [f"Face{face} does not mesh" for face in after["unmeshed"] if face not in before["unmeshed"]]
    return faces + [f"{after['open']} open sides of the mesh"] * (before["open"] == 0 < after["open"])


def _at_least(what: str, found: float, asked: float) -> AccuracyLine:
    return AccuracyLine(what, found, f"at least {asked:g}", found >= asked)
