# SPDX-License-Identifier: LGPL-2.1-or-later
"""The widgets of the deformation panel: what they show, and the settings they stand for."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...errors import InputError
from ...registration.request import LEAST_CONTROL_POINTS, LEAST_SOURCE_POINTS, RegistrationRequest
from ..preferences import preferences
from ..qt import QtCore, QtWidgets
from ..translating import tr
from ..widgets import Form, ProgressBar, choice, folded, length, named, spin, wrapped
from .findings import Findings
from .stiffness_slider import StiffnessSlider

_WIDEST = 40
_LARGEST_GATE = 1000.0
_MANY = 1_000_000


def _methods() -> list[tuple[str, str]]:
    return [(tr("Robust"), "robust"), (tr("Published FFDS"), "ffds"), (tr("FFD by Hsu"), "ffd-hsu")]


def _isometries() -> list[tuple[str, str]]:
    return [(tr("From the scan"), "auto"), (tr("Inextensible"), "on"), (tr("May stretch"), "off")]


class DeformationForm(Form):
    """Emits ``changed`` when a setting changes."""

    changed = QtCore.Signal()

    def __init__(self, scans: Sequence[Any], editing: bool) -> None:
        super().__init__()
        self.busy, self._editing = False, editing
        self.setWindowTitle(tr("Deform to scan"))
        self._make(scans)
        self._lay_out()
        self._connect()
        wished = preferences()
        self._show_method(wished.method, wished.isometry, wished.stiffness, wished.gate)
        self._enable()

    def _make(self, scans: Sequence[Any]) -> None:
        self._part = wrapped("FfdsPart")
        self.by_box = named(QtWidgets.QToolButton(), "FfdsPickBox",
                            tr("Draw a box in the 3D view: the faces in it that the scan shows are picked"))
        self.by_box.setText(tr("By box"))
        self._scan = choice("FfdsScan", [(scan.Label, scan.Name) for scan in scans],
                            tr("The scan; picking a point cloud in the view or the tree chooses it as well"))
        self._whole = named(QtWidgets.QCheckBox(tr("Whole part")), "FfdsWhole",
                            tr("All faces together, those that the scan does not see carried along"))
        self._automatic = named(QtWidgets.QCheckBox(tr("Automatic")), "FfdsAutomatic",
                                tr("The number of control points is chosen from the data"))
        self._automatic.setChecked(True)
        self._sizes = [self._size("U"), self._size("V")]
        self._stiffness = StiffnessSlider()
        self._gate = length("FfdsGate", 0.0, _LARGEST_GATE,
                            tr("Scan points farther than this from the deformed faces are left out; automatic: a "
                               "distance that suits most scans"))
        self._gate.setSpecialValueText(tr("automatic"))
        self._gate.setSingleStep(0.1)
        self._method = choice("FfdsMethod", _methods(), tr(
            "Robust copes with noise, gaps and clutter; FFDS as it was published; FFD by Hsu, with a lattice in space"))
        self._source_points = spin("FfdsSourcePoints", RegistrationRequest().source_points, LEAST_SOURCE_POINTS, _MANY,
                                   tr("For the published methods, on each face"))
        self._isometry = choice("FfdsIsometry", _isometries(), tr("For whole sheet parts: whether they may stretch"))
        self._freeze = named(QtWidgets.QLineEdit(), "FfdsFreeze",
                             tr("Faces that must not move, for instance Face1, Face4"))
        self._pick_frozen = named(QtWidgets.QToolButton(), "FfdsPickFrozen",
                                  tr("While this is pressed, picked faces are frozen, or set free again"))
        self._pick_frozen.setText(tr("Pick"))
        self._pick_frozen.setCheckable(True)
        self._result = choice("FfdsResult", [(tr("Part beside it"), False), (tr("Replace in place"), True)],
                              tr("An as-built part beside the nominal one follows it and the scan; replacing is for "
                                 "plain shapes without a history"))
        self.found = Findings()
        self._progress = named(ProgressBar(), "FfdsProgressBar")
        self._doing = wrapped("FfdsDoing")
        for widget in (self._progress, self._doing):
            widget.setVisible(False)

    def _size(self, direction: str) -> tuple[Any, Any]:
        name = f"FfdsControlPoints{direction}"
        box = spin(name, 10, LEAST_CONTROL_POINTS, 400,
                   tr("Control points in {direction}").format(direction=direction.lower()))
        slider = named(QtWidgets.QSlider(QtCore.Qt.Horizontal), f"{name}Slider", box.toolTip())
        slider.setRange(LEAST_CONTROL_POINTS, _WIDEST)
        slider.setValue(10)
        slider.valueChanged.connect(box.setValue)
        return box, slider

    def _lay_out(self) -> None:
        column = QtWidgets.QVBoxLayout(self)
        basic = QtWidgets.QFormLayout()
        basic.addRow(tr("Deform"), self._part)
        basic.addRow(self.by_box, self._whole)
        basic.addRow(tr("Scan"), self._scan)
        basic.addRow(tr("Control points"), self._automatic)
        for name, (box, slider) in zip("uv", self._sizes, strict=True):
            basic.addRow("   " + tr("in {direction}").format(direction=name), _beside(slider, box))
        basic.addRow(tr("Stiffness"), self._stiffness)
        column.addLayout(basic)
        more = QtWidgets.QWidget()
        form = QtWidgets.QFormLayout(more)
        form.setContentsMargins(0, 0, 0, 0)
        for label, widget in ((tr("Outliers beyond"), self._gate), (tr("Method"), self._method),
                              (tr("Source points"), self._source_points), (tr("Sheet"), self._isometry),
                              (tr("Freeze"), _beside(self._freeze, self._pick_frozen)), (tr("Result"), self._result)):
            form.addRow(label, widget)
        column.addWidget(folded(tr("More"), "FfdsMore", more))
        for widget in (self.found, self._doing, self._progress):
            column.addWidget(widget)

    def _connect(self) -> None:
        for widget in (self._scan, self._method, self._isometry):
            widget.currentIndexChanged.connect(self._emit)
        for widget in (self._automatic, self._whole):
            widget.toggled.connect(self._emit)
        for widget in (self._source_points, self._gate, *(box for box, _ in self._sizes)):
            widget.valueChanged.connect(self._emit)
        self._stiffness.changed.connect(self._emit)
        self._freeze.editingFinished.connect(self._emit)
        for box, slider in self._sizes:
            box.valueChanged.connect(lambda value, slider=slider: _move(slider, value))

    def _emit(self, *_: Any) -> None:
        self._enable()
        self.changed.emit()

    def _enable(self) -> None:
        robust = self._method.currentData() == "robust"
        together = self.whole and robust
        self._automatic.setEnabled(not together)
        self.by_box.setEnabled(not self.whole)
        for widget in (widget for pair in self._sizes for widget in pair):
            widget.setEnabled(not together and not self._automatic.isChecked())
        self._isometry.setEnabled(together)
        self._stiffness.setEnabled(robust)
        self._gate.setEnabled(robust)
        self._source_points.setEnabled(not robust)
        self._result.setEnabled(not self._editing)

    @property
    def whole(self) -> bool:
        """Whether the whole part is to be deformed."""
        return self._whole.isChecked()

    @property
    def in_place(self) -> bool:
        """Whether the part itself is to be replaced."""
        return bool(self._result.currentData())

    @property
    def picks_frozen(self) -> bool:
        """Whether faces that are picked are meant to be frozen."""
        return self._pick_frozen.isChecked()

    def scan(self, document: Any) -> Any:
        """The chosen scan, None without any."""
        name = self._scan.currentData()
        return document.getObject(name) if name else None

    def freeze(self) -> tuple[str, ...]:
        """The faces to freeze (InputError where the text names none)."""
        names = tuple(name.strip() for name in self._freeze.text().replace(";", ",").split(",") if name.strip())
        for name in names:
            if not (name.startswith("Face") and name[4:].isdigit()):
                raise InputError(tr("'{name}' is no face to freeze: write names like Face1, Face4.").format(name=name))
        return names

    def toggle_frozen(self, faces: Sequence[str]) -> None:
        """Freeze faces, and set those free that are frozen."""
        kept = dict.fromkeys(self.freeze())
        for name in faces:
            if name in kept:
                del kept[name]
            else:
                kept[name] = None
        self._freeze.setText(", ".join(kept))

    def request(self, faces: tuple[str, ...]) -> RegistrationRequest:
        """What the widgets say (InputError where that makes no sense)."""
        robust = self._method.currentData() == "robust"
        together = self.whole and robust
        size = tuple(box.value() for box, _ in self._sizes)
        return RegistrationRequest(
            None if self.whole else faces, self._method.currentData(),
            "auto" if self._automatic.isChecked() or together else (size[0], size[1]), self.freeze(),
            self._source_points.value(), self._isometry.currentData() if together else "auto",
            self._stiffness.value() if robust else 1.0,
            self._gate.value() if robust and self._gate.value() > 0 else None)

    def take(self, request: RegistrationRequest, scan: Any) -> None:
        """Show an existing request."""
        self.set_scan(scan)
        self._show_method(request.method, request.isometry, request.stiffness, request.gate or 0.0)
        self._source_points.setValue(request.source_points)
        self._freeze.setText(", ".join(request.freeze))
        self._automatic.setChecked(request.lattice == "auto")
        if request.lattice != "auto":
            for (box, _), count in zip(self._sizes, request.lattice, strict=True):
                box.setValue(count)

    def _show_method(self, method: str, isometry: str, stiffness: float, gate: float) -> None:
        self._method.setCurrentIndex(self._method.findData(method))
        self._isometry.setCurrentIndex(self._isometry.findData(isometry))
        self._stiffness.set_value(stiffness)
        self._gate.setValue(gate)

    def show_size(self, size: tuple[int, int]) -> None:
        """Show the control points that were chosen from the data."""
        if self._automatic.isChecked():
            for (box, slider), count in zip(self._sizes, size, strict=True):
                box.blockSignals(True)
                box.setValue(count)
                box.blockSignals(False)
                _move(slider, count)

    def set_scan(self, scan: Any) -> None:
        """Choose a scan."""
        if scan is not None:
            self._scan.setCurrentIndex(self._scan.findData(scan.Name))

    def set_whole(self, whole: bool) -> None:
        """Choose the whole part."""
        self._whole.setChecked(whole)

    def show_picked(self, part: str, faces: Sequence[str]) -> None:
        """Say which part and which faces are picked."""
        self._part.setText(f"<b>{part}</b> {', '.join(faces)}" if part else
                           f"<i>{tr('pick faces in the 3D view')}</i>")

    def show_progress(self, text: str) -> None:
        """Say what is being done, nothing for no work."""
        if text:
            self._doing.setText(f"{text} …")
            self._progress.step()
        else:
            self._progress.setValue(0)
        self._doing.setVisible(bool(text))
        self._progress.setVisible(bool(text))

    def set_busy(self, busy: bool) -> None:
        """Lock the settings while the part is being computed."""
        self.busy = busy
        self.show_progress(tr("Computing the part") if busy else "")
        for widget in self.findChildren(QtWidgets.QWidget):
            if isinstance(widget, (QtWidgets.QAbstractSpinBox, QtWidgets.QComboBox, QtWidgets.QAbstractButton,
                                   QtWidgets.QSlider, QtWidgets.QLineEdit)):
                widget.setEnabled(not busy)
        if not busy:
            self._enable()


def _beside(first: Any, second: Any) -> Any:
    """Two widgets in a row, the first one taking the room."""
    holder = QtWidgets.QWidget()
    row = QtWidgets.QHBoxLayout(holder)
    row.setContentsMargins(0, 0, 0, 0)
    row.addWidget(first, 1)
    row.addWidget(second)
    return holder


def _move(slider: Any, value: int) -> None:
    """Let a slider follow its box without answering back."""
    slider.blockSignals(True)
    slider.setValue(value)
    slider.blockSignals(False)
