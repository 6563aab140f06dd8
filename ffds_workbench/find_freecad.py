# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes ``import FreeCAD`` work in a plain Python: finds the installation and puts it on ``sys.path``.

Inside FreeCAD nothing has to be done. Elsewhere the folder that holds ``FreeCAD.so`` is looked for; ``FREECAD_LIB``
names it where it is in an unusual place.
"""
from __future__ import annotations

import atexit
import importlib.util
import os
import shutil
import sys
import tempfile
from pathlib import Path

from . import ROOT
from .errors import InputError

_FOLDERS = ("/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib", "/usr/lib64/freecad/lib",
            "/usr/local/lib/freecad/lib", "/usr/local/lib")
_SHARED = ("/usr/lib/freecad", "/usr/share/freecad", "/usr/local/share/freecad")


def find_library() -> Path | None:
    """The folder that holds FreeCAD's compiled module, or None where there is no FreeCAD."""
    folders = [Path(name) for name in (os.environ.get("FREECAD_LIB"), *_FOLDERS) if name]
    executable = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if executable:
        folders.append(Path(executable).resolve().parent.parent / "lib")
    return next((folder for folder in folders if any(folder.glob("FreeCAD.*so"))), None)


def activate() -> None:
    """Import FreeCAD, its folders put on ``sys.path`` where they are not yet; harmless inside FreeCAD.

    Raises
    ------
    InputError : there is no FreeCAD on this machine.
    """
    if "FreeCAD" in sys.modules:
        return
    if importlib.util.find_spec("FreeCAD") is None:
        _put_on_path()
    _find_home()
    importlib.import_module("FreeCAD")  # Part crashes the interpreter where it is imported before FreeCAD
    # FreeCAD puts its modules first: a copy of FFDS among them would be taken by the processes that are started here.
    sys.path[:] = [str(ROOT), *(path for path in sys.path if path != str(ROOT))]


def interpreter() -> str:
    """A Python to run a script with: inside FreeCAD ``sys.executable`` may be FreeCAD itself."""
    if "python" in Path(sys.executable or "").name:
        return sys.executable
    return str(Path(sys.exec_prefix) / "bin" / "python3")


def _find_home() -> None:
    """A home for the moment where the user's cannot be written: FreeCAD 1.1 ends the process there."""
    if os.access(os.environ.get("FREECAD_USER_HOME") or os.path.expanduser("~"), os.W_OK):
        return
    folder = tempfile.mkdtemp(prefix="ffds-home-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ.update({"FREECAD_USER_HOME": folder, "XDG_CACHE_HOME": folder})  # processes that are started share it


def _put_on_path() -> None:
    library = find_library()
    if library is None:
        raise InputError("FreeCAD was not found: install it (./ffds setup) or name the folder of its FreeCAD.so "
                         "in FREECAD_LIB.")
    sys.path.insert(0, str(library))
    for shared in map(Path, _SHARED):
        extra = [shared / "Ext", *sorted((shared / "Mod").glob("*"))]
        sys.path.extend(str(folder) for folder in extra if folder.is_dir() and str(folder) not in sys.path)
