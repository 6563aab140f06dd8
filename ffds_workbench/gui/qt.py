# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt as this FreeCAD has it: ``from .qt import QtCore, QtGui, QtWidgets``."""
from __future__ import annotations

from ..compat import execute, number_of, qt, shortcut

QtCore, QtGui, QtWidgets = qt("QtCore"), qt("QtGui"), qt("QtWidgets")

__all__ = ["QtCore", "QtGui", "QtWidgets", "execute", "number_of", "shortcut"]
