# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes lattices exactly where a surface meets itself: one displacement at a pole, the same on both sides of a seam.

The solve leaves gaps of about 1e-3 mm there, which no correction from neighbouring faces can close.
"""
from __future__ import annotations

import numpy as np

from ...arrays import Array
from .lattices import FaceLattice, Lattices
from .part import JointPart, SharedEdge

_ON_SIDE = 1e-6
"""Of the range: parameters nearer to a side of it lie on it (theory: far above rounding)."""


def close_seams(part: JointPart, lattices: Lattices, control_points: Array) -> Array:
    """Control points (controls, 3) with poles and seams closed; only the outermost rows change.

    Parameters
    ----------
    part : the faces, edges and solids
    lattices : of all faces
    control_points : (controls, 3) of the displacement in mm
    """
    result = control_points.copy()
    for edge in part.edges:
        if edge.degenerate:
            for face, uv in zip(edge.faces, edge.uv, strict=True):
                _give_common_displacement(result, lattices.faces[face], [_side(lattices.faces[face], uv)], pole=True)
        elif edge.is_seam:
            lattice = lattices.faces[edge.faces[0]]
            sides = [_side(lattice, uv) for uv in edge.uv]
            if _opposite(lattice, edge, sides):
                _give_common_displacement(result, lattice, sides, pole=False)
    return result


def _side(lattice: FaceLattice, uv: Array) -> tuple[int, int] | None:
    """(axis, end) of the side of the parameter box that a polyline (m, 2) runs along: end 0 or −1."""
    place = (uv - lattice.corner) / (lattice.step * lattice.spans)
    for axis in range(2):
        for end, value in ((0, 0.0), (-1, 1.0)):
            if np.abs(place[:, axis] - value).max() < _ON_SIDE:
                return axis, end
    return None


def _opposite(lattice: FaceLattice, edge: SharedEdge, sides: list[tuple[int, int] | None]) -> bool:
    first, second = sides
    return (first is not None and second is not None and first[0] == second[0] and first[1] != second[1]
            and not lattice.periodic[first[0]])


def _give_common_displacement(control_points: Array, lattice: FaceLattice, sides: list[tuple[int, int] | None],
                              pole: bool) -> None:
    """Give all sides the mean of their displacements (at a pole one for the whole side), in place.

    The value at the end of a uniform cubic is (c₀ + 4 c₁ + c₂)/6; the outermost row c₀ takes what is missing.
    """
    mu, mv = lattice.shape
    grid = control_points[lattice.first_control : lattice.first_control + mu * mv].reshape(mu, mv, 3)
    found = [side for side in sides if side is not None and not lattice.periodic[side[0]]]
    if not found:
        return
    rows = [np.moveaxis(grid, axis, 0)[[0, 1, 2] if end == 0 else [-1, -2, -3]] for axis, end in found]
    values = [(row[0] + 4 * row[1] + row[2]) / 6 for row in rows]
    wanted = np.mean(values, axis=0)
    if pole:
        wanted = np.broadcast_to(wanted.mean(axis=0), wanted.shape)
    for (axis, end), value in zip(found, values, strict=True):
        np.moveaxis(grid, axis, 0)[end] += 6 * (wanted - value)
