# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cross-section of a bent sheet: a chain of straight and arc pieces, and what happens when its bends open.

A point of the sheet has the coordinates s, along the neutral line, and n, across the thickness. Opening a bend keeps
both: lengths of the neutral line and the thickness stay, which is what springback does.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Piece:
    """A piece of the neutral line: its length in mm and by how much it turns, in rad (positive to the left)."""

    length: float
    turn: float = 0.0


@dataclass(frozen=True)
class Profile:
    """A neutral line in the (x, z) plane that starts at ``start`` in the direction ``heading``; ``thickness`` in mm."""

    pieces: tuple[Piece, ...]
    thickness: float
    start: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0

    def frames(self) -> list[tuple[Array, float]]:
        """Where each piece begins: point (2,) and heading in rad; one more for the end."""
        point, heading = np.array(self.start, dtype=float), self.heading
        found = [(point, heading)]
        for piece in self.pieces:
            point = point + _along(piece, np.array([piece.length]), np.zeros(1), heading)[0]
            heading += piece.turn
            found.append((point, heading))
        return found

    def point(self, s: Array, n: Array, index: NDArray[np.intp]) -> Array:
        """Points (k, 2) at the distance s (k,) from the start of piece ``index`` (k,), n (k,) across."""
        result = np.empty((len(s), 2))
        for i, (piece, (start, heading)) in enumerate(zip(self.pieces, self.frames(), strict=False)):
            mine = index == i
            result[mine] = start + _along(piece, s[mine], n[mine], heading)
        return result

    def coordinates(self, points: Array) -> tuple[Array, Array, NDArray[np.intp]]:
        """s from the start of its piece, n and the piece of points (k, 2) in the sheet."""
        best = np.full(len(points), np.inf)
        s, n, index = np.zeros(len(points)), np.zeros(len(points)), np.zeros(len(points), dtype=np.intp)
        for i, (piece, (start, heading)) in enumerate(zip(self.pieces, self.frames(), strict=False)):
            a, b = _unplace(piece, points - start, heading)
            first, last = i == 0, i == len(self.pieces) - 1
            outside = np.maximum(0.0, -a if not first else 0.0) + np.maximum(0.0, a - piece.length if not last else 0.0)
            outside = outside + np.maximum(0.0, np.abs(b) - 0.5 * self.thickness)
            closer = outside < best - 1e-9
            best[closer], s[closer], n[closer], index[closer] = outside[closer], a[closer], b[closer], i
        return s, n, index

    def opened(self, factor: float, held: int) -> Profile:
        """The profile with every bend's angle multiplied by ``factor``, lengths unchanged; piece ``held`` stays put."""
        pieces = tuple(Piece(piece.length, piece.turn * factor) for piece in self.pieces)
        loose = Profile(pieces, self.thickness, self.start, self.heading)
        (moved, moved_heading), (point, heading) = loose.frames()[held], self.frames()[held]
        turn = heading - moved_heading
        tangent, left = _frame(turn)
        arm = np.array(self.start) - moved
        start = point + arm[0] * tangent + arm[1] * left
        return Profile(pieces, self.thickness, (float(start[0]), float(start[1])), self.heading + turn)


def _along(piece: Piece, s: Array, n: Array, heading: float) -> Array:
    """Offsets (k, 2) from the start of the piece to s along and n to the left."""
    tangent, left = _frame(heading)
    if piece.turn == 0.0:
        return s[:, None] * tangent + n[:, None] * left
    radius = piece.length / piece.turn
    angle = s / radius
    return (radius - n)[:, None] * (np.sin(angle)[:, None] * tangent - np.cos(angle)[:, None] * left) + radius * left


def _unplace(piece: Piece, offsets: Array, heading: float) -> tuple[Array, Array]:
    """s and n of offsets (k, 2) from the start of the piece."""
    tangent, left = _frame(heading)
    x, y = offsets @ tangent, offsets @ left
    if piece.turn == 0.0:
        return x, y
    radius = piece.length / piece.turn
    side = np.sign(radius)
    angle = np.arctan2(side * x, side * (radius - y))
    return radius * angle, radius - side * np.hypot(x, radius - y)


def _frame(heading: float) -> tuple[Array, Array]:
    c, s = np.cos(heading), np.sin(heading)
    return np.array([c, s]), np.array([-s, c])
