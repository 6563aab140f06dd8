# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolates a vector function over a parameter box by a cubic spline surface: the control lattice of a face.

Spans are bisected where the interpolation error requires it, so that the lattice is as coarse as the tolerance allows.
Numpy and scipy only; what is read from a FreeCAD surface is in `face_parameters`.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_banded
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from ..registration.arrays import Array
from ..registration.splines import DEGREE, SplineSurface, basis_rows, greville
from .kinks import without_false_kinks

GridFunction = Callable[[Array, Array], Array]
"""f(u (m,), v (n,)) -> values on the grid, (m, n, 3)."""

_CHECK_PLACES = np.array([0.21, 0.5, 0.79])
"""Places in every span at which the error is measured (theory: the middle, and near where a cubic's error has its other
extrema)."""
_CHECK_LINES = 16, 60
"""Number of lines along which errors are checked: while the knots are refined, and in the final check (unit: time)."""
_SHORTEST_SPAN = 1e-5
"""Spans shorter than this share of their side are not divided: at a kink that no knot marks it would never end, and
Open CASCADE reads no surface whose knots coincide but for rounding (theory)."""
_KINKED_SLOPE = 1e-6
"""Relative change of the derivative at a knot of multiplicity three from which on it stays one (theory: far above
rounding)."""
_DEGENERATE_ROW = 1e-7
"""A row of control points within a box of this size, in mm, is a pole of the surface and is made exactly one point
(theory: Open CASCADE's own precision, 1e-7)."""


@dataclass(frozen=True)
class ParameterBox:
    """The (u, v) box of a face; a closed direction is a full period with a continuous slope across the seam."""

    u0: float
    u1: float
    v0: float
    v1: float
    closed_u: bool = False
    closed_v: bool = False


@dataclass(frozen=True)
class Direction:
    """One parameter direction while its knots are refined: the box side and the flat interior knots."""

    start: float
    end: float
    interior: Array
    closed: bool

    @cached_property
    def knots(self) -> Array:
        a, b = self.start, self.end
        if not self.closed:
            return np.concatenate([np.full(DEGREE + 1, a), self.interior, np.full(DEGREE + 1, b)])
        one = np.concatenate([[a], self.interior])
        return np.concatenate([one[-DEGREE:] - (b - a), one, [b], one[1 : DEGREE + 1] + (b - a)])

    @cached_property
    def sites(self) -> Array:
        """Interpolation sites: Greville abscissae, one per free control point."""
        x = greville(self.knots)
        if not self.closed:
            return np.clip(x, self.start, self.end)
        return self.start + np.mod(x[:-DEGREE] - self.start, self.end - self.start)

    @property
    def checks(self) -> Array:
        """Parameters inside every span, where the interpolation error is looked at; (spans, 3)."""
        breaks = np.unique(np.concatenate([[self.start], self.interior, [self.end]]))
        return breaks[:-1, None] + np.diff(breaks)[:, None] * _CHECK_PLACES

    def solve(self, values: Array) -> Array:
        """Control points that interpolate values at the sites along axis 0, without the repeated ones."""
        first, basis = basis_rows(self.knots, self.sites)
        row, column = np.arange(len(first))[:, None], first[:, None] + np.arange(DEGREE + 1)
        right = values.reshape(len(values), -1)
        if self.closed:
            places = np.broadcast_to(row, column.shape).ravel(), (column % len(first)).ravel()
            return np.asarray(splu(csc_matrix((basis.ravel(), places))).solve(right).reshape(values.shape))
        bands = np.zeros((2 * DEGREE + 1, len(first)))
        bands[DEGREE + row - column, column] = basis
        return np.asarray(solve_banded((DEGREE, DEGREE), bands, right).reshape(values.shape))

    def unroll(self, points: Array) -> Array:
        """Control points along axis 0 with the repeated ones of a closed direction appended."""
        return np.concatenate([points, points[:DEGREE]]) if self.closed else points

    def refined(self, errors: Array, tolerance: float, most: int) -> Direction:
        """Spans whose error (spans,) exceeds the tolerance are split; a cubic's error falls with the fourth power."""
        breaks = np.unique(np.concatenate([[self.start], self.interior, [self.end]]))
        pieces = np.ceil((errors / (0.7 * tolerance)) ** 0.25).astype(int)
        divisible = np.diff(breaks) > _SHORTEST_SPAN * (self.end - self.start)
        pieces = np.where((errors > tolerance) & divisible, np.clip(pieces, 2, 6), 1)
        room = most - len(self.interior)
        if room <= 0:
            return self
        if (pieces - 1).sum() > room:
            pieces = np.minimum(pieces, 2)
            worst = np.argsort(np.where(divisible, errors, 0.0))[::-1][:room]
            pieces = np.where(np.isin(np.arange(len(pieces)), worst), pieces, 1)
        new = [a + (b - a) * np.arange(1, k) / k
               for a, b, k in zip(breaks[:-1], breaks[1:], pieces, strict=True) if k > 1]
        if not new:
            return self
        return Direction(self.start, self.end, np.sort(np.concatenate([self.interior, *new])), self.closed)


