# SPDX-License-Identifier: LGPL-2.1-or-later
"""The server: nothing that came half is a file, nothing outside its folder is read, and jobs outlive it."""
from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="serving needs FastAPI")
pytest.importorskip("httpx", reason="FastAPI's test client needs httpx")

from fastapi.testclient import TestClient  # noqa: E402

from ffds_workbench.errors import InputError  # noqa: E402
from ffds_workbench.series import folder as layout  # noqa: E402
from ffds_workbench.series.setup import Outcome, SeriesLimits  # noqa: E402
from ffds_workbench.serve.app import make_app  # noqa: E402
from ffds_workbench.serve.jobs import Jobs, read_options  # noqa: E402
from ffds_workbench.serve.runner import Runner  # noqa: E402
from ffds_workbench.serve.uploads import Uploads  # noqa: E402

TOKEN = {"Authorization": "Bearer 0123456789abcdef"}


class Patient(Runner):
    """Takes jobs and does none."""

    def start(self):
        pass

    def stop(self):
        pass


@pytest.fixture
def jobs(tmp_path) -> Jobs:
    return Jobs(tmp_path, SeriesLimits())


@pytest.fixture
def client(tmp_path, jobs):
    app = make_app(Uploads(tmp_path / "files", 1000), jobs, Patient(jobs, 1, None), TOKEN["Authorization"][7:])
    return TestClient(app, raise_server_exceptions=False)


def sent(client, name="part.step", content=b"ISO"):
    answer = client.post("/files", params={"name": name}, content=content, headers=TOKEN)
    assert answer.status_code == 201, answer.text
    return answer.json()["file"]


def test_a_job_from_its_files_to_its_results(client, jobs):
    model, scan = sent(client), sent(client, "scan.ply", b"ply")
    asked = client.post("/jobs", json={"model": model, "scan": scan, "options": {"align": "fine"}}, headers=TOKEN)
    assert asked.status_code == 202 and asked.json()["state"] == "open"
    name = asked.json()["job"]
    assert [job.name for job in jobs.open_ones()] == [name]
    layout.deliver(jobs.results, Outcome(Path("s.ply"), name, 0), lambda path: (path / "as_built.step").write_text("x"))
    found = client.get(f"/jobs/{name}", headers=TOKEN).json()
    assert found["state"] == "registered" and found["files"] == ["as_built.step", "part.json"]
    assert client.get(f"/jobs/{name}/files/as_built.step", headers=TOKEN).text == "x"
    assert client.get("/jobs", headers=TOKEN).json() == [found] and jobs.open_ones() == []


def test_jobs_outlive_the_server(client, jobs, tmp_path):
    model, scan = sent(client), sent(client, "scan.ply", b"ply")
    name = client.post("/jobs", json={"model": model, "scan": scan}, headers=TOKEN).json()["job"]
    (tmp_path / "jobs" / ".half.tmp").write_text("{")
    again = Jobs(tmp_path, SeriesLimits())
    assert [job.name for job in again.open_ones()] == [name]
    assert again.open_ones()[0].scan.read_bytes() == b"ply"


@pytest.mark.parametrize("path", ["/jobs", "/jobs/x", "/jobs/x/files/y", "/files?name=a.ply"])
def test_who_knows_no_token_is_not_served(client, path):
    for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": "é".encode()}):
        send = client.post if path.startswith("/files") else client.get
        assert send(path, headers=headers).status_code == 401


def test_files_that_are_too_large_or_none(client, tmp_path):
    def status(name="a.ply", content=b"x", **headers):
        return client.post("/files", params={"name": name}, content=content, headers=TOKEN | headers).status_code

    assert status(content=b"1" * 1001) == 413
    assert status(content=iter([b"1" * 600, b"2" * 600])) == 413  # without a length
    assert status(name="a.exe") == status(name="../../etc/passwd") == status(content=b"") == 400
    assert status(name="x" * 300) == 422
    assert {path.name for path in (tmp_path / "files").iterdir()} == {"incoming"}
    assert not list((tmp_path / "files" / "incoming").iterdir())


def test_a_file_that_breaks_off_is_none(tmp_path):
    uploads = Uploads(tmp_path, 1000)

    async def half():
        yield b"half"
        raise ConnectionResetError

    async def short():
        yield b"short"

    with pytest.raises(ConnectionResetError):
        asyncio.run(uploads.take(".ply", 100, half()))
    with pytest.raises(InputError, match="5 bytes of 100"):
        asyncio.run(uploads.take(".ply", 100, short()))
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == []


@pytest.mark.parametrize("path", ["/jobs/..", "/jobs/../../etc/passwd", "/jobs/%2e%2e%2f%2e%2e/files/x",
                                  "/jobs/NAME/files/..%2f..%2fjobs", "/jobs/NAME/files/%2e%2e", "/jobs/NAME/files/link",
                                  "/jobs/" + "x" * 65])
def test_paths_lead_nowhere_else(client, jobs, tmp_path, path):
    name = jobs.add(tmp_path / "m.step", tmp_path / "s.ply", {}).name
    (tmp_path / "secret").write_text("secret")
    layout.deliver(jobs.results, Outcome(Path("s.ply"), name, 0),
                   lambda at: (at / "link").symlink_to(tmp_path / "secret"))
    answer = client.get(path.replace("NAME", name), headers=TOKEN)
    assert answer.status_code in (404, 422) and "secret" not in answer.text


@pytest.mark.parametrize("wanted", [
    {}, [], {"model": 1, "scan": 2}, {"model": "../m.step", "scan": "x"}, {"model": "MODEL", "scan": "MODEL"},
    {"model": "MODEL", "scan": "SCAN", "options": {"out": "x"}}, {"model": "MODEL"},
    {"model": "MODEL", "scan": "SCAN", "options": {"sensor": "/etc/passwd"}},
    {"model": "MODEL", "scan": "SCAN", "options": {"lattice": [1]}},
    {"model": "MODEL", "scan": "SCAN", "options": {"faces": "Face1"}},
    {"model": "MODEL", "scan": "SCAN", "options": {"source_points": 2.5}},
    {"model": "MODEL", "scan": "SCAN", "options": {"stiffness": 1e300}},
    {"model": "MODEL", "scan": "SCAN", "options": {"method": "magic"}}])
def test_what_is_no_job(client, jobs, wanted):
    files = {"MODEL": sent(client), "SCAN": sent(client, "s.ply", b"s")}
    text = json.dumps(wanted)
    for word, name in files.items():
        text = text.replace(word, name)
    answer = client.post("/jobs", content=text, headers=TOKEN | {"Content-Type": "application/json"})
    assert answer.status_code in (400, 422) and jobs.names() == []


def test_options_are_those_of_register():
    request, unit = read_options({"faces": ["Face6"], "lattice": [10, 10], "method": "ffds", "scan_unit": "m"})
    assert (request.faces, request.lattice, request.method, unit) == (("Face6",), (10, 10), "ffds", "m")


def test_the_description_says_what_there_is(client):
    paths = client.get("/openapi.json").json()["paths"]
    assert set(paths) == {"/files", "/jobs", "/jobs/{job}", "/jobs/{job}/files/{name}"}
