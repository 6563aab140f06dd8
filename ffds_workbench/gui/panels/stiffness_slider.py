# SPDX-License-Identifier: LGPL-2.1-or-later
"""The slider of the stiffness: from soft to stiff on a logarithmic scale, the default in the middle."""
from __future__ import annotations

import math

from ..qt import QtCore, QtWidgets
from ..translating import tr
from ..widgets import named

_TICKS = 10
"""Steps per decade."""
_DECADES = 3


class StiffnessSlider(QtWidgets.QWidget):
    """Emits ``changed`` when it is moved."""

    changed = QtCore.Signal()

    def __init__(self) -> None:
        super().__init__()
        tip = tr("To the left the faces follow the scan more closely, to the right they stay smoother")
        self._slider = named(QtWidgets.QSlider(QtCore.Qt.Horizontal), "FfdsStiffness", tip)
        self._slider.setRange(-_TICKS * _DECADES, _TICKS * _DECADES)
        self._slider.setPageStep(_TICKS)
        self._shown = named(QtWidgets.QLabel(), "FfdsStiffnessValue", tip)
        self._shown.setMinimumWidth(self._shown.fontMetrics().boundingRect("0.0013").width())
        self._exact = 1.0
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self._slider, 1)
        row.addWidget(self._shown)
        self._slider.valueChanged.connect(self._moved)
        self.set_value(1.0)

    def value(self) -> float:
        """The factor of the bending energy."""
        return self._exact

    def set_value(self, stiffness: float) -> None:
        """Show a factor; one that lies between the steps or beyond the ends is kept until the slider is moved."""
        self._slider.blockSignals(True)
        self._slider.setValue(round(_TICKS * math.log10(stiffness)))
        self._slider.blockSignals(False)
        self._show(stiffness)

    def _moved(self, step: int) -> None:
        self._show(float(f"{10 ** (step / _TICKS):.2g}"))
        self.changed.emit()

    def _show(self, stiffness: float) -> None:
        self._exact = stiffness
        self._shown.setText(f"{stiffness:g}")