def direction(start: float, end: float, seeds: Array, closed: bool) -> Direction:
    """A direction to start from, interior knots at the seeds: inside, 1e-6 of it apart, multiplicity at most 3."""
    length = end - start
    seeds = np.sort(np.asarray(seeds, dtype=float))
    seeds = seeds[(seeds > start + 1e-6 * length) & (seeds < end - 1e-6 * length)]
    kept: list[float] = []
    for x in seeds:
        if kept and x - kept[-1] < 1e-6 * length:
            if kept.count(kept[-1]) < DEGREE:
                kept.append(kept[-1])
        else:
            kept.append(float(x))
    interior = np.array(kept)
    if closed and len(interior) < 7:
        interior = np.unique(np.concatenate([interior, start + length * np.arange(1, 8) / 8]))
    return Direction(start, end, interior, closed)


def _smoothed(side: Direction, f: Callable[[Array], Array]) -> Direction:
    """The direction without knots of multiplicity three where ``f``, over it, has no kink: nearly equal seeds."""
    def inside(x: Array) -> Array:
        return f(np.clip(x, side.start, side.end))

    return replace(side, interior=without_false_kinks(inside, side.interior, side.end - side.start, _KINKED_SLOPE))


def _at_most(x: Array, most: int) -> Array:
    return x if len(x) <= most else x[np.linspace(0, len(x) - 1, most).round().astype(int)]


def _interpolate(f: GridFunction, u: Direction, v: Direction) -> SplineSurface:
    values = f(u.sites, v.sites)
    points = u.unroll(u.solve(values))
    points = v.unroll(v.solve(points.swapaxes(0, 1))).swapaxes(0, 1)
    return SplineSurface(u.knots, v.knots, points, periodic_u=u.closed, periodic_v=v.closed)


def _errors(f: GridFunction, surface: SplineSurface, u: Direction, v: Direction, lines: int) -> tuple[Array, Array]:
    """Largest interpolation error per span of u and per span of v, each taken at the other direction's sites."""
    cu, cv = u.checks, v.checks
    su, sv = _at_most(np.sort(u.sites), lines), _at_most(np.sort(v.sites), lines)
    in_u = np.linalg.norm(f(cu.ravel(), sv) - surface.on_grid(cu.ravel(), sv), axis=2)
    in_v = np.linalg.norm(f(su, cv.ravel()) - surface.on_grid(su, cv.ravel()), axis=2)
    return in_u.reshape(len(cu), -1).max(axis=1), in_v.T.reshape(len(cv), -1).max(axis=1)


def approximate(f: GridFunction, box: ParameterBox, seeds_u: Array, seeds_v: Array, tolerance: float,
                most: int = 60_000, rounds: int = 12) -> SplineSurface:
    """Cubic spline surface that interpolates ``f`` at Greville points, its knots refined until it is close enough.

    Parameters
    ----------
    f : the surface or displacement on a grid of parameters, in mm
    box : parameter box; closed directions get a periodic C2 basis
    seeds_u, seeds_v : interior knots to start from, repeated for multiplicity (a kink of ``f`` needs three)
    tolerance : largest distance from ``f`` in mm, checked at three points in every span
    most : largest number of control points; a function too rough for it is met less closely
    rounds : largest number of refinements

    Notes
    -----
    Interpolation at Greville abscissae is well conditioned for cubics (de Boor, A Practical Guide to Splines, XIII).
    """
    u = direction(box.u0, box.u1, seeds_u, box.closed_u)
    v = direction(box.v0, box.v1, seeds_v, box.closed_v)
    u = _smoothed(u, lambda x: f(x, _at_most(v.sites, _CHECK_LINES[0])))
    v = _smoothed(v, lambda x: f(_at_most(u.sites, _CHECK_LINES[0]), x).swapaxes(0, 1))
    for _ in range(rounds):
        surface = _interpolate(f, u, v)
        for lines in _CHECK_LINES:
            error_u, error_v = _errors(f, surface, u, v, lines)
            if max(error_u.max(), error_v.max()) > tolerance:
                break
        else:
            break
        finer_u = u.refined(error_u, tolerance, most // len(v.sites))
        finer_v = v.refined(error_v, tolerance, most // len(finer_u.sites))
        if finer_u is u and finer_v is v:
            break
        u, v = finer_u, finer_v
    else:
        surface = _interpolate(f, u, v)
    return closed_and_pinched(surface)


def closed_and_pinched(surface: SplineSurface) -> SplineSurface:
    """The surface with poles made exactly one point and nearly equal opposite rows made exactly equal."""
    points = surface.control_points.copy()
    for axis, periodic in ((0, surface.periodic_u), (1, surface.periodic_v)):
        rows = np.moveaxis(points, axis, 0)
        if periodic:
            continue
        if np.abs(rows[0] - rows[-1]).max() < _DEGENERATE_ROW:
            rows[0] = rows[-1] = 0.5 * (rows[0] + rows[-1])
        for end in (0, -1):
            if np.ptp(rows[end], axis=0).max() < _DEGENERATE_ROW:
                rows[end] = rows[end].mean(axis=0)
    return SplineSurface(surface.knots_u, surface.knots_v, points, surface.degree_u, surface.degree_v,
                         surface.periodic_u, surface.periodic_v)
