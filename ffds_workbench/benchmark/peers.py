# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark peers``: the same clouds through what a user would take instead.

Each method runs in a process of its own; packages that are not at hand are installed into an environment of their own
below the output folder, and a peer that cannot be had is named as skipped.
"""
from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import ROOT
from ..registration.arrays import Array
from .pages import page, style
from .pages.page import Picture, Section, Table
from .paper_study.paper_case import true_distance
from .peer_study import peers_environment
from .peer_study.peers_environment import Environment
from .simulated.sheet import SIZE, scan

Progress = Callable[[str], None]
Row = dict[str, Any]

CASES = ("A", "D", "E")
SEEDS = (1, 2, 3)
LIMIT_SECONDS = 60.0
SIZES = (1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000)
_SLOW = 8.0
_START_UP = 30.0
_PATIENCE = 20
"""Limits are of processor time; a process is given up after so many times as long."""
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
_LABEL_LEFT = ("robust", "ffds_small")
_LABEL_BELOW = ("ffds_small", "ffd_hsu", "pycpd_outliers", "probreg")
_WORKER = Path(__file__).parent / "peer_study" / "peer_worker.py"


@dataclass(frozen=True)
class Peer:
    """A competitor.

    Attributes
    ----------
    name : what the worker calls it
    title : what the table calls it
    package, module : what has to be installed and imported; empty where it is at hand
    most : points that it is given at most for the accuracy, because its memory or time grows too fast
    cad : whether a CAD model with its topology kept comes out
    """

    name: str
    title: str
    package: str = ""
    module: str = ""
    most: int | None = None
    cad: bool = False


PEERS = (
    Peer("robust", "FFDS robust (this project)", cad=True),
    Peer("ffds", "FFDS as published, S = 400, N = 10", cad=True),
    Peer("ffds_small", "FFDS as published, S = 36, N = 5", cad=True),
    Peer("ffd_hsu", "FFD-HSU, S = 400, N = 10 (a plain lattice in space)", cad=True),
    Peer("rigid_icp", "rigid ICP (open3d)"),
    Peer("spline_fit", "LSQBivariateSpline (scipy)"),
    Peer("thin_plate", "thin-plate RBF, 100 neighbours (scipy)"),
    Peer("pycpd", "pycpd (α 2, β 0.5, w 0.1)", "pycpd", "pycpd", 5_000),
    Peer("pycpd_outliers", "pycpd, outliers expected (α 0.5, β 0.7, w 0.7)", "pycpd", "pycpd", 5_000),
    Peer("probreg", "probreg CPD", "probreg", "probreg.cpd", 10_000),
    Peer("trimesh_nricp", "trimesh nricp", "trimesh", "trimesh.registration"),
)
OWN = ("robust", "ffds", "ffds_small", "ffd_hsu")
NOT_RUN = {"PyGeM": "it is not on the package index and fits nothing to a scan by itself; its lattice is FFD-HSU's"}


def run(folder: Path, progress: Progress) -> str:
    """Measure, and write ``peers.json``, ``peers.md``, ``peers.html`` and a picture; returns the tables."""
    rows: list[Row] = []
    skipped = dict(NOT_RUN)
    for peer in PEERS:
        row = measure(peer, folder, progress)
        if isinstance(row, str):
            skipped[peer.title] = row
        else:
            rows.append(row)
    return write(folder, rows, skipped)


def measure(peer: Peer, folder: Path, progress: Progress) -> Row | str:
    """All figures of one peer, or why there are none."""
    progress(f"Peers: making ready {peer.title}")
    environment = (peers_environment.make(folder / "environments" / peer.package, peer.package, peer.module)
                   if peer.package else peers_environment.here())
    if environment.python is None:
        return environment.missing
    row: Row = {"name": peer.name, "title": peer.title, "cad_topology_kept": peer.cad, "points_at_most": peer.most}
    for case in CASES:
        progress(f"Peers: {peer.title}, sheet {case}")
        row[case] = accuracy(peer, environment, case)
    progress(f"Peers: {peer.title}, largest size")
    row["largest_in_60_s"] = largest_size(peer, environment)
    return row


def write(folder: Path, rows: list[Row], skipped: dict[str, str]) -> str:
    """Write the tables and the picture of what was measured; returns the tables."""
    data = {"rows": rows, "skipped": skipped, "comparison": comparison(rows)}
    return page.write(folder, "peers", "Peers", _sections(folder, data), data)


def accuracy(peer: Peer, environment: Environment, case: str) -> Row:
    """Mean over the seeds of the true mean and p95, the largest maximum, seconds and MB; one seed for slow peers."""
    results = []
    for seed in SEEDS:
        points = np.random.default_rng(seed).permutation(scan(case, seed))[: peer.most]
        done = work(peer.name, environment, points, 5 * LIMIT_SECONDS)
        if isinstance(done, str):
            return {"failed": done}
        results.append((true_distance(done["moved"]), float(done["seconds"]), float(done["megabytes"])))
        if results[-1][1] > _SLOW:
            break
    distances, seconds, megabytes = zip(*results, strict=True)
    return {"true_mean": float(np.mean([d.mean() for d in distances])),
            "true_p95": float(np.mean([np.percentile(d, 95) for d in distances])),
            "true_max": float(max(d.max() for d in distances)), "seconds": float(np.median(seconds)),
            "megabytes": float(max(megabytes)), "seeds": len(results)}


def largest_size(peer: Peer, environment: Environment) -> int:
    """Largest of the sizes that the method does on sheet A within 60 s and 10 GB; 0 where it does none."""
    done_size, before = 0, 0.0
    for size in SIZES:
        done = work(peer.name, environment, scan("A", 1, size), LIMIT_SECONDS)
        if isinstance(done, str) or done["seconds"] > LIMIT_SECONDS:
            break
        done_size, seconds = size, float(done["seconds"])
        if before and seconds > 1 and seconds**2 / before > LIMIT_SECONDS:     # the next would take too long
            break
        before = seconds
    return done_size


def work(method: str, environment: Environment, points: Array, limit: float) -> Any:
    """Run the worker: what it wrote, or a word on why there is nothing."""
    with tempfile.TemporaryDirectory() as folder:
        given, result = Path(folder) / "in.npz", Path(folder) / "out.npz"
        np.savez(given, scan=points, size=np.array(SIZE))
        variables = {**os.environ, "PYTHONPATH": str(ROOT), **dict.fromkeys(_THREADS, "1")}
        try:
            command = [str(environment.python), str(_WORKER), method, str(given), str(result),
                       str(round(limit + _START_UP))]
            done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=_PATIENCE * limit,
                                  env=variables)
        except subprocess.TimeoutExpired:
            return "too slow"
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "too slow"
        if done.returncode or not result.exists():
            last = (done.stderr.strip().splitlines() or ["it stopped"])[-1]
            return last.split(":")[0][:60]
        return dict(np.load(result))


def comparison(rows: Sequence[Row]) -> dict[str, float]:
    """How the robust method compares: with the published one on D, with the best other peer on D and on A."""
    by_name = {row["name"]: row for row in rows}
    robust = by_name["robust"]
    others = [row for row in rows if row["name"] not in OWN]
    best = {case: min(row[case]["true_mean"] for row in others if "true_mean" in row[case]) for case in CASES}
    return {"published_to_robust_on_D": by_name["ffds"]["D"]["true_mean"] / robust["D"]["true_mean"],
            "best_peer_to_robust_on_D": best["D"] / robust["D"]["true_mean"],
            "robust_to_best_peer_on_A": robust["A"]["true_mean"] / best["A"]}


def _sections(folder: Path, data: dict[str, Any]) -> list[Section]:
    cases = {"A": "sheet A: clean, white noise 0.13 mm",
             "D": "sheet D: a fifth hidden, outliers, a wall, a second sheet",
             "E": "sheet E: as D, noise correlated over 1.5 mm"}
    tables = []
    for case, text in cases.items():
        best = {key: min(row[case][key] for row in data["rows"] if key in row[case])
                for key in ("true_mean", "seconds")}
        rows = []
        for row in data["rows"]:
            figures = row[case]
            if "failed" in figures:
                rows.append([row["title"], figures["failed"], "", "", "", "", ""])
                continue
            rows.append([row["title"], _marked(figures["true_mean"], best["true_mean"]), f"{figures['true_p95']:.4f}",
                         f"{figures['true_max']:.3f}", _marked(figures["seconds"], best["seconds"]),
                         f"{figures['megabytes']:.0f}",
                         f"{row['points_at_most']:,}" if row["points_at_most"] else "all"])
        tables.append(Table(f"True distance in mm, {text} (* the best)",
                            ("method", "mean", "p95", "max", "s", "MB", "points used"), rows))
    abilities = Table("What else counts", ("method", "largest size within 60 s", "CAD model, topology kept"),
                      [[row["title"], size_text(row), "yes" if row["cad_topology_kept"] else "no"]
                       for row in data["rows"]])
    figures = data["comparison"]
    summary = Table("The robust method in comparison", ("", "ratio"), [
        ["true mean on D, FFDS as published ÷ robust", f"{figures['published_to_robust_on_D']:.0f} ×"],
        ["true mean on D, best general peer ÷ robust", f"{figures['best_peer_to_robust_on_D']:.1f} ×"],
        ["true mean on A, robust ÷ best general peer", f"{figures['robust_to_best_peer_on_A']:.2f}"]])
    skipped = [f"Not run: {name} ({reason})." for name, reason in data["skipped"].items()]
    text = ("A plane sheet of 75 × 70 mm, its deformed surface known as a formula; 42,087 points before gaps and "
            "clutter. Seconds and MB are of the method alone, on one thread, beyond its imports and the cloud. Peers "
            "get the cloud as it comes; those that cannot take all of it get a random part.")
    picture = Picture(_plot(folder, data["rows"]),
                      "Accuracy against time on the clean and on the dirty sheet; lower left is better.")
    return [Section("The same clouds through every method", (text, *skipped), (picture,), (summary, *tables)),
            Section("Size and result", tables=(abilities,))]


def size_text(row: Row) -> str:
    """The largest size of a row; "≥" where larger ones were not tried."""
    size = row["largest_in_60_s"]
    return f"{'≥ ' if size == SIZES[-1] else ''}{size:,}"


def _marked(value: float, best: float) -> str:
    return f"{value:.4g}" + (" *" if value == best else "")


def _plot(folder: Path, rows: Sequence[Row]) -> str:
    drawing = style.figure(10.5, 4.6)
    for axes, case in zip(drawing.subplots(1, 2, sharey=True), ("A", "D"), strict=True):
        for row in rows:
            figures = row[case]
            if "failed" in figures:
                continue
            colour = style.COLOURS.get(row["name"].removesuffix("_small"), style.SOFT)
            axes.loglog(figures["seconds"], figures["true_mean"], "o", color=colour)
            left, below = row["name"] in _LABEL_LEFT, row["name"] in _LABEL_BELOW
            axes.annotate(row["name"], (figures["seconds"], figures["true_mean"]), textcoords="offset points",
                          xytext=(-5 if left else 5, -11 if below else 5), ha="right" if left else "left", fontsize=8)
        axes.set(xlabel="seconds", title=f"sheet {case}")
        axes.margins(x=0.3)
    drawing.axes[0].set_ylabel("true mean distance in mm")
    return style.save(drawing, folder, "peers")
