# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panel of the deviation map: colours over the scan or the part, legend, histogram, value under the cursor."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui
import numpy as np
from numpy.typing import NDArray

from ... import api
from ...brep import workpiece
from ...brep.model_files import model_file
from ...brep.simulated_scan import edge_points
from ...objects.as_built import is_as_built
from ...objects.scans import scan_points
from ...registration.uv_raster import make_raster
from ...report.maps.coloured_faces import corner_values, corners, surface_grid
from ...report.maps.lone_points import lone_points
from ...report.statistics import statistics
from .. import running
from ..preferences import preferences
from ..qt import QtWidgets, number_of
from ..selection import parts_shown, scans_of
from ..translating import tr
from ..view3d.colours import PASS_FAIL, SMOOTH, good_limit, packed_colours
from ..view3d.overlay import Overlay, foremost, lines_node, mesh_node, points_node
from ..widgets import Form, choice, length, named, wrapped
from .closing import TaskPanel
from .legend import Legend

Array = NDArray[np.float64]

_STEPS = (7, 13)
"""Of a stepped scale: odd, so that what is near zero has one colour."""

_PART_TRANSPARENCY = 0.6
"""Of the parts while the scan carries the colours."""


def open_panel(part: Any, scan: Any) -> None:
    """Measure, and show the panel (main thread); refusals are said."""
    with running.telling():
        as_built = is_as_built(part)
        states = [(tr("As built"), part), (tr("Nominal"), part.Source)] if as_built else [(tr("Part"), part)]
        points = scan_points(scan)
        models = [(name, model_file.from_object(item)) for name, item in states]

        def measure(progress: Any) -> tuple[Any, Any]:
            found = [(name, api.deviation(model, points, progress)) for name, model in models]
            return found, lone_points(points)

        found, lone = running.in_background(tr("Measuring the deviation"), measure)
        Gui.Control.showDialog(DeviationPanel(part, scan, found, lone))


