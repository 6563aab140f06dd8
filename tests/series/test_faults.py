# SPDX-License-Identifier: LGPL-2.1-or-later
"""Workers that are killed, processes that crash, hang or grow, and a full disk: every part ends exactly once."""
from __future__ import annotations

import errno
import os
import signal
from functools import partial
from pathlib import Path

import pytest

from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.request import RegistrationRequest
from ffds_workbench.series import folder, part_process, worker
from ffds_workbench.series.engine import Queue, connected
from ffds_workbench.series.setup import Outcome, PartJob, SeriesLimits, SeriesSetup

_CHILD = """
import json, os, signal, sys
sys.path[:] = json.loads(sys.argv[1])
from multiprocessing.connection import Connection
from ffds_workbench.series import folder
from ffds_workbench.series.setup import Outcome
connection = Connection(int(sys.argv[2]))
setup = connection.recv()
while True:
    job = connection.recv()
    if job.name == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if job.name == "hang":
        signal.pause()
    if job.name == "grow":
        kept = b"1" * (1 << 30)
        signal.pause()
    connection.send(folder.deliver(setup.folder, Outcome(job.scan, job.name, 0)))
"""


def _do(marker: Path, job: PartJob) -> Outcome:
    """A part that kills its worker the first time, and fails of the disk the second time."""
    tries = len(list(marker.iterdir()))
    (marker / str(tries)).touch()
    if tries == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return Outcome(job.scan, job.name, 0, final=tries > 1)


def test_a_killed_worker_and_a_full_disk_end_no_part(tmp_path):
    pytest.importorskip("distributed", reason="series need Dask")
    found: list[Outcome] = []
    with connected(1, None) as client:
        queue = Queue(client, partial(_do, tmp_path), found.append)
        for name in ("one", "two", "three"):
            queue.add(PartJob(Path(name), name))
        while queue.left:
            queue.work(1.0)
    assert sorted(outcome.name for outcome in found) == ["one", "three", "two"]
    assert all(outcome.final and outcome.exit == 0 for outcome in found)


@pytest.fixture
def setup(tmp_path, monkeypatch) -> SeriesSetup:
    """A series whose parts are done by a process that does what their names say."""
    monkeypatch.setattr(part_process, "_CHILD", _CHILD)
    yield SeriesSetup(Path("m.step"), None, "mm", RegistrationRequest(), tmp_path,
                      SeriesLimits(seconds=60.0, memory=float(1 << 29)))
    worker._forget()


@pytest.mark.parametrize(("name", "said"), [("crash", "died twice (signal 11, signal 11)"),
                                            ("grow", "more than 512 MB of memory"), ("hang", "more than 1 s")])
def test_what_takes_the_process_along_is_refused_and_the_next_part_done(setup, name, said):
    if name == "hang":
        setup = SeriesSetup(setup.model, None, "mm", setup.request, setup.folder, SeriesLimits(seconds=1.0))
    found = worker.do_part(setup, PartJob(Path("a.ply"), name))
    assert found.exit == 3 and found.final and said in found.said
    assert folder.outcome(setup.folder, name) == found
    assert worker.do_part(setup, PartJob(Path("b.ply"), "sound")).exit == 0
    assert worker.do_part(setup, PartJob(Path("a.ply"), name)) == found  # done, and not done again


def test_a_part_appears_whole_or_not_at_all(tmp_path):
    def half(path: Path) -> None:
        (path / "as_built.step").write_text("half")
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(RefusedError, match="No space left"):
        folder.deliver(tmp_path, Outcome(Path("a.ply"), "a", 0), half)
    assert not list(folder.work_folder(tmp_path).iterdir()) and folder.outcome(tmp_path, "a") is None
    first = folder.deliver(tmp_path, Outcome(Path("a.ply"), "a", 0, seconds=1.0))
    assert folder.deliver(tmp_path, Outcome(Path("a.ply"), "a", 3, "late")) == first
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "mine").touch()
    with pytest.raises(RefusedError, match="in the way"):
        folder.deliver(tmp_path, Outcome(Path("b.ply"), "b", 0))
    assert not list(folder.work_folder(tmp_path).iterdir())
