# SPDX-License-Identifier: LGPL-2.1-or-later
"""``ffds register``: what it writes, and that whatever goes wrong is one line, the right exit code and no file."""
from __future__ import annotations

import contextlib
import json
import os
import pty
import resource
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.cli.main import command_line

ROOT = Path(__file__).resolve().parents[2]
FIGURES = {"mean", "rms", "p95", "max", "signed_mean"}


@pytest.mark.parametrize("words", [["register", "m.step", "s.ply", "--out", "a.step", "--side", "-1,0,0.5"],
                                   ["simulate", "m.step", "--out", "s.ply", "--view", "-1,0,0.5"]])
def test_a_direction_may_begin_with_a_minus(words):
    options = command_line().parse_args(words)
    assert (options.side if words[0] == "register" else options.view) == [(-1.0, 0.0, 0.5)]


def test_writes_model_report_and_picture(ffds, plate, tmp_path):
    import Part

    model, scan = plate
    process = ffds("register", model, scan, "--face", "Face6", "--out", "out.step", "--report", "out.json",
                   "--picture", "out.png")
    assert process.returncode == 0, process.stderr
    assert process.stderr == "" and "before" in process.stdout and "Written: out.step" in process.stdout
    shape = Part.read(str(tmp_path / "out.step"))
    assert shape.isValid() and (len(shape.Solids), len(shape.Faces), len(shape.Edges)) == (1, 6, 12)
    assert shape.distToShape(Part.Vertex(30, 20, 6))[0] < 0.05  # the top of the bump; noise of a fit of 8000 points
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    report = json.loads((tmp_path / "out.json").read_text())
    assert set(report) >= {"faces", "edges", "topology", "scan", "sheet", "timing"}
    face = report["faces"][5]
    assert set(face) == {"name", "lattice", "points", "coverage", "flag", "band", "deviation_before", "deviation_after"}
    assert face["name"] == "Face6" and face["flag"] == "observed" and set(face["deviation_before"]) == FIGURES
    # E|N(0, 0.05)| = 0.04 mm is all that may be left; a fit of 8000 points cannot be far below.
    assert 0.03 < face["deviation_after"]["mean"] < 0.044 < face["deviation_before"]["mean"]
    topology = report["topology"]
    assert topology["before"] == topology["after"]
    assert topology["order_kept"] and topology["valid"] and topology["closed"]
    written = topology["written"]
    assert written["format"] == "step" and written["numbers_kept"] and written["valid"] and written["closed"]
    assert written["faces_without_mesh"] == [] and written["open_mesh_edges"] == 0
    assert report["scan"] == {"points": 8000, "dropped": 0, "noise": pytest.approx(0.05, rel=0.1), "unit": "mm"}
    assert report["timing"]["total"] > 0


def _changed(scan: Path, target: Path, change) -> Path:
    np.savetxt(target, change(np.loadtxt(scan)), fmt="%.9f")
    return target


