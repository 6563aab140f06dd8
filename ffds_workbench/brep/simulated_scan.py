# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans of a Part shape by the virtual sensor, and their ground truth; points spread over a shape."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import Part

from ..errors import InputError
from ..registration.arrays import Array
from ..scan.sensor import Scene, SensorSettings, SimulatedScan, Truth, make_truth, simulate
from ..scan.sensor.target import Displace
from ..scan.sensor.truth import EDGE_SAMPLES
from . import workpiece

_SURFACE_SAMPLES = 20_000
"""Points that are spread over a shape (theory: a share of them is known to 0.4 %)."""
_SAG = 0.002
"""Largest distance of the triangles from the shape, over its size (unit: far below what is taken to lie on it)."""


@dataclass(frozen=True)
class Simulation:
    """A simulated scan and the truth behind it."""

    scan: SimulatedScan
    truth: Truth


def scene_of(shape: Part.Shape, displace: Mapping[int, Displace] | None = None) -> Scene:
    """What the sensor sees of a shape whose faces (by index) may be displaced.

    Raises
    ------
    InputError : the shape is empty or has no faces
    """
    part = workpiece.read(shape)
    return Scene([part.geometry(index) for index in range(len(part.faces))], displace)


def simulate_shape(shape: Part.Shape, settings: SensorSettings) -> Simulation:
    """Scan a shape as it is.

    Raises
    ------
    InputError : the shape is empty or has no faces
    RefusedError : no view sees anything of it
    """
    target = scene_of(shape)
    edges = edge_points(shape)
    return Simulation(simulate(target, settings), make_truth(target, settings, edges, edges))


def edge_points(shape: Part.Shape, count: int = EDGE_SAMPLES) -> Array:
    """Points along every edge in the shape's order, (edges, count, 3); a degenerate edge is its vertex."""
    lines = []
    for edge in shape.Edges:
        if edge.Degenerated:
            lines.append([tuple(edge.Vertexes[0].Point)] * count)
        else:
            first, last = edge.ParameterRange
            lines.append([tuple(edge.valueAt(t)) for t in np.linspace(first, last, count)])
    return np.array(lines).reshape(-1, count, 3)


def surface_samples(shape: Part.Shape) -> tuple[Array, Array]:
    """Points (n, 3) in mm on the triangles of a shape, as many on each as it is large, and unit normals (n, 3).

    Raises
    ------
    InputError : no face has triangles
    """
    vertices, triangles = shape.copy().tessellate(_SAG * shape.BoundBox.DiagonalLength)  # the shape keeps no mesh
    if not triangles:
        raise InputError("The faces of the model cannot be meshed, as where they have no bounds: repair the model.")
    a, b, c = np.array([tuple(vertex) for vertex in vertices])[np.array(triangles)].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    random = np.random.default_rng(0)
    chosen = np.searchsorted(np.cumsum(areas) / areas.sum(), random.random(_SURFACE_SAMPLES)).clip(max=len(areas) - 1)
    weights = random.random((_SURFACE_SAMPLES, 2))
    weights = np.where(weights.sum(axis=1, keepdims=True) > 1.0, 1.0 - weights, weights)
    points = a[chosen] + weights[:, :1] * (b - a)[chosen] + weights[:, 1:] * (c - a)[chosen]
    return points, normals[chosen] / np.maximum(areas[chosen, None], 1e-300)
