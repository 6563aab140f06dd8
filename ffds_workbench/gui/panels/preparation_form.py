# SPDX-License-Identifier: LGPL-2.1-or-later
"""The widgets of the preparation panel: which steps are wanted, and what came of them."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..qt import QtCore, QtWidgets
from ..translating import tr
from ..widgets import Form, ProgressBar, choice, folded, length, named, warning, wrapped

_FARTHEST = 1e7
"""Largest length and coordinate that can be entered, mm."""
STAYS, GOES = 0x8AE0FFFF, 0xE6194BFF
"""Colours of the points that a step leaves, and of those that it takes away."""


class PreparationForm(Form):
    """Emits ``changed`` when a step changes, ``looked_at`` when another one shall be shown.

    Parameters
    ----------
    labels : of the scans
    part : its label, "" for none
    points, spacing : of the scans, (n, 3) in mm, and their distance in mm: what the fields start from
    eye : tells where the user looks from, x, y, z in mm; asked when normals are wanted
    """

    changed = QtCore.Signal()
    looked_at = QtCore.Signal()

    def __init__(self, labels: Sequence[str], part: str, points: NDArray[np.float64], spacing: float,
                 eye: Callable[[], tuple[float, ...]]) -> None:
        super().__init__()
        self.setWindowTitle(tr("Prepare scan"))
        self._eye, self._view = eye, (0.0, 0.0, 0.0)
        self._make_steps(labels, part, points, spacing)
        self._make_findings()
        self._lay_out(labels)
        self._normals.toggled.connect(self._look)
        for box in self._boxes:
            box.toggled.connect(lambda _: self.changed.emit())
        for field in (self._distance, self._spacing, *self._corners):
            field.valueChanged.connect(lambda _: self.changed.emit())
        for chosen in (self._step, self._state):
            chosen.currentIndexChanged.connect(lambda _: self.looked_at.emit())

    def _make_steps(self, labels: Sequence[str], part: str, points: NDArray[np.float64], spacing: float) -> None:
        self._fuse = _box(tr("Match the scans with each other"), "FfdsFuse", tr(
            "They lie about where they belong; a loop round the part is closed"), len(labels) > 1)
        self._near = _box(tr("Only near {part}").format(part=part), "FfdsNear", tr(
            "Keep what is no farther from the part than this; the scan must lie on it"))
        self._in_box = _box(tr("Only in a box"), "FfdsBox", tr("Keep what is between these corners"))
        self._plane = _box(tr("Remove the table"), "FfdsPlane", tr(
            "The plane that the part stands on, and what is behind it"))
        self._clutter = _box(tr("Remove clutter"), "FfdsClutter", tr("What stands apart from the part"))
        self._outliers = _box(tr("Remove single points"), "FfdsOutliers", tr(
            "Points much farther from others than most"))
        self._normals = _box(tr("Normals, towards the eye"), "FfdsNormals", tr(
            "Look at the scan from where the sensor stood, then press this: it tells the skins of a sheet apart"))
        self._thin = _box(tr("Thin"), "FfdsThin", tr("Average the points in cubes of this edge"))
        self._boxes = (self._fuse, self._near, self._in_box, self._plane, self._clutter, self._outliers, self._normals,
                       self._thin)
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        self._distance = length("FfdsDistance", float(f"{0.05 * size:.1g}"), _FARTHEST, self._near.toolTip())
        self._spacing = length("FfdsThinSpacing", float(f"{2.0 * spacing:.2g}") or 1.0, _FARTHEST, self._thin.toolTip())
        self._corners = [length(f"FfdsBox{axis}{end}", 0.0, _FARTHEST, self._in_box.toolTip())
                         for end in "01" for axis in "XYZ"]
        bounds = *np.floor(points.min(axis=0)), *np.ceil(points.max(axis=0))
        for field, value in zip(self._corners, bounds, strict=True):
            field.setRange(-_FARTHEST, _FARTHEST)
            field.setSingleStep(max(float(f"{0.01 * size:.1g}"), 1e-3))
            field.setValue(value)
        self._fuse.setVisible(len(labels) > 1)
        self._near.setVisible(bool(part))
        self._distance.setVisible(bool(part))

    def _make_findings(self) -> None:
        self._step = choice("FfdsLookAt", [(tr("All steps"), "")], tr("The step that the view shows"))
        self._state = choice("FfdsState", [(tr("Before and after"), "both"), (tr("Before"), "before"),
                                           (tr("After"), "after")], tr("Which of its points the view shows"))
        self._figures, self._message = wrapped("FfdsFigures"), warning("FfdsMessageLabel")
        self._figures.setTextFormat(QtCore.Qt.RichText)
        self._progress = named(ProgressBar(), "FfdsProgressBar")
        self._progress.setVisible(False)

    def _lay_out(self, labels: Sequence[str]) -> None:
        title = wrapped("FfdsScans")
        title.setText(", ".join(labels))
        rows = QtWidgets.QGridLayout()
        rows.addWidget(self._near, 0, 0)
        rows.addWidget(self._distance, 0, 1)
        for row, box in enumerate((self._plane, self._clutter, self._outliers, self._normals), 1):
            rows.addWidget(box, row, 0, 1, 2)
        rows.addWidget(self._thin, 5, 0)
        rows.addWidget(self._spacing, 5, 1)
        corners = QtWidgets.QWidget()
        grid = QtWidgets.QGridLayout(corners)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.addWidget(self._in_box, 0, 0, 1, 2)
        for number, field in enumerate(self._corners):
            grid.addWidget(field, 1 + number % 3, number // 3)
        looking = QtWidgets.QFormLayout()
        looking.addRow(tr("Look at"), self._step)
        looking.addRow(tr("Show"), self._state)
        column = QtWidgets.QVBoxLayout(self)
        column.addWidget(title)
        column.addWidget(self._fuse)
        column.addLayout(rows)
        column.addWidget(folded(tr("A box"), "FfdsBoxFold", corners))
        column.addLayout(looking)
        for widget in (self._figures, self._message, self._progress):
            column.addWidget(widget)

    def _look(self, asked: bool) -> None:
        if asked:
            self._view = tuple(round(value, 3) for value in self._eye())

    def settings(self) -> dict[str, Any]:
        """The steps that are wanted, as `prepare_scan` takes them; empty for none."""
        wanted: dict[str, Any] = {name: True for name, box in (
            ("fuse", self._fuse), ("remove_plane", self._plane), ("remove_clutter", self._clutter),
            ("remove_outliers", self._outliers), ("normals", self._normals)) if box.isChecked()}
        if self._near.isChecked():
            wanted["near"] = self._distance.value()
        if self._in_box.isChecked():
            wanted["box"] = tuple(field.value() for field in self._corners)
        if self._normals.isChecked():
            wanted["view"] = self._view
        if self._thin.isChecked():
            wanted["spacing"] = self._spacing.value()
        return wanted

    @property
    def shown(self) -> tuple[str, str]:
        """The step that is looked at, "" for all of them, and "before", "after" or "both"."""
        return self._step.currentData(), self._state.currentData()

    def tell(self, text: str) -> None:
        """Say what was found, as rich text, and nothing else."""
        self._figures.setText(text)
        self._message.setText("")

    def refuse(self, sentence: str) -> None:
        """Say what is wrong."""
        self._message.setText(sentence)

    def offer(self, steps: Sequence[tuple[str, str]]) -> None:
        """The steps that can be looked at: (title, name)."""
        chosen = self._step.currentData()
        self._step.blockSignals(True)
        self._step.clear()
        for title, name in ((tr("All steps"), ""), *steps):
            self._step.addItem(title, name)
        self._step.setCurrentIndex(max(self._step.findData(chosen), 0))
        self._step.blockSignals(False)

    def show_progress(self, busy: bool) -> None:
        """Show or hide the bar."""
        if busy and not self._progress.isVisible():
            self._progress.setValue(0)
        self._progress.setVisible(busy)

    def step_progress(self) -> None:
        """Something was finished."""
        self._progress.step()


def titles() -> dict[str, str]:
    """What the steps are called in the window."""
    return {"fuse": tr("matched"), "box": tr("box"), "near": tr("near the part"), "plane": tr("table"),
            "clutter": tr("clutter"), "outliers": tr("single points"), "normals": tr("normals"),
            "spacing": tr("thinned")}


def _box(text: str, name: str, tip: str, checked: bool = False) -> Any:
    box = named(QtWidgets.QCheckBox(text), name, tip)
    box.setChecked(checked)
    return box
