# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curve records of a BREP text, in 2-D and 3-D: evaluated as arrays, mapped into a plane, printed.

This module owns the mathematics of OCCT's curve types. Curves of a face's (u, v) and of space are the same classes;
a point has 2 or 3 coordinates.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline

from ...registration.arrays import Array, Index


@dataclass(frozen=True)
class Line:
    """origin + t·direction."""

    origin: Array
    direction: Array

    def __call__(self, t: Array) -> Array:
        """Points at the parameters: (n,) to (n, dim)."""
        return self.origin + t[:, None] * self.direction

    def breaks(self) -> Array:
        """Flat knots where a derivative jumps."""
        return np.zeros(0)


@dataclass(frozen=True)
class Conic:
    """Circle '2', ellipse '3', parabola '4' or hyperbola '5': origin + x(t)·axis_x + y(t)·axis_y."""

    kind: str
    origin: Array
    axis_x: Array
    axis_y: Array
    radii: tuple[float, ...]

    def __call__(self, t: Array) -> Array:
        """Points at the parameters: (n,) to (n, dim)."""
        r, s = self.radii[0], self.radii[-1]
        x, y = {"2": lambda: (r * np.cos(t), r * np.sin(t)),
                "3": lambda: (r * np.cos(t), s * np.sin(t)),
                "4": lambda: (t * t / (4.0 * r), t),
                "5": lambda: (r * np.cosh(t), s * np.sinh(t))}[self.kind]()
        return self.origin + x[:, None] * self.axis_x + y[:, None] * self.axis_y

    def breaks(self) -> Array:
        """Flat knots where a derivative jumps."""
        return np.zeros(0)


@dataclass(frozen=True)
class Spline:
    """A B-spline; knots flat, a periodic one unrolled; homogeneous poles (n, dim + 1) if it is rational."""

    degree: int
    knots: Array
    poles: Array
    rational: bool
    periodic: bool

    def __call__(self, t: Array) -> Array:
        """Points at the parameters: (n,) to (n, dim)."""
        first, last = self.knots[self.degree], self.knots[-self.degree - 1]
        if self.periodic:
            t = first + np.mod(t - first, last - first)
        values = BSpline.construct_fast(self.knots, self.poles, self.degree)(t)
        return values[:, :-1] / values[:, -1:] if self.rational else values

    def mapped(self, linear: Array, shift: Array) -> Spline:
        """The curve under x -> linear·x + shift; ``linear`` is (dim, dim')."""
        if not self.rational:
            return replace(self, poles=self.poles @ linear.T + shift)
        points, weights = self.poles[:, :-1], self.poles[:, -1:]
        return replace(self, poles=np.concatenate([points @ linear.T + weights * shift, weights], axis=1))

    def breaks(self) -> Array:
        """Knots, repeated so that a cubic keeps the continuity C^(degree − multiplicity) there."""
        knots, multiplicity = np.unique(self.knots, return_counts=True)
        return np.repeat(knots, np.clip(3 - (self.degree - multiplicity), 1, 3))


@dataclass(frozen=True)
class Offset:
    """A curve moved sideways by ``distance``; in space the side is tangent × ``normal`` (None in the plane)."""

    basis: Curve
    distance: float
    normal: Array | None

    def __call__(self, t: Array) -> Array:
        """Points at the parameters: (n,) to (n, dim)."""
        # A central difference gives the direction to 1e-8, at the basis curve's C1 knots too.
        step = 1e-8 * max(1.0, float(np.ptp(t)))
        tangent = self.basis(t + step) - self.basis(t - step)
        if self.normal is None:
            side = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        else:
            side = np.cross(tangent, self.normal)
        return self.basis(t) + self.distance * side / np.linalg.norm(side, axis=1, keepdims=True)

    def breaks(self) -> Array:
        """Flat knots where a derivative jumps."""
        return self.basis.breaks()


Curve = Line | Conic | Spline | Offset


def read_curve(record: str, dimension: int) -> Curve:
    """The curve of a record; a trimmed curve is its basis, of which the edge's range is a part."""
    return _read(record.split(), dimension)


