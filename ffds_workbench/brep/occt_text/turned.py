# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reversed geometry records of a BREP text: planes, B-spline surfaces, their pcurves, and curves.

The parameter k becomes a + b − k, so that every range stays what it was.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...registration.arrays import Array
from .curves import Conic, Curve, Line, Spline, mapped, numbers_text, print_curve
from .pcurves import allowed, cubic

_PLANE, _SPLINE = "1", "9"
_ROUND = ("2", "3")


@dataclass(frozen=True)
class SurfaceDirection:
    """One direction of a B-spline surface: knots with their multiplicities."""

    rational: str
    periodic: str
    degree: int
    knots: Array
    multiplicities: tuple[int, ...]

    @property
    def both(self) -> float:
        """First and last knot together: k becomes this − k where the direction is turned."""
        return float(self.knots[0] + self.knots[-1])

    def text(self) -> str:
        """Pairs of knot and multiplicity."""
        return " ".join(f"{knot!r} {count}" for knot, count in
                        zip(self.knots.tolist(), self.multiplicities, strict=True))


@dataclass(frozen=True)
class Turned:
    """What became of a surface's (u, v).

    Attributes
    ----------
    matrix, shift : (2, 2) and (2,), from the old (u, v) to the new: x -> matrix·x + shift
    """

    matrix: Array
    shift: Array

    @property
    def reversed(self) -> bool:
        """Whether the normal points to the other side now."""
        return bool(np.linalg.det(self.matrix) < 0)

    def pcurve(self, curve: Curve, first: float, last: float) -> str:
        """The record of a pcurve of the old surface on the new one."""
        if isinstance(curve, Line | Conic | Spline):
            new = allowed(mapped(curve, self.matrix, self.shift), first, last)
        else:
            new = cubic(lambda t: curve(t) @ self.matrix.T + self.shift, first, last, curve.breaks())
        return str(new.record)


@dataclass(frozen=True)
class PlaneRecord(Turned):
    """A plane: rows of ``frame`` (4, 3) are origin, normal, x and y."""

    frame: Array

    def turned(self) -> PlaneRecord:
        """With v the other way."""
        sign = np.array([1.0, -1.0])
        frame = self.frame * np.array([[1.0, -1.0, 1.0, -1.0]]).T
        return PlaneRecord(sign[:, None] * self.matrix, sign * self.shift, frame)

    def text(self) -> str:
        """The record."""
        return f"{_PLANE} {numbers_text(self.frame)}"


@dataclass(frozen=True)
class SplineRecord(Turned):
    """A B-spline surface as OCCT has it: poles (n_u, n_v, 3 or 4), with their weights."""

    sides: tuple[SurfaceDirection, SurfaceDirection]
    poles: Array

    def exchanged(self) -> SplineRecord:
        """With u and v exchanged."""
        return SplineRecord(self.matrix[::-1], self.shift[::-1], self.sides[::-1], self.poles.swapaxes(0, 1))

    def turned(self, axis: int = 0) -> SplineRecord:
        """With u (axis 0) or v (axis 1) the other way."""
        side, poles = self.sides[axis], np.flip(self.poles, axis)
        if side.periodic == "1":
            # The first pole of a periodic direction belongs to the flat knots before the first one.
            poles = np.roll(poles, side.degree + 1 - side.multiplicities[0], axis)
        new = replace(side, knots=side.both - side.knots[::-1], multiplicities=side.multiplicities[::-1])
        sign = np.where(np.arange(2) == axis, -1.0, 1.0)
        return SplineRecord(sign[:, None] * self.matrix, sign * self.shift + np.where(sign < 0, side.both, 0.0),
                            (new, self.sides[1]) if axis == 0 else (self.sides[0], new), poles)

    def text(self) -> str:
        """The record."""
        u, v = self.sides
        head = (f"{_SPLINE} {u.rational} {v.rational} {u.periodic} {v.periodic} {u.degree} {v.degree} "
                f"{self.poles.shape[0]} {self.poles.shape[1]} {len(u.knots)} {len(v.knots)}")
        return "\n".join([head, numbers_text(self.poles), u.text(), v.text()])


def read_surface(record: str) -> PlaneRecord | SplineRecord | None:
    """The surface of a record as it is; None where it is neither a plane nor a B-spline, and cannot be turned."""
    tokens = record.split()
    if tokens[0] == _PLANE:
        return PlaneRecord(np.eye(2), np.zeros(2), np.array(tokens[1:], dtype=float).reshape(4, 3))
    if tokens[0] != _SPLINE:
        return None
    counts = [int(token) for token in tokens[7:11]]
    size = counts[0] * counts[1] * (3 + ("1" in tokens[1:3]))
    poles = np.array(tokens[11 : 11 + size], dtype=float).reshape(counts[0], counts[1], -1)
    at, sides = 11 + size, []
    for axis, count in enumerate(counts[2:]):
        pairs = np.array(tokens[at : at + 2 * count], dtype=float).reshape(-1, 2)
        sides.append(SurfaceDirection(tokens[1 + axis], tokens[3 + axis], int(tokens[5 + axis]), pairs[:, 0],
                                      tuple(pairs[:, 1].astype(int).tolist())))
        at += 2 * count
    return SplineRecord(np.eye(2), np.zeros(2), (sides[0], sides[1]), poles)


def turned_curve(curve: Curve, first: float, last: float) -> str:
    """The record of a curve, in space or in (u, v), that runs from its ``last`` parameter to its ``first``."""
    both = first + last
    if isinstance(curve, Line):
        return print_curve(Line(curve.origin + both * curve.direction, -curve.direction))
    if isinstance(curve, Conic) and curve.kind in _ROUND and len(curve.origin) == 3:
        c, s = np.cos(both), np.sin(both)
        return print_curve(replace(curve, axis_x=c * curve.axis_x + s * curve.axis_y,
                                   axis_y=s * curve.axis_x - c * curve.axis_y))
    if isinstance(curve, Spline) and not curve.periodic:
        return print_curve(replace(curve, knots=both - curve.knots[::-1], poles=curve.poles[::-1]))
    return str(cubic(lambda t: curve(both - t), first, last, both - curve.breaks()[::-1]).record)
