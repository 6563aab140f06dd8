# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all tests share: FreeCAD on the path, the optional data folder, and ways to run the command line."""
from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared"

if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from ffds_workbench import find_freecad

find_freecad.activate()

os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("HYPOTHESIS_STORAGE_DIRECTORY", str(Path(tempfile.gettempdir()) / f"hypothesis-{os.getuid()}"))


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of parts, scans and cases beside the checkout; the test is skipped where it is absent."""
    if not (SHARED / "data").is_dir():
        pytest.skip("../shared is absent: the parts and scans it holds are not part of the project")
    return SHARED


@pytest.fixture(scope="session")
def shared_data(shared: Path) -> Path:
    """``../shared/data``, or a skip."""
    return shared / "data"


@pytest.fixture(scope="session")
def check_report():
    """Checks a report, a dictionary, against resources/docs/report.schema.json; nothing where jsonschema is missing."""
    try:
        import jsonschema
    except ImportError:
        return lambda report: None
    schema = json.loads((ROOT / "resources" / "docs" / "report.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema).validate


@pytest.fixture(autouse=True)
def every_report_keeps_the_schema(monkeypatch, check_report):
    """What is written in this process; `ffds` looks at what its processes write."""
    from ffds_workbench.report import record

    write = record.write
    monkeypatch.setattr(record, "write", lambda report, path: (write(report, path), check_report(
        json.loads(path.read_text("utf-8")))))


@pytest.fixture
def ffds(tmp_path: Path, check_report):
    """Run the launcher: ``ffds("deviation", model, scan)`` gives the finished process (text output)."""

    def run(*arguments: object, cwd: Path = tmp_path, timeout: float = 120, **options) -> subprocess.CompletedProcess:
        done = subprocess.run([str(ROOT / "ffds"), *map(str, arguments)], cwd=cwd, timeout=timeout, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, **options)
        for option, path in pairwise(arguments):
            if option in ("--report", "--pose") and done.returncode == 0:
                check_report(json.loads((cwd / path).read_text("utf-8")))
        return done

    return run


@pytest.fixture(scope="session")
def plate(tmp_path_factory) -> tuple[Path, Path]:
    """A plate of 60 × 40 × 5 mm as STEP, and a scan of its upper face (Face6) with a bump: (model, scan).

    The bump is 1 mm high, the noise 0.05 mm along z; every point lies on the analytic surface but for that.
    """
    import numpy as np
    import Part

    folder = tmp_path_factory.mktemp("plate")
    Part.makeBox(60, 40, 5).exportStep(str(folder / "plate.step"))
    random = np.random.default_rng(0)
    x, y = random.uniform((0, 0), (60, 40), (8000, 2)).T
    z = 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2)) + random.normal(0, 0.05, 8000)
    np.savetxt(folder / "scan.xyz", np.stack([x, y, z], axis=1), fmt="%.6f")
    return folder / "plate.step", folder / "scan.xyz"
