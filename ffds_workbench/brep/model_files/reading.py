# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foreign model files are read in a separate process, which they may crash: `reader` runs there.

It may take as much time and memory as a sound file of that size could need. `begin` starts it early, so that it runs in
parallel with other work; this module loads nothing for that. `content` waits for it.
"""
from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import weakref
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import ROOT, find_freecad
from ...errors import InputError, RefusedError

if TYPE_CHECKING:
    import Part

FORMATS = (".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".fcstd")
_CHILD = """
import json, os, sys
sys.path[:] = json.loads(sys.argv[1])
from ffds_workbench.brep.model_files import reading
reading.run(*sys.argv[2:])
"""
_SECONDS, _SECONDS_PER_MB = 5.0, 20.0
"""Processor time that reading may take, and more for each MB (unit: a slow machine takes 1 s to load FreeCAD and 5 s
for a MB of STEP)."""
_BYTES, _BYTES_PER_BYTE = 1 << 30, 200
"""Memory that reading may take beyond what an idle process has, and more for each byte of the file (unit: Open CASCADE
takes some 50 bytes for each of STEP)."""
_DOCUMENT_GAIN = 20
"""Bytes of a FreeCAD document's text for each byte of its compressed file that limits allow for (unit: BREP has 5)."""
_PATIENCE = 3.0
"""Times its processor time that reading is waited for where the system does not tell how much of it is used (unit)."""
_STILL = 10.0
"""Seconds for which reading may get no processor time, as on a slow disk, before it counts as stuck (unit)."""
_LOOK = 0.5
"""Seconds between two looks at the process (unit)."""

_OUT_OF_TIME = -getattr(signal, "SIGXCPU", 0) or None
"""What a process that has used its processor time returns."""


@dataclass(frozen=True)
class Reading:
    """The reading of one file under way; it ends with this object."""

    process: subprocess.Popen[bytes]
    folder: tempfile.TemporaryDirectory[str]
    seconds: float
    deadline: float

    def __post_init__(self) -> None:
        weakref.finalize(self, _end, self.process, self.folder)


_BEGUN: dict[tuple[Path, str | None], Reading] = {}


def begin(path: Path, label: str | None = None) -> None:
    """Begin to read a file that `content` will be asked for; nothing happens where there is none to read."""
    with suppress(OSError):  # `content` reports it
        if path.suffix.lower() in FORMATS and path.is_file() and path.stat().st_size:
            _BEGUN[path, label] = _begun(path, label)


def content(path: Path, label: str | None) -> tuple[Part.Shape, dict[str, Any]]:
    """The shape that a file holds, null if none, and what `reader.write` says about it.

    Raises
    ------
    InputError : the file is damaged, there is no such object, or reading it takes more than a sound file could
    RefusedError : no process could be started
    """
    try:
        under_way = _BEGUN.pop((path, label), None) or _begun(path, label)
    except OSError as error:
        raise RefusedError(f"The model {path} cannot be read: no process could be started for it "
                           f"({error.strerror or error}).") from error
    try:
        return _finished(path, under_way)
    finally:
        _end(under_way.process, under_way.folder)


def _finished(path: Path, under_way: Reading) -> tuple[Part.Shape, dict[str, Any]]:
    """Wait for the result of a reading."""
    folder = Path(under_way.folder.name)
    late = not _waited_for(under_way)
    if late or not (folder / "about.json").exists():
        raise InputError(f"The model {path} cannot be read: {_why(late, under_way.seconds)}.")
    about = json.loads((folder / "about.json").read_text("utf-8"))
    if "error" in about:
        raise InputError(about["error"])
    import Part

    shape = Part.Shape()
    if (folder / "shape.bin").exists():
        shape.importBinary(str(folder / "shape.bin"))
    return shape, about


def _waited_for(under_way: Reading) -> bool:
    """Whether a reading came to an end by itself; on a busy machine it goes on slowly, and is not stuck."""
    used, since = 0.0, time.monotonic()
    while True:
        try:
            return under_way.process.wait(_LOOK) != _OUT_OF_TIME
        except subprocess.TimeoutExpired:
            now = _processor_time(under_way.process.pid)
        if now is None:
            stuck = time.monotonic() > under_way.deadline
        elif now > used:
            used, since, stuck = now, time.monotonic(), False
        else:
            stuck = time.monotonic() - since > _STILL
        if stuck:
            return False


def _processor_time(process: int) -> float | None:
    """What a process has used so far, in the system's clock ticks; None where the system does not tell."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return float(fields[11]) + float(fields[12])  # utime and stime, counted from the state behind the name


def _why(late: bool, seconds: float) -> str:
    if late:
        return f"it takes more than {seconds:.0f} s, which no sound file of its size does; it is damaged"
    return "it is damaged, FreeCAD's reader gives up on it"


def _begun(path: Path, label: str | None) -> Reading:
    """Start the process that reads a file."""
    size = path.stat().st_size * (_DOCUMENT_GAIN if path.suffix.lower() == ".fcstd" else 1)
    seconds, memory = _SECONDS + _SECONDS_PER_MB * size / 1e6, _BYTES + _BYTES_PER_BYTE * size
    folder = tempfile.TemporaryDirectory(prefix="ffds-")
    command = [find_freecad.interpreter(), "-c", _CHILD, json.dumps([str(ROOT), *sys.path]), str(path.absolute()),
               str(path), json.dumps(label), folder.name, str(seconds), str(memory)]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               cwd=folder.name, env={**os.environ, "TMPDIR": folder.name})
    return Reading(process, folder, seconds, time.monotonic() + _PATIENCE * seconds)


def _end(process: subprocess.Popen[bytes], folder: tempfile.TemporaryDirectory[str]) -> None:
    process.kill()
    process.wait()
    folder.cleanup()


def run(path: str, name: str, label: str, folder: str, seconds: str, memory: str) -> None:
    """Read a file in this process, which serves nothing else; messages call it ``name``."""
    find_freecad.activate()
    _limit(float(seconds), int(memory))
    from . import reader

    try:
        reader.write(reader.read(Path(path), json.loads(label)), Path(folder))
    except InputError as error:
        about = {"error": str(error).replace(path, name)}
        (Path(folder) / "about.json").write_text(json.dumps(about), "utf-8")
    os._exit(0)  # FreeCAD takes its time to end


def _limit(seconds: float, memory: int) -> None:
    """Bound processor time, memory and what is written, where the system knows how to."""
    try:
        import resource
    except ImportError:
        return
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize() if os.path.exists(
        "/proc/self/statm") else 0
    for kind, limit in ((resource.RLIMIT_CPU, math.ceil(seconds)), (resource.RLIMIT_AS, used + memory),
                        (resource.RLIMIT_FSIZE, memory), (resource.RLIMIT_CORE, 0)):
        hard = resource.getrlimit(kind)[1]
        resource.setrlimit(kind, (limit if hard == resource.RLIM_INFINITY else min(limit, hard), hard))
