# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt as this FreeCAD has it: ``from .qt import QtCore, QtGui, QtWidgets``."""
from __future__ import annotations

from typing import Any

try:
    from PySide2 import QtCore, QtGui, QtWidgets
except ImportError:
    from PySide6 import QtCore, QtGui, QtWidgets

__all__ = ["QtCore", "QtGui", "QtWidgets", "execute"]


def execute(loop_or_dialog: Any) -> int:
    """Run a dialog or an event loop until it ends: ``exec_`` in Qt 5, ``exec`` in Qt 6."""
    run = getattr(loop_or_dialog, "exec", None) or loop_or_dialog.exec_
    return run()
