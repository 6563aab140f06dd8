# SPDX-License-Identifier: LGPL-2.1-or-later
"""An environment of its own for each peer that is not at hand: a virtual environment, filled by pip."""
from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

_SECONDS = 900


@dataclass(frozen=True)
class Environment:
    """A Python to run a peer with, or why there is none.

    Attributes
    ----------
    python : its interpreter, None where the peer cannot be had
    missing : the reason, in a few words, where it cannot be had
    """

    python: Path | None
    missing: str = ""


def here() -> Environment:
    """The Python that runs this."""
    return Environment(Path(sys.executable))


def make(folder: Path, package: str, module: str) -> Environment:
    """A virtual environment in ``folder`` in which ``module`` can be imported, made of the package index's ``package``.

    It sees the packages of the system too; what was made once is used again.
    """
    python = folder / "bin" / "python"
    if _imports(python, module):
        return Environment(python)
    for step, command in (
            ("no virtual environment could be made",
             [sys.executable, "-m", "venv", "--system-site-packages", str(folder)]),
            ("it could not be installed", [str(python), "-m", "pip", "install", "--quiet", package])):
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return Environment(None, f"{step} within {_SECONDS} s")
        except OSError as error:
            return Environment(None, f"{step}: {error.strerror}")
        if done.returncode:
            return Environment(None, step)
    return Environment(python) if _imports(python, module) else Environment(None, "it was installed but does not load")


def _imports(python: Path, module: str) -> bool:
    if not python.exists():
        return False
    try:
        done = subprocess.run([str(python), "-c", f"import {module}"], capture_output=True, timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0
