# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole part at once, timed: its registration against a k-d tree over the scan, and ``./ffds register`` itself."""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from .. import ROOT
from ..brep import workpiece
from ..brep.joint_part import joint_part
from ..registration.arrays import Array
from ..registration.joint import register_joint
from ..scan.sensor import SensorSettings, View, simulate
from ..scan.sensor.files import write_ply
from .interleaved import median_seconds
from .pages.page import Section, Table
from .scaling import tiles
from .simulated.families import Case, make_case

Progress = Callable[[str], None]
Row = dict[str, float]

SIZES = (60_000, 360_000)
FACES = (25, 49, 100)
_SPACING = 0.35
_STARTS = 3
_LOOK = 0.005


def measure(progress: Progress, sizes: Sequence[int] = SIZES, faces: Sequence[int] = FACES,
            repeats: int = 7) -> dict[str, list[Row]]:
    """Seconds of the registration and of the command on a bracket that sprang back, and over connected faces."""
    case = make_case("bracket", "springback", 0)
    scans = {count: scan_of(case, count) for count in sizes}
    progress("The whole part, in turn with builds of a k-d tree")
    jobs: dict[str, Callable[[], Any]] = {}
    part = joint_part(workpiece.read(case.part.shape), ())
    for count, scan in scans.items():
        jobs |= {f"tree {count}": partial(cKDTree, scan), f"register {count}": partial(register_joint, part, scan)}
    seconds = median_seconds(jobs, repeats)
    rows = []
    for count, scan in scans.items():
        progress(f"./ffds register with {count:,} points")
        tree, register = seconds[f"tree {count}"], seconds[f"register {count}"]
        rows.append({"points": len(scan), "tree": tree, "register": register, "builds": register / tree,
                     **commands(case, scan)})
    return {"sizes": rows, "faces": over_faces(progress, faces)}


def scan_of(case: Case, count: int) -> Array:
    """A scan of that many points, taken as closely as it takes for them: (count, 3)."""
    spacing = _SPACING * np.sqrt(0.95 * len(case.scan.points) / count)
    views = tuple(View((x, y, z)) for x, y, z in case.part.views)
    points = simulate(case.target, SensorSettings(spacing=float(spacing), views=views)).points
    return points[:count]


def commands(case: Case, scan: Array) -> Row:
    """Seconds from the start of ``./ffds register`` to the STEP file and to its end, and its peak memory in MB."""
    with tempfile.TemporaryDirectory() as folder:
        shape, points, out = (Path(folder) / name for name in ("nominal.step", "scan.ply", "as_built.step"))
        case.part.shape.exportStep(str(shape))
        write_ply(points, scan)
        files: list[str | Path] = [shape, points, "--out", out]
        command = [sys.executable, "-P", "-m", "ffds_workbench.cli", "register", *files]
        runs = np.array([_command(command, out) for _ in range(_STARTS)])
    (written, ended), peak = runs[:, :2].min(axis=0), runs[:, 2].max()
    return {"written": float(written), "ended": float(ended), "peak_megabytes": float(peak)}


def _command(command: Sequence[str | Path], out: Path) -> tuple[float, float, float]:
    out.unlink(missing_ok=True)
    start = time.perf_counter()
    process = subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.DEVNULL)
    written = peak = 0.0
    while process.poll() is None:
        time.sleep(_LOOK)
        if not written and out.exists():
            written = time.perf_counter() - start
        peak = max(peak, _peak(process.pid))
    if process.returncode or not written:
        raise RuntimeError(f"register ended with {process.returncode}")
    return written, time.perf_counter() - start, peak


def _peak(pid: int) -> float:
    """Peak memory of a process in MB; 0 once it has ended."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text("ascii").splitlines()
    except OSError:
        return 0.0
    return next((float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")), 0.0)


def over_faces(progress: Progress, counts: Sequence[int]) -> list[Row]:
    """Seconds of the registration of shells of connected faces, all in turn."""
    progress(f"The whole part over {counts[0]} to {counts[-1]} faces")
    jobs = {}
    for count in counts:
        shape, points = tiles(round(np.sqrt(count)))
        jobs[count] = partial(register_joint, joint_part(workpiece.read(shape), ()), points)
    return [{"faces": count, "register": seconds} for count, seconds in median_seconds(jobs, 3).items()]


def exponent(rows: Sequence[Row]) -> float:
    """Slope of log time over log faces."""
    faces, seconds = np.log([(row["faces"], row["register"]) for row in rows]).T
    return float(np.polyfit(faces, seconds, 1)[0])


def section(data: dict[str, list[Row]]) -> Section:
    """The tables of the page."""
    rows = [[f"{row['points']:,}", f"{1e3 * row['tree']:.1f}", f"{1e3 * row['register']:.0f}", f"{row['builds']:.0f}",
             f"{row['written']:.2f}", f"{row['ended']:.2f}", f"{row['peak_megabytes']:.0f}"] for row in data["sizes"]]
    sizes = Table("A bracket that sprang back", ["scan points", "k-d tree, ms", "registration, ms", "builds",
                                                 "start to STEP, s", "start to end, s", "peak memory, MB"], rows)
    faces = Table("A shell of connected faces, 2,000 points each", ["faces", "registration, s"],
                  [[f"{row['faces']:.0f}", f"{row['register']:.2f}"] for row in data["faces"]])
    text = [f"A build is one `scipy.spatial.cKDTree(scan)` of the same points in the same run; medians of runs in "
            f"turn. Of `./ffds register` the shortest of {_STARTS} starts. Time grows with the number of faces to the "
            f"power of {exponent(data['faces']):.2f}."]
    return Section("The whole part", text, tables=[sizes, faces])
