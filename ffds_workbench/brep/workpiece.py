# SPDX-License-Identifier: LGPL-2.1-or-later
"""A Part shape read once: its faces as arrays, for registration and for the rebuild.

Faces are numbered as FreeCAD numbers them; index 5 is "Face6". Everything is in mm and world coordinates.
"""
from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import Part

from ..errors import InputError
from ..registration.arrays import Array
from ..registration.face_geometry import FaceGeometry
from ..registration.splines import SplineSurface
from .face_parameters import closed_form, own_knots, parameter_box, trims
from .surface_fit import ParameterBox, approximate
from .topology import Topology
from .topology import read as read_topology

SURFACE_TOLERANCE = 4e-6
"""Largest distance in mm of a face's control lattice from the face's own surface (unit: far below the noise of
scanners)."""


class WorkpieceFace:
    """One face: the FreeCAD face and, read on demand, its parameter box, trims and control lattice."""

    def __init__(self, index: int, face: Part.Face) -> None:
        self.index = index
        self.name = f"Face{index + 1}"
        self.face = face
        self.own_surface = face.Surface

    @cached_property
    def _trims(self) -> tuple[tuple[Array, ...], bool]:
        polylines, curved = trims(self.face)
        if not polylines:
            raise InputError(f"{self.name} has no boundary in its (u, v) parameters: repair the shape first.")
        extent = np.ptp(np.concatenate(polylines), axis=0)
        if not (np.isfinite(extent).all() and extent.all()):
            raise InputError(f"{self.name} has no area in its (u, v) parameters: repair the shape first.")
        return polylines, curved

    @property
    def trims(self) -> tuple[Array, ...]:
        """Closed polylines in (u, v), each (k, 2)."""
        return self._trims[0]

    @cached_property
    def box(self) -> ParameterBox:
        return parameter_box(self.face, *self._trims)

    @cached_property
    def own_knots(self) -> tuple[Array, Array]:
        """Interior knots that the surface's own form asks for."""
        return own_knots(self.own_surface, self.box)

    def on_grid(self, u: Array, v: Array) -> Array:
        """The face's own, exact surface on the grid u × v: (len(u), len(v), 3)."""
        if self._simple is not None:
            return self._simple(u[:, None], v)
        value = self.own_surface.value
        points = np.array([tuple(value(a, b)) for a in u.tolist() for b in v.tolist()])
        return points.reshape(len(u), len(v), 3)

    def at(self, uv: Array) -> Array:
        """The face's own, exact surface at scattered parameters: (n, 2) to (n, 3)."""
        if self._simple is not None:
            return self._simple(uv[:, 0], uv[:, 1])
        value = self.own_surface.value
        return np.array([tuple(value(a, b)) for a, b in uv.tolist()]).reshape(-1, 3)

    @cached_property
    def _simple(self) -> Callable[[Array, Array], Array] | None:
        return closed_form(self.own_surface)

    @cached_property
    def surface(self) -> SplineSurface:
        """The control lattice of the face's own surface, in its own (u, v)."""
        return approximate(self.on_grid, self.box, *self.own_knots, SURFACE_TOLERANCE)

    @cached_property
    def geometry(self) -> FaceGeometry:
        """The face as registration sees it."""
        outward = -1 if self.face.Orientation == "Reversed" else 1
        return FaceGeometry(self.name, type(self.own_surface).__name__, self.surface, self.trims, outward)


class Workpiece:
    """A shape and its faces. Use ``read`` to make one."""

    def __init__(self, shape: Part.Shape) -> None:
        self.shape = shape
        self.faces = tuple(WorkpieceFace(i, face) for i, face in enumerate(shape.Faces))

    @cached_property
    def edges(self) -> tuple[Part.Edge, ...]:
        return tuple(self.shape.Edges)

    @cached_property
    def topology(self) -> Topology:
        """Which face, edge and vertex touches which, by index."""
        return read_topology(self.shape)

    def geometry(self, index: int) -> FaceGeometry:
        """Face ``index`` (0-based) as registration sees it."""
        return self.faces[index].geometry

    def index(self, name: str) -> int:
        """0-based index of "FaceN".

        Raises
        ------
        InputError
            The shape has no face of that name.
        """
        for face in self.faces:
            if face.name == name:
                return face.index
        raise InputError(f"There is no {name}: the shape has Face1 to Face{len(self.faces)}.")


def read(shape: Part.Shape) -> Workpiece:
    """Read a shape.

    Raises
    ------
    InputError
        The shape is null, or has no faces.
    """
    if shape is None or shape.isNull():
        raise InputError("The shape is empty: select or load a part with faces.")
    if not shape.Faces:
        raise InputError("The shape has no faces: FFDS deforms faces of a solid, shell or compound.")
    return Workpiece(shape)
