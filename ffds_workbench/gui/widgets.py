# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the task panels share: named widgets, folded groups, and the numbers under them."""
from __future__ import annotations

from typing import Any

from .qt import QtCore, QtWidgets

_SHORT = 6
"""Letters of a list's entries that are seen even in a narrow panel."""
DOUBTFUL = "#b3401f"
"""Colour of what is wrong, or should be looked at."""


class Form(QtWidgets.QWidget):
    """The widget of a task panel. Enter ends the editing of a field; FreeCAD would press OK."""

    def keyPressEvent(self, event: Any) -> None:
        """As Qt asks."""
        if event.key() not in (QtCore.Qt.Key_Return, QtCore.Qt.Key_Enter):
            super().keyPressEvent(event)


def named(widget: Any, name: str, tip: str = "") -> Any:
    """The widget with an object name, by which tests and style sheets find it, and a tooltip."""
    widget.setObjectName(name)
    widget.setToolTip(tip)
    return widget


def spin(name: str, value: int, low: int, high: int, tip: str) -> Any:
    """A box for a whole number."""
    box = named(QtWidgets.QSpinBox(), name, tip)
    box.setRange(low, high)
    box.setValue(value)
    return box


def length(name: str, value: float, high: float, tip: str, decimals: int = 3) -> Any:
    """A box for a length in mm."""
    box = named(QtWidgets.QDoubleSpinBox(), name, tip)
    box.setDecimals(decimals)
    box.setRange(0.0, high)
    box.setSingleStep(max(value / 10, 10.0**-decimals))
    box.setSuffix(" mm")
    box.setValue(value)
    return box


def choice(name: str, entries: list[tuple[str, Any]], tip: str) -> Any:
    """A list to choose one entry of: (text, value)."""
    box = named(QtWidgets.QComboBox(), name, tip)
    for text, value in entries:
        box.addItem(text, value)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(_SHORT)
    box.setSizePolicy(QtWidgets.QSizePolicy.Expanding, QtWidgets.QSizePolicy.Fixed)
    return box


def folded(title: str, name: str, content: Any) -> Any:
    """A widget that is folded away below its title until it is asked for."""
    holder = QtWidgets.QWidget()
    column = QtWidgets.QVBoxLayout(holder)
    column.setContentsMargins(0, 0, 0, 0)
    button = named(QtWidgets.QToolButton(), name)
    button.setText(f"▸ {title}")
    button.setAutoRaise(True)
    button.setCheckable(True)
    content.setVisible(False)

    def fold(open_: bool) -> None:
        content.setVisible(open_)
        button.setText(f"{'▾' if open_ else '▸'} {title}")

    button.toggled.connect(fold)
    column.addWidget(button)
    column.addWidget(content)
    return holder


class ProgressBar(QtWidgets.QProgressBar):
    """A bar for work of unknown length: every step takes it a part of the rest further.

    The bar that Qt has for this never stands still, and takes the time of half a processor from the work itself.
    """

    _RANGE, _SHARE = 1000, 0.2

    def __init__(self) -> None:
        super().__init__()
        self.setRange(0, self._RANGE)
        self.setTextVisible(False)

    def step(self) -> None:
        """Something was finished."""
        self.setValue(self.value() + round(self._SHARE * (self._RANGE - self.value())))


def wrapped(name: str) -> Any:
    """A label for sentences."""
    label = named(QtWidgets.QLabel(), name)
    label.setWordWrap(True)
    return label


def warning(name: str) -> Any:
    """A label for sentences on what is wrong."""
    label = wrapped(name)
    label.setStyleSheet(f"color: {DOUBTFUL}")
    return label
