# SPDX-License-Identifier: LGPL-2.1-or-later
"""The legend of a deviation: its histogram over the colour scale, with the tolerance band."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..qt import QtCore, QtGui, QtWidgets
from ..translating import tr
from ..view3d.colours import NO_DATA, SMOOTH, packed_colours

Array = NDArray[np.float64]

_BINS = 61
_BAR, _TEXT, _MARGIN = 12, 18, 10
_TALL = 150


class Legend(QtWidgets.QWidget):
    """Histogram, colour bar and numbers; ``show_deviations`` fills it."""

    def __init__(self, parent: Any = None) -> None:
        super().__init__(parent)
        self.setMinimumHeight(_TALL)
        self.setSizePolicy(QtWidgets.QSizePolicy.Expanding, QtWidgets.QSizePolicy.Fixed)
        self._counts = np.zeros(_BINS)
        self._limit, self._tolerance, self._steps = 1.0, 0.0, SMOOTH

    def sizeHint(self) -> Any:
        """As Qt asks."""
        return QtCore.QSize(260, _TALL)

    def show_deviations(self, values: Array, limit: float, tolerance: float = 0.0, steps: int = SMOOTH) -> None:
        """Deviations (n,) in mm; the rest is of `packed_colours`. What lies beyond is counted in the outermost bins."""
        self._counts = np.histogram(np.clip(values, -limit, limit), _BINS, (-limit, limit))[0].astype(float)
        self._limit, self._tolerance, self._steps = limit, tolerance, steps
        self.update()

    def paintEvent(self, event: Any) -> None:
        """As Qt asks."""
        painter = QtGui.QPainter(self)
        width, height = self.width() - 2 * _MARGIN, self.height() - _BAR - 2 * _TEXT - 8
        centres = (np.arange(_BINS) + 0.5) / _BINS * 2 - 1
        colours = packed_colours(centres * self._limit, self._limit, self._tolerance, self._steps)
        tallest = max(float(self._counts.max()), 1.0)
        for k, (count, colour) in enumerate(zip(self._counts, colours, strict=True)):
            left, right = (_MARGIN + int(round(edge * width / _BINS)) for edge in (k, k + 1))
            fill = _colour(int(colour))
            tall = int(round(count / tallest * (height - 4)))
            painter.fillRect(left, height - tall, right - left, tall, fill)
            painter.fillRect(left, height + 3, right - left, _BAR, fill)
        painter.setPen(self.palette().color(QtGui.QPalette.WindowText))
        painter.drawLine(_MARGIN, height, _MARGIN + width, height)
        for place, align in ((-1, QtCore.Qt.AlignLeft), (0, QtCore.Qt.AlignHCenter), (1, QtCore.Qt.AlignRight)):
            text = f"{place * self._limit:+.3g} mm" if place else "0"
            box = QtCore.QRect(_MARGIN, height + _BAR + 4, width, _TEXT)
            painter.drawText(box, int(align), text)
        below = height + _BAR + _TEXT + 6
        painter.fillRect(_MARGIN, below + 2, _BAR, _BAR, _colour(NO_DATA))
        painter.drawText(QtCore.QRect(_MARGIN + _BAR + 6, below, width, _TEXT), int(QtCore.Qt.AlignLeft),
                         tr("no scan there"))
        painter.end()


def _colour(packed: int) -> Any:
    return QtGui.QColor(packed >> 24 & 255, packed >> 16 & 255, packed >> 8 & 255)
