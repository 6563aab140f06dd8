# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_SimulateScan: a scan of the selected part by the virtual sensor."""
from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ...qt import QtWidgets, execute
from ...running import call, name_of
from ...selection import chosen
from ...translating import tr
from ...widgets import choice, length, named, spin
from ..command import Command, one_part


class SimulateScan(Command):
    """Asks for the sensor and scans."""

    NAME = "FFDS_SimulateScan"
    MENU = "Simulate a scan…"
    TIP = "Scan the selected part with a virtual sensor: from the side that is seen now, or from all around"
    HELP = ("Scans the selected part with a virtual sensor: points with noise of the side that is seen now, or of "
            "all sides.")
    KEYS = "F, S"
    NEEDS = "Select one part first."

    def active(self) -> bool:
        """With one part selected."""
        return one_part(chosen()) is not None

    def run(self) -> None:
        """Ask, and scan in one undo step."""
        part = one_part(chosen())
        asked = SensorDialog(part.Shape.BoundBox.DiagonalLength)
        if not execute(asked):
            return
        call(part.Document, "Simulate a scan", f"simulate_scan({name_of(part)}, {asked.arguments()})")


class SensorDialog(QtWidgets.QDialog):
    """Spacing, noise and the side to look from."""

    def __init__(self, diagonal: float) -> None:
        super().__init__(Gui.getMainWindow())
        self.setObjectName("FfdsSensor")
        self.setWindowTitle(tr("Simulate a scan"))
        self._side = choice("FfdsSide", [(tr("The side seen now"), "view"), (tr("All around"), "all")],
                            tr("Where the sensor stands"))
        self._spacing = length("FfdsSpacing", max(0.1, round(diagonal / 300, 1)), 1000.0,
                               tr("Mean distance of the points"))
        self._noise = length("FfdsNoise", 0.05, 100.0, tr("Standard deviation along the line of sight"))
        self._seed = spin("FfdsSeed", 0, 0, 999999, tr("The same seed gives the same scan"))
        form = QtWidgets.QFormLayout(self)
        for label, widget in ((tr("Sensor sees"), self._side), (tr("Spacing"), self._spacing),
                              (tr("Noise"), self._noise), (tr("Seed"), self._seed)):
            form.addRow(label, widget)
        buttons = named(QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel),
                        "FfdsSensorButtons")
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form.addRow(buttons)

    def arguments(self) -> str:
        """The settings as the arguments of a recorded line."""
        return (f"spacing={self._spacing.value():g}, noise={self._noise.value():g}, views={self._views()}, "
                f"seed={self._seed.value()}")

    def _views(self) -> list[Any]:
        if self._side.currentData() == "all":
            return []
        towards = -Gui.ActiveDocument.ActiveView.getViewDirection()
        return [tuple(round(value, 4) for value in towards)]