class DeviationPanel(TaskPanel):
    """FreeCAD's task panel. ``found`` holds (name, `api.Deviation`) of each state of the part, ``lone`` which points of
    the scan stand alone."""

    def __init__(self, part: Any, scan: Any, found: list[tuple[str, api.Deviation]], lone: NDArray[np.bool_]) -> None:
        self._lone = lone
        self._part, self._scan, self._found = part, scan, dict(found)
        self._meshes: dict[str, list[tuple[Array, Array, Array]]] = {}
        self.form = Form()
        self.form.setWindowTitle(tr("Deviation"))
        self._state = choice("FfdsState", [(name, name) for name, _ in found],
                             tr("Before or after the deformation"))
        self._on = choice("FfdsOn", [(tr("the scan"), "scan"), (tr("the part"), "part")],
                          tr("What carries the colours"))
        limit = max(good_limit(_deviations(item)) for _, item in found)
        self._limit = length("FfdsLimit", limit, 1e4, tr("The colour scale ends here, on both sides"))
        self._tolerance = length("FfdsTolerance", preferences().tolerance, 1e4,
                                 tr("Deviations up to this are shown in one green; 0: none"))
        self._tolerance.setSingleStep(limit / 20)
        self._steps = choice("FfdsSteps", [
            (tr("smooth"), SMOOTH), *((tr("{count} steps").format(count=count), count) for count in _STEPS),
            (tr("pass or fail"), PASS_FAIL)], tr(
                "One colour runs into the next, or a few with borders between them, or nothing but within the "
                "tolerance, above and below it"))
        self._legend = named(Legend(), "FfdsLegend")
        self._figures, self._cursor = wrapped("FfdsFigures"), wrapped("FfdsCursor")
        column = QtWidgets.QVBoxLayout(self.form)
        rows = QtWidgets.QFormLayout()
        for label, widget in ((tr("State"), self._state), (tr("Colours on"), self._on), (tr("Range ±"), self._limit),
                              (tr("Tolerance ±"), self._tolerance), (tr("Colours"), self._steps)):
            rows.addRow(label, widget)
        column.addLayout(rows)
        for widget in (self._figures, self._legend, self._cursor):
            column.addWidget(widget)
        self._steps.currentIndexChanged.connect(self._demand_tolerance)
        for widget in (self._state, self._on, self._steps):
            widget.currentIndexChanged.connect(self._show)
        for widget in (self._limit, self._tolerance):
            widget.valueChanged.connect(self._show)
        self._document = scan.Document.Name
        self._view = Gui.getDocument(self._document).ActiveView
        self._overlay = Overlay(self._document)
        self._shown = [*parts_shown(scan.Document), *scans_of(scan.Document)]
        self._callback = self._view.addEventCallback("SoLocation2Event", self._moved)
        Gui.Selection.clearSelection()  # what is selected shines through, in a green that would read as good
        self._watch(self._document)
        self._show()

    def _show(self, *_: Any) -> None:
        item = self._found[self._state.currentData()]
        index, values = np.concatenate([face.points for face in item.faces]), _deviations(item)
        kept = ~self._lone[index]
        values = self._values = values[kept]
        self._points = item.scan.points[index[kept]]
        scale = max(self._limit.value(), 1e-6), self._tolerance.value(), self._steps.currentData()
        if self._on.currentData() == "scan":
            nodes = [points_node(self._points, packed_colours(values, *scale))]
        else:
            nodes = [mesh_node(points, triangles, packed_colours(means, *scale), over=False)
                     for points, triangles, means in self._coloured_faces(item)]
            nodes.append(lines_node(list(edge_points(item.model.shape, 40))))
        self._overlay.show(nodes)
        self._overlay.plain()
        self._overlay.pick_through(self._shown)  # what the mouse points at would turn yellow, face by face
        if self._on.currentData() == "scan":  # else points inside the material are hidden, the others are not
            self._overlay.fade([item for item in self._shown if item is not self._scan], _PART_TRANSPARENCY)
        self._overlay.cover(self._scan, *[self._part] if self._on.currentData() == "part" else [])
        self._legend.show_deviations(values, *scale)
        self._figures.setText(_figures_text(values, scale[1], len(kept) - len(values)))
        self._cursor.setText(tr("Point at the part to read the deviation there."))

    def _coloured_faces(self, item: api.Deviation) -> list[tuple[Array, Array, Array]]:
        name = self._state.currentData()
        if name not in self._meshes:
            part = workpiece.read(item.model.shape)
            self._meshes[name] = []
            for index, face in enumerate(item.faces):
                geometry = part.geometry(index)
                raster = make_raster(geometry)
                kept = ~self._lone[face.points]
                means = corner_values(raster, item.scan.points[face.points[kept]], face.deviations[kept])
                points = geometry.surface.on_grid(*corners(raster)).reshape(-1, 3)
                self._meshes[name].append((points, surface_grid(raster), means))
        return self._meshes[name]

    def _demand_tolerance(self, *_: Any) -> None:
        """Pass or fail needs a tolerance: a fifth of the range where none is set."""
        if self._steps.currentData() == PASS_FAIL and not self._tolerance.value():
            self._tolerance.setValue(self._limit.value() / 5)

    def _moved(self, event: dict) -> None:
        """The mouse moved in the view: read the deviation of the foremost scan point under it."""
        index = foremost(self._view, tuple(event["Position"]), self._points)
        if index is not None:
            x, y, z = self._points[index]
            self._cursor.setText(tr("<b>{value} mm</b> at {place}").format(
                value=f"{self._values[index]:+.3f}", place=f"{x:.1f}, {y:.1f}, {z:.1f}"))

    def _clean_up(self) -> None:
        self._overlay.remove()
        if self._document in FreeCAD.listDocuments():  # a view that was closed crashes when it is asked
            self._view.removeEventCallback("SoLocation2Event", self._callback)

    def getStandardButtons(self) -> int:
        """Close."""
        return number_of(QtWidgets.QDialogButtonBox.Close)


def _deviations(item: api.Deviation) -> Array:
    return np.concatenate([face.deviations for face in item.faces])


def _figures_text(values: Array, tolerance: float, lone: int) -> str:
    found = statistics(values)
    block = dict.fromkeys(("mean", "p95", "max", "signed_mean"), 0.0) if found is None else found.as_dict()
    text = tr("{count} points: mean {mean} mm, 95 % below {p95} mm, largest {max} mm, signed mean {signed} mm").format(
        count=len(values), signed=f"{block['signed_mean']:+.3f}",
        **{name: f"{block[name]:.3f}" for name in ("mean", "p95", "max")})
    if tolerance > 0:
        share = f"{100 * np.mean(np.abs(values) <= tolerance):.1f}"
        text += "; " + tr("{share} % within the tolerance").format(share=share)
    if lone:
        text += "; " + tr("{count} lone points left out").format(count=lone)
    return text.replace(" mm", "\u00a0mm").replace(" %", "\u00a0%")
