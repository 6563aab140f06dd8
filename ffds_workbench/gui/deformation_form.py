# SPDX-License-Identifier: LGPL-2.1-or-later
"""The widgets of the deformation panel: what they show, and the settings they stand for."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..errors import InputError
from ..objects.job import Settings
from .legend import Legend
from .panel import choice, folded, named, spin, wrapped
from .qt import QtCore, QtWidgets

_METHODS = [("Robust: noise, gaps and clutter", "robust"), ("FFDS as published", "ffds"),
            ("FFD by Hsu: a lattice in space", "ffd-hsu")]
_ISOMETRY = [("Decide from the scan", "auto"), ("Inextensible sheet", "on"), ("May stretch", "off")]
_WIDEST = 40


class DeformationForm(QtWidgets.QWidget):
    """Emits ``changed`` when a setting changes."""

    changed = QtCore.Signal()

    def __init__(self, scans: Sequence[Any], editing: bool) -> None:
        super().__init__()
        self.busy = False
        self.setWindowTitle("Deform to scan")
        self._part = wrapped("FfdsPart")
        self._scan = choice("FfdsScan", [(scan.Label, scan.Name) for scan in scans],
                            "The scan; picking a point cloud in the view or the tree chooses it as well")
        self._whole = named(QtWidgets.QCheckBox("Whole part"), "FfdsWhole",
                            "All faces together, those that the scan does not see carried along")
        self._automatic = named(QtWidgets.QCheckBox("Automatic"), "FfdsAutomatic",
                                "The number of control points is chosen from the data")
        self._automatic.setChecked(True)
        self._sizes = [self._size("U"), self._size("V")]
        self._method = choice("FfdsMethod", _METHODS, "How the control points are found")
        self._source_points = spin("FfdsSourcePoints", 400, 16, 1000000, "For the published methods, on each face")
        self._isometry = choice("FfdsIsometry", _ISOMETRY, "For whole sheet parts")
        self._freeze = named(QtWidgets.QLineEdit(), "FfdsFreeze", "Faces that must not move, for instance Face1, Face4")
        self._result = choice("FfdsResult", [("An as-built part beside it", False), ("Replace in place", True)],
                              "Replacing is for plain shapes without a history")
        self._editing = editing
        self._figures, self._message = wrapped("FfdsFigures"), wrapped("FfdsMessageLabel")
        self._message.setStyleSheet("color: #b3401f")
        self._legend = named(Legend(), "FfdsLegend", "Deviation of the scan from the deformed faces")
        self._progress = named(QtWidgets.QProgressBar(), "FfdsProgressBar")
        self._progress.setRange(0, 0)
        self._progress.setVisible(False)
        self._doing = wrapped("FfdsDoing")
        self._doing.setVisible(False)
        self._lay_out()
        self._connect()
        self._enable()

    def _size(self, direction: str) -> tuple[Any, Any]:
        name = f"FfdsControlPoints{direction}"
        box = spin(name, 10, 4, 400, f"Control points in {direction.lower()}")
        slider = named(QtWidgets.QSlider(QtCore.Qt.Horizontal), f"{name}Slider", box.toolTip())
        slider.setRange(4, _WIDEST)
        slider.setValue(10)
        slider.valueChanged.connect(box.setValue)
        return box, slider

    def _lay_out(self) -> None:
        column = QtWidgets.QVBoxLayout(self)
        basic = QtWidgets.QFormLayout()
        basic.addRow("Deform", self._part)
        basic.addRow("", self._whole)
        basic.addRow("Scan", self._scan)
        basic.addRow("Control points", self._automatic)
        for name, (box, slider) in zip("uv", self._sizes, strict=True):
            row = QtWidgets.QHBoxLayout()
            row.addWidget(slider, 1)
            row.addWidget(box)
            basic.addRow(f"   in {name}", row)
        column.addLayout(basic)
        more = QtWidgets.QWidget()
        form = QtWidgets.QFormLayout(more)
        for label, widget in (("Method", self._method), ("Source points", self._source_points),
                              ("Sheet", self._isometry), ("Freeze", self._freeze), ("Result", self._result)):
            form.addRow(label, widget)
        column.addWidget(folded("More", "FfdsMore", more))
        column.addWidget(self._figures)
        column.addWidget(self._legend)
        column.addWidget(self._message)
        column.addWidget(self._doing)
        column.addWidget(self._progress)

    def _connect(self) -> None:
        for widget in (self._scan, self._method, self._isometry):
            widget.currentIndexChanged.connect(self._emit)
        for widget in (self._automatic, self._whole):
            widget.toggled.connect(self._emit)
        for widget in (self._source_points, *(box for box, _ in self._sizes)):
            widget.valueChanged.connect(self._emit)
        self._freeze.editingFinished.connect(self._emit)
        for box, slider in self._sizes:
            box.valueChanged.connect(lambda value, slider=slider: _move(slider, value))

    def _emit(self, *_: Any) -> None:
        self._enable()
        self.changed.emit()

    def _enable(self) -> None:
        together = self.whole and self._method.currentData() == "robust"
        self._automatic.setEnabled(not together)
        for widget in (widget for pair in self._sizes for widget in pair):
            widget.setEnabled(not together and not self._automatic.isChecked())
        self._isometry.setEnabled(together)
        self._source_points.setEnabled(self._method.currentData() != "robust")
        self._result.setEnabled(not self._editing)

    @property
    def whole(self) -> bool:
        """Whether the whole part is to be deformed."""
        return self._whole.isChecked()

    @property
    def in_place(self) -> bool:
        """Whether the part itself is to be replaced."""
        return bool(self._result.currentData())

    def scan(self, document: Any) -> Any:
        """The chosen scan, None without any."""
        name = self._scan.currentData()
        return document.getObject(name) if name else None

    def settings(self, faces: tuple[str, ...]) -> Settings:
        """What the widgets say (InputError where that makes no sense)."""
        together = self.whole and self._method.currentData() == "robust"
        automatic = self._automatic.isChecked() or together
        freeze = tuple(name.strip() for name in self._freeze.text().replace(";", ",").split(",") if name.strip())
        wrong = [name for name in freeze if not (name.startswith("Face") and name[4:].isdigit())]
        if wrong:
            raise InputError(f"'{wrong[0]}' is no face to freeze: write names like Face1, Face4.")
        size = tuple(box.value() for box, _ in self._sizes)
        return Settings(None if self.whole else faces, freeze, self._method.currentData(),
                        "auto" if automatic else (size[0], size[1]), self._source_points.value(),
                        self._isometry.currentData() if together else "auto")

    def take(self, settings: Settings, scan: Any) -> None:
        """Show existing settings."""
        self.set_scan(scan)
        self._method.setCurrentIndex(self._method.findData(settings.method))
        self._isometry.setCurrentIndex(self._isometry.findData(settings.isometry))
        self._source_points.setValue(settings.source_points)
        self._freeze.setText(", ".join(settings.freeze))
        self._automatic.setChecked(settings.lattice == "auto")
        if settings.lattice != "auto":
            for (box, _), count in zip(self._sizes, settings.lattice, strict=True):
                box.setValue(count)

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
        self._part.setText(f"<b>{part}</b> {', '.join(faces)}" if part else "<i>pick faces in the 3D view</i>")

    def say(self, sentence: str) -> None:
        """Show a sentence below the settings."""
        self._message.setText(sentence)
        self._message.setVisible(bool(sentence))

    def show_figures(self, figures: tuple | None, sentence: str, after: Any = None, limit: float = 1.0) -> None:
        """Show (mean, p95 before; mean, p95 after; coverage), or a sentence instead."""
        self._legend.setVisible(figures is not None)
        self._figures.setVisible(figures is not None)
        self.say(sentence)
        if figures is None:
            return
        rows = "".join(f"<tr><td>{name}</td><td align='right'>&nbsp; {mean:.3f} mm</td>"
                       f"<td align='right'>&nbsp; {p95:.3f} mm</td></tr>"
                       for name, mean, p95 in (("before", *figures[:2]), ("after", *figures[2:4])))
        self._figures.setText(f"<table><tr><td>Deviation</td><td align='right'>mean</td>"
                              f"<td align='right'>95 %</td></tr>"
                              f"{rows}</table>Coverage {100 * figures[4]:.0f} %")
        self._legend.show_deviations(after, limit)

    def set_busy(self, busy: bool) -> None:
        """Lock the settings while the part is being computed."""
        self.busy = busy
        self._progress.setVisible(busy)
        self._doing.setVisible(busy)
        for widget in self.findChildren(QtWidgets.QWidget):
            if isinstance(widget, (QtWidgets.QAbstractSpinBox, QtWidgets.QComboBox, QtWidgets.QAbstractButton,
                                   QtWidgets.QSlider, QtWidgets.QLineEdit)):
                widget.setEnabled(not busy)
        if not busy:
            self._enable()

    def show_progress(self, text: str) -> None:
        """Say what is being done."""
        self._doing.setText(f"{text} …")


def _move(slider: Any, value: int) -> None:
    """Let a slider follow its box without answering back."""
    slider.blockSignals(True)
    slider.setValue(value)
    slider.blockSignals(False)
