# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the GUI tests inside FreeCAD and leaves it with pytest's exit code, whatever happens."""
import ctypes
import os
import sys
import traceback
from pathlib import Path

import pytest
from PySide import QtCore


def run() -> None:
    """Run pytest once FreeCAD's event loop is up."""
    code = 1
    try:
        code = int(pytest.main(["-q", "-s", str(Path(__file__).resolve().parent)]))
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)  # FreeCAD 1.1 holds what it prints back
    os._exit(code)


QtCore.QTimer.singleShot(0, run)
