# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark summary``: the documentation's page on performance, from what the other benchmarks measured.

It measures nothing. It reads ``accuracy.json``, ``paper.json``, ``peers.json`` and ``scaling.json`` of the same output
folder, says which of them are missing, and writes ``performance.md``. Between the marks in the page the section is
replaced.
"""
from __future__ import annotations

import json
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .. import RESOURCES
from ..errors import InputError
from . import peers
from .accuracy_study.accuracy_cases import NOISE
from .pages.page import Table
from .paper_study.paper_methods import TITLES

Progress = Callable[[str], None]

START, END = "<!-- performance: ./ffds benchmark summary -->", "<!-- /performance -->"
_SOURCES = ("accuracy", "paper", "peers", "scaling")
_KINDS = {"clean": "all views", "one-view": "one view", "one-view with normals": "one view, with normals",
          "dirty": "holes, outliers, a table, a third of the noise shared by neighbours"}
_PLACES = ("visible", "hidden", "edges")
_SHEETS = {"A": "clean", "D": "dirty"}
_METHODS = {"ffds": "ffds", "robust": "robust", "kdtree": "building a k-d tree", "read": "reading the array"}


def run(folder: Path, progress: Progress, page: Path = RESOURCES / "docs" / "performance.md") -> str:
    """Write ``performance.md`` and, where the page has the marks, the section between them; returns the section.

    Raises
    ------
    InputError : the folder holds no benchmark's figures
    """
    progress("Summary")
    data = {name: json.loads((folder / f"{name}.json").read_text()) for name in _SOURCES
            if (folder / f"{name}.json").exists()}
    if not data:
        raise InputError(f"{folder} holds no figures: run ./ffds benchmark accuracy, paper, peers or scaling with "
                         f"--out {folder} first.")
    text = section(data)
    (folder / "performance.md").write_text(text + "\n")
    if page.exists():
        whole = page.read_text("utf-8")
        if START in whole and END in whole:
            head, rest = whole.split(START, 1)
            page.write_text(head + START + "\n" + text + "\n" + END + rest.split(END, 1)[1], "utf-8")
    return text


def section(data: dict[str, Any]) -> str:
    """The section as Markdown."""
    parts = ["Generated from these runs; all clouds are simulated, and the figures are of one machine in one run: "
             "compare ratios, not milliseconds."]
    if "accuracy" in data:
        parts += ["`./ffds benchmark accuracy --out DIR` deforms whole parts in known ways, scans them with a noise of "
                  f"{NOISE:g} mm, and measures what it wrote.",
                  _parts(data["accuracy"]).markdown(), _bands(data["accuracy"])]
    if "paper" in data:
        parts += ["`./ffds benchmark paper --out DIR` repeats the published comparison.",
                  _paper(data["paper"]).markdown()]
    if "peers" in data:
        parts += ["`./ffds benchmark peers --out DIR` runs what one would take instead.",
                  _peers(data["peers"]).markdown(), _comparison(data["peers"])]
        parts += [f"Not run: {name} ({why})." for name, why in data["peers"]["skipped"].items()]
    if "scaling" in data:
        parts += ["`./ffds benchmark scaling --out DIR` grows the scan, the lattice and the number of faces.",
                  _scaling(data["scaling"]).markdown(), _faces(data["scaling"])]
    missing = [name for name in _SOURCES if name not in data]
    if missing:
        parts.append("Not measured for this summary: " + ", ".join(missing) + ".")
    return "\n\n".join(filter(None, parts))


def _parts(data: dict[str, Any]) -> Table:
    rows = []
    for kind, title in _KINDS.items():
        cases = [case for case in data["cases"] if case["kind"] == kind]
        done = [case for case in cases if "refused" not in case]
        if done:
            refused = len(cases) - len(done)
            means = [[case[place]["mean"] for case in done] for place in _PLACES]
            rows.append([title, f"{len(done)}, {refused} refused" if refused else f"{len(done)}",
                         *(f"{statistics.median(values):.4f} ({max(values):.3f})" for values in means)])
    return Table("Whole parts, mean distance from the truth in mm: the median part and the worst",
                 ("the scan shows", "parts", *_PLACES), rows)


def _bands(data: dict[str, Any]) -> str:
    """How often the bands hold the truth."""
    texts = []
    for kind, noise in (("white", "where each point has its own noise"),
                        ("dirty", "where neighbours share some of it")):
        shares = [f"{name.split('/')[1]} {100 * item['share']:.0f} %" for name, item in data["bands"].items()
                  if name.startswith(kind)]
        texts.append(f"{noise}: {', '.join(shares)}")
    return f"The 95 % bands hold the truth, {'; '.join(texts)}."


def _paper(data: dict[str, Any]) -> Table:
    ratios = data["ratios"]
    rows = [["solve, dense FFD-HSU ÷ FFDS",
             f"{ratios['ffd_hsu_to_ffds']:.0f} ×",
             f"{ratios['published']:.0f} × (dense against dense)"],
            ["solve, dense FFD-HSU ÷ dense FFDS",
             f"{ratios['ffd_hsu_to_ffds_dense']:.0f} ×", f"{ratios['published']:.0f} ×"],
            ["neighbours and solve, 104,705 points ÷ one k-d tree build",
             f"{ratios['whole_step_to_kdtree_build']:.2f}", ""]]
    for figure, what in (("figure_6b", "exact cloud"), ("figure_9b", "noise 0.13 mm, gaps")):
        row = next(row for row in data[figure] if row["control_points_per_direction"] == 10)
        for method, title in TITLES.items():
            rows.append([f"true mean distance, {what}, {title}", f"{row[method]['true_mean']:.4f} mm", ""])
    return Table("400 source points, N = 10", ("", "here", "published"), rows)


def _peers(data: dict[str, Any]) -> Table:
    head = ("method", "clean: mean, mm", "s", "dirty: mean, mm", "s", "largest scan in 60 s", "CAD, topology kept")
    rows = [[row["title"], *_figures(row["A"]), *_figures(row["D"]), peers.size_text(row),
             "yes" if row["cad_topology_kept"] else "no"] for row in data["rows"]]
    return Table("True mean distance on a sheet, 42,087 points, clean and dirty", head, rows)


def _comparison(data: dict[str, Any]) -> str:
    """The ratios that matter, and who is better than the robust method at what."""
    rows, figures = data["rows"], data["comparison"]
    robust = next(row for row in rows if row["name"] == "robust")
    better = []
    for case, sheet in _SHEETS.items():
        for key, what in (("true_mean", "more accurate"), ("seconds", "faster")):
            names = [row["title"] for row in rows if row[case].get(key, robust[case][key]) < robust[case][key]]
            better.append(f"{what} on the {sheet} sheet: {', '.join(names) or 'none'}")
    return (f"True mean on the dirty sheet: FFDS as published ÷ robust {figures['published_to_robust_on_D']:.0f}, best "
            f"general peer ÷ robust {figures['best_peer_to_robust_on_D']:.0f}; on the clean sheet robust ÷ best "
            f"general peer {figures['robust_to_best_peer_on_A']:.2f}. Than the robust method, {'; '.join(better)}.")


def _figures(case: dict[str, Any]) -> list[str]:
    return ["failed", ""] if "failed" in case else [f"{case['true_mean']:.4f}", f"{case['seconds']:.3g}"]


def _scaling(data: dict[str, Any]) -> Table:
    last = data["points"][-1]
    rows = []
    for name, title in _METHODS.items():
        further = data["ns_per_further_point"][name]
        rows.append([title, f"{1e3 * last[name]:.0f}", f"{further['from_1m_to_5m']:.1f}", f"{further['ratio']:.2f}",
                     f"{last[f'{name}_mb']:.0f}" if f"{name}_mb" in last else ""])
    head = ("", "ms", "ns per further point", "÷ those up to 1M", "MB")
    return Table(f"{last['points']:,} points on one face", head, rows)


def _faces(data: dict[str, Any]) -> str:
    if not data.get("faces"):
        return ""
    few, many = data["faces"][len(data["faces"]) // 2], data["faces"][-1]
    return (f"A whole part with {few['faces']} connected faces, 2,000 scan points each, takes {few['total']:.0f} s, "
            f"with {many['faces']} faces {many['total']:.0f} s, certificate included.")