BAD = {
    "missing model": (["no.step", "SCAN"], 2, "does not exist"),
    "missing scan": (["MODEL", "no.ply"], 2, "does not exist"),
    "folder as model": ([".", "SCAN"], 2, "is a folder"),
    "folder as scan": (["MODEL", "."], 2, "is a folder"),
    "empty model": (["empty.step", "SCAN"], 2, "is empty"),
    "garbage model": (["garbage.step", "SCAN"], 2, "damaged or not"),
    "garbage iges": (["garbage.iges", "SCAN"], 2, "damaged"),
    "garbage brep": (["garbage.brep", "SCAN"], 2, "damaged"),
    "garbage document": (["garbage.FCStd", "SCAN"], 2, "damaged or not"),
    "unknown model format": (["garbage.dwg", "SCAN"], 2, "unknown format"),
    "cut scan": (["MODEL", "cut.ply"], 2, "is cut off"),
    "unknown face": (["MODEL", "SCAN", "--face", "Face7"], 2, "There is no Face7"),
    "not a face": (["MODEL", "SCAN", "--face", "Edge1"], 2, "There is no Edge1"),
    "frozen face": (["MODEL", "SCAN", "--face", "Face6", "--freeze", "Face6"], 2, "to be frozen"),
    "lattice too fine": (["MODEL", "SCAN", "--face", "Face6", "--method", "ffds", "--lattice", "40x40"], 3, "too fine"),
    "lattice too small": (["MODEL", "SCAN", "--lattice", "3x5"], 2, "4 or more"),
    "no lattice": (["MODEL", "SCAN", "--lattice", "fine"], 2, "is no lattice"),
    "too few source points": (["MODEL", "SCAN", "--method", "ffds", "--source-points", "9"], 2, "16 are the least"),
    "method and isometry": (["MODEL", "SCAN", "--method", "ffds", "--isometry", "on"], 2, "needs method robust"),
    "unknown method": (["MODEL", "SCAN", "--method", "magic"], 2, "magic"),
    "unknown option": (["MODEL", "SCAN", "--magic"], 2, "Unrecognized"),
    "no document": (["MODEL", "SCAN", "--object", "Body"], 2, "is none"),
    "scan in metres": (["MODEL", "metres.xyz"], 2, "in metres"),
    "unit too large": (["MODEL", "SCAN", "--scan-unit", "m"], 2, "in millimetres"),
    "scan far away": (["MODEL", "far.xyz"], 3, "do not overlap"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_no_file(ffds, plate, tmp_path, case):
    arguments, code, message = BAD[case]
    model, scan = plate
    (tmp_path / "empty.step").touch()
    for suffix in ("step", "iges", "brep", "FCStd", "dwg"):
        (tmp_path / f"garbage.{suffix}").write_text("This is a letter, not a model.\n" * 5)
    (tmp_path / "cut.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\n"
                                       b"property float z\nend_header\n1 2 3\n")
    _changed(scan, tmp_path / "metres.xyz", lambda points: points / 1000)
    _changed(scan, tmp_path / "far.xyz", lambda points: points + (10000, 0, 0))
    before = sorted(tmp_path.iterdir())
    names = {"MODEL": model, "SCAN": scan}
    arguments = [names.get(item, item) for item in arguments]
    process = ffds("register", *arguments, "--out", "out.step", "--report", "r.json")
    assert process.returncode == code, process.stderr
    assert message in process.stderr
    assert process.stderr.count("\n") == 1 and process.stdout == "" and "Traceback" not in process.stderr
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(("out", "message"), [("no/out.step", "does not exist"), ("file/out.step", "does not exist"),
                                              ("folder.step", "is a folder"), ("out.stl", "unknown format"),
                                              ("model.step", "also an input")])
def test_outputs_that_cannot_be_written_are_refused_at_once(ffds, plate, tmp_path, out, message):
    (tmp_path / "file").touch()
    (tmp_path / "folder.step").mkdir()
    content = plate[0].read_bytes()
    (tmp_path / "model.step").write_bytes(content)
    process = ffds("register", "model.step", plate[1], "--out", out)
    assert (process.returncode, process.stderr.count("\n")) == (2, 1)
    assert message in process.stderr
    assert (tmp_path / "model.step").read_bytes() == content


@pytest.mark.parametrize("suffix", ["step", "brep", "FCStd"])
def test_a_full_disk_leaves_the_earlier_file(ffds, plate, tmp_path, suffix):
    """A limit on the size of files stands in for the disk: writing beyond it fails as a full disk does."""
    out = tmp_path / f"out.{suffix}"
    out.write_text("the earlier result")
    limit = 3000
    process = ffds("register", *plate, "--face", "Face6", "--out", out,
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    assert process.returncode == 3, process.stderr
    assert process.stderr.count("\n") == 1
    assert out.read_text() == "the earlier result" and list(tmp_path.iterdir()) == [out]


def rest_of(screen: int) -> str:
    """What a terminal still shows until its last program has closed it."""
    text = b""
    with contextlib.suppress(OSError):  # EIO: nobody has it open any more
        while True:
            text += os.read(screen, 1000)
    os.close(screen)
    return text.decode()


def test_an_interruption_leaves_nothing(tmp_path):
    """The signal comes once the command says on its terminal that the model is rebuilt: the work, not the start.

    Tests in the background of a shell inherit from it that the signal is ignored.
    """
    example = ROOT / "resources" / "examples"
    command = [ROOT / "ffds", "register", example / "bracket.step", example / "bracket_scan.ply", "--out", "out.step"]
    screen, terminal = pty.openpty()
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=terminal, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    os.close(terminal)
    shown = ""
    while "Rebuilding the model" not in shown:
        shown += os.read(screen, 1000).decode()
    process.send_signal(signal.SIGINT)
    shown += rest_of(screen)
    out, _ = process.communicate()
    assert (process.returncode, out) == (130, "")
    assert shown.count("\n") == 1 and shown.rstrip().endswith("\rffds: Interrupted; nothing half-written is left.")
    assert not list(tmp_path.iterdir())