def _read(tokens: list[str], dimension: int) -> Curve:
    kind = tokens[0]
    if kind == "8":
        return _read(tokens[3:], dimension)
    if kind == "9" and dimension == 2:
        return Offset(_read(tokens[2:], 2), float(tokens[1]), None)
    if kind == "9":
        return Offset(_read(tokens[5:], 3), float(tokens[1]), np.array(tokens[2:5], dtype=float))
    numbers = np.array(tokens[1:], dtype=float)
    if kind == "1":
        return Line(numbers[:dimension], numbers[dimension:])
    if kind in "2345":
        origin, rest = numbers[:dimension], numbers[dimension:]
        if dimension == 3:
            rest = rest[3:]
        axis_x, axis_y = rest[: 2 * dimension].reshape(2, dimension)
        return Conic(kind, origin, axis_x, axis_y, tuple(rest[2 * dimension :].tolist()))
    if kind == "6":
        rational, degree = bool(numbers[0]), int(numbers[1])
        poles = _homogeneous(numbers[2:], degree + 1, dimension, rational)
        return Spline(degree, np.repeat([0.0, 1.0], degree + 1), poles, rational, periodic=False)
    rational, periodic, degree = bool(numbers[0]), bool(numbers[1]), int(numbers[2])
    count = int(numbers[3])
    size = count * (dimension + rational)
    poles = _homogeneous(numbers[5 : 5 + size], count, dimension, rational)
    knots, multiplicities = numbers[5 + size :: 2], numbers[6 + size :: 2].astype(int)
    if periodic:
        knots, poles = _unrolled(knots, multiplicities, poles, degree)
    else:
        knots = np.repeat(knots, multiplicities)
    return Spline(degree, knots, poles, rational, periodic)


def _homogeneous(numbers: Array, count: int, dimension: int, rational: bool) -> Array:
    poles = numbers.reshape(count, dimension + rational)
    return np.concatenate([poles[:, :-1] * poles[:, -1:], poles[:, -1:]], axis=1) if rational else poles


def _unrolled(knots: Array, multiplicities: Index, poles: Array, degree: int) -> tuple[Array, Array]:
    """A periodic spline as one that repeats: OCCT's first pole belongs to the flat knots before the first one."""
    period, one = knots[-1] - knots[0], np.repeat(knots[:-1], multiplicities[:-1])
    turns = 1 + -(-(2 * degree + 2) // len(one))
    flat = np.concatenate([one + turn * period for turn in range(-turns, turns + 2)])
    start = turns * len(one) + multiplicities[0] - 1 - degree
    return flat[start : start + len(poles) + 2 * degree + 1], poles[np.arange(len(poles) + degree) % len(poles)]


def mapped(curve: Curve, linear: Array, shift: Array) -> Curve:
    """The curve under x -> linear·x + shift; ``linear`` is (dim, dim') and must not distort circles or offsets."""
    if isinstance(curve, Line):
        return Line(linear @ curve.origin + shift, linear @ curve.direction)
    if isinstance(curve, Conic):
        return replace(curve, origin=linear @ curve.origin + shift, axis_x=linear @ curve.axis_x,
                       axis_y=linear @ curve.axis_y)
    if isinstance(curve, Spline):
        return curve.mapped(linear, shift)
    raise ValueError("an offset curve has no exact image")


def numbers_text(values: Array) -> str:
    """Numbers with all their digits."""
    return " ".join(map(repr, np.ravel(values).tolist()))


def knots_text(knots: Array) -> str:
    """Pairs of knot and multiplicity."""
    distinct, multiplicity = np.unique(knots, return_counts=True)
    return " ".join(f"{knot!r} {count}" for knot, count in zip(distinct.tolist(), multiplicity.tolist(), strict=True))


def print_curve(curve: Line | Conic | Spline) -> str:
    """The record of a line, a conic, or a spline that is not periodic, whatever its dimension."""
    if isinstance(curve, Line):
        return f"1 {numbers_text(curve.origin)} {numbers_text(curve.direction)}"
    if isinstance(curve, Conic):
        normal = [np.cross(curve.axis_x, curve.axis_y)] if len(curve.origin) == 3 else []
        axes = np.concatenate([curve.origin, *normal, curve.axis_x, curve.axis_y, curve.radii])
        return f"{curve.kind} {numbers_text(axes)}"
    if curve.periodic:
        raise ValueError("a periodic spline must be clamped first")
    poles = curve.poles
    if curve.rational:
        poles = np.concatenate([poles[:, :-1] / poles[:, -1:], poles[:, -1:]], axis=1)
    spans = len(np.unique(curve.knots))
    head = f"7 {curve.rational:d} 0 {curve.degree} {len(poles)} {spans}"
    return f"{head} {numbers_text(poles)} {knots_text(curve.knots)}"
