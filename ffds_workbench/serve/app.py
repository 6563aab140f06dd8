# SPDX-License-Identifier: LGPL-2.1-or-later
"""What HTTP sees: send files, ask for a job, follow it, fetch what came of it. ``/openapi.json`` describes it."""
# Without "from __future__ import annotations": FastAPI reads the annotations of these functions.
import hmac
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Optional

from fastapi import Depends, FastAPI, HTTPException, Path as InPath, Query, Request
from fastapi.responses import FileResponse, JSONResponse
from pydantic import BaseModel, Field
from starlette.requests import ClientDisconnect

from .. import __version__
from ..brep.model_files.reading import FORMATS as MODELS
from ..errors import InputError
from ..scan.files import FORMATS as SCANS
from .jobs import Jobs
from .runner import Runner
from .uploads import TooLargeError, Uploads

_MOST_JOBS = 1000
_FULL_DISK = 507


class SentFile(BaseModel):
    """A file that was taken in."""

    file: str = Field(description="its name here: the SHA-256 of its content, and its format")
    bytes: int


class WantedJob(BaseModel):
    """What is to be registered to what."""

    model: str = Field(description="the name that sending the model gave")
    scan: str = Field(description="the name that sending the scan gave")
    options: dict[str, Any] = Field(default_factory=dict, description="those of register: faces, method, align, …")


class JobState(BaseModel):
    """Where a job stands."""

    job: str
    state: str = Field(description="open, registered or refused; failed where the machine did")
    exit: Optional[int] = None
    said: str = ""
    seconds: float = 0.0
    files: list[str] = []


def make_app(uploads: Uploads, jobs: Jobs, runner: Runner, token: str) -> FastAPI:
    """The application.

    Parameters
    ----------
    uploads, jobs, runner : what it works on
    token : that every request but for the description has to bring, ``Authorization: Bearer TOKEN``
    """
    app = FastAPI(title="FFDS", version=__version__, docs_url=None, redoc_url=None, dependencies=[Depends(_allowed)],
                  description="As-built CAD models from scans.")
    app.state.uploads, app.state.jobs, app.state.runner, app.state.token = uploads, jobs, runner, token
    app.add_event_handler("startup", runner.start)
    app.add_event_handler("shutdown", runner.stop)
    app.add_exception_handler(TooLargeError, lambda request, error: _said(413, error))
    app.add_exception_handler(InputError, lambda request, error: _said(400, error))
    app.add_exception_handler(OSError, lambda request, error: _said(_FULL_DISK, error))
    app.post("/files", status_code=201, response_model=SentFile)(_send)
    app.post("/jobs", status_code=202, response_model=JobState)(_ask)
    app.get("/jobs", response_model=list[JobState])(_list)
    app.get("/jobs/{job}", response_model=JobState)(_follow)
    app.get("/jobs/{job}/files/{name}", response_class=FileResponse)(_fetch)
    return app


def _said(status: int, error: Exception) -> JSONResponse:
    return JSONResponse({"detail": " ".join(str(error).split())}, status)


def _allowed(request: Request) -> None:
    """Only who knows the token is served."""
    given = request.headers.get("authorization", "").encode("utf-8", "replace")
    if not hmac.compare_digest(given, f"Bearer {request.app.state.token}".encode()):
        raise HTTPException(401, "Send the header 'Authorization: Bearer TOKEN', with the token that the server shows.")


async def _send(request: Request, name: str = Query(max_length=200, description="of the file; its ending tells its "
                                                    "format")) -> SentFile:
    """Send a model or a scan, as the body of the request."""
    length = request.headers.get("content-length", "")
    try:
        file, size = await request.app.state.uploads.take(Path(name).suffix, int(length) if length.isdigit() else None,
                                                          _pieces(request))
    except ClientDisconnect as error:
        raise HTTPException(400, "The file was broken off.") from error
    return SentFile(file=file, bytes=size)


async def _pieces(request: Request) -> AsyncIterator[bytes]:
    async for piece in request.stream():
        yield piece


def _ask(request: Request, wanted: WantedJob) -> JobState:
    """Have a scan registered to a model."""
    state = request.app.state
    job = state.jobs.add(state.uploads.path(wanted.model, MODELS), state.uploads.path(wanted.scan, SCANS),
                         wanted.options)
    state.runner.add(job)
    return _state(request, job.name)


def _list(request: Request) -> list[JobState]:
    """The jobs, the newest first."""
    return [_state(request, name) for name in reversed(request.app.state.jobs.names()[-_MOST_JOBS:])]


def _follow(request: Request, job: str = InPath(max_length=64)) -> JobState:
    """Where a job stands."""
    return _state(request, job)


def _fetch(request: Request, job: str = InPath(max_length=64), name: str = InPath(max_length=64)) -> FileResponse:
    """A file that came of a job."""
    found = request.app.state.jobs.files(job).get(name)
    if found is None:
        raise HTTPException(404, "There is no such file.")
    return FileResponse(found, filename=name)


def _state(request: Request, name: str) -> JobState:
    jobs, runner = request.app.state.jobs, request.app.state.runner
    with suppress(KeyError):
        _, found = jobs.get(name)
        if found is not None:
            return JobState(job=name, state="refused" if found.exit else "registered", exit=found.exit, said=found.said,
                            seconds=found.seconds, files=list(jobs.files(name)))
        failed = runner.failed(name)
        if failed is not None:
            return JobState(job=name, state="failed", exit=failed.exit, said=failed.said)
        return JobState(job=name, state="open")
    raise HTTPException(404, "There is no such job.")
