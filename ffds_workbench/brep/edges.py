# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves of edges on deformed faces: fitted to their traces on the faces, and how far they are from each face."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ..registration.arrays import Array
from ..registration.splines import DEGREE, SplineSurface, basis_matrix
from .kinks import without_false_kinks
from .occt_text import Curve, Line, Pcurve, Spline, crossings, fit_curve

_GAP_SAMPLES = 257
"""Places along an edge at which its gap is measured (unit: time), …"""
_GAP_SAMPLES_PER_SPAN = 4
"""… and more for each span of its curve (theory: a cubic has two extrema)."""
_KINKED_SLOPE = 0.05
"""Relative change of the derivative at a knot from which on the curve counts as kinked; pcurves that intersection
algorithms leave behind have C0 knots with kinks of up to 0.03, which a few more knots round off (unit: 3°)."""
_SAME_BREAK = 1e-6
"""Difference of a parameter from a whole number of turns below which it is one (theory: far above rounding)."""
_CONSTANT_PARAMETER = 1e-12
"""A parameter that varies by less along a pcurve, relative to the other one, is constant (theory: rounding)."""
_SEAM_TOLERANCE = 2e-8
"""Tolerance in mm of a seam's curve, of which both sides have to be one (theory: a fifth of Open CASCADE's
precision)."""


@dataclass(frozen=True)
class Trace:
    """An edge as one face sees it: the face's new surface along the pcurve, in world coordinates."""

    surface: SplineSurface
    pcurve: Pcurve

    def at(self, fraction: Array) -> Array:
        """Points at fractions of the edge's range, (n,) in [0, 1] to (n, 3)."""
        if self._isoparametric is not None:
            axis, curve = self._isoparametric
            start, end = curve.knots[DEGREE], curve.knots[-DEGREE - 1]
            along = self.uv(fraction)[:, axis]
            return curve(along if curve.periodic else np.minimum(np.maximum(along, start), end))
        return self.surface(self.uv(fraction))

    @cached_property
    def _isoparametric(self) -> tuple[int, Spline] | None:
        """For a pcurve along u or v: that axis, and the surface's curve there, much faster than the surface."""
        if self._across is None:
            return None
        axis, surface = 1 - self._across, self.surface
        at = surface.inside(self.uv(np.zeros(1)))[:, self._across]
        if axis == 0:
            row = basis_matrix(surface.knots_v, at, surface.degree_v)
            return 0, Spline(DEGREE, surface.knots_u, np.einsum("k,ikd->id", row[0], surface.control_points), False,
                             surface.periodic_u)
        row = basis_matrix(surface.knots_u, at, surface.degree_u)
        return 1, Spline(DEGREE, surface.knots_v, np.einsum("k,kjd->jd", row[0], surface.control_points), False,
                         surface.periodic_v)

    @cached_property
    def _across(self) -> int | None:
        """The parameter that is constant along the pcurve, if one is."""
        curve = self.pcurve.curve
        if isinstance(curve, Line):
            extent = np.abs(curve.direction)
        elif isinstance(curve, Spline) and not curve.rational:
            extent = np.ptp(curve.poles, axis=0)
        else:
            return None
        still = extent <= _CONSTANT_PARAMETER * max(1.0, float(extent.max()))
        return int(np.argmax(still)) if np.count_nonzero(still) == 1 else None

    @cached_property
    def on_seam(self) -> bool:
        """Whether the pcurve runs along the line where a closed surface meets itself."""
        return self._across is not None and self._at_seam(0.0, self._across)

    def at_seam(self, fraction: float) -> bool:
        """Whether the pcurve is on such a line at a fraction of the edge's range."""
        return self._at_seam(fraction, 0) or self._at_seam(fraction, 1)

    def _at_seam(self, fraction: float, axis: int) -> bool:
        surface = self.surface
        rows = np.moveaxis(surface.control_points, axis, 0)
        if not ((surface.periodic_u, surface.periodic_v)[axis] or np.array_equal(rows[0], rows[-1])):
            return False
        low, high = surface.range[2 * axis : 2 * axis + 2]
        turns = (float(self.uv(np.array([fraction]))[0, axis]) - low) / (high - low)
        return abs(turns - round(turns)) < _SAME_BREAK

    def _coordinate(self, axis: int, fraction: Array) -> Array:
        """u (axis 0) or v on the face at fractions of the edge's range: (n,)."""
        return self.uv(fraction)[:, axis]

    def uv(self, fraction: Array) -> Array:
        """Parameters on the face at fractions of the edge's range: (n, 2)."""
        pcurve = self.pcurve
        return pcurve.curve(pcurve.first + fraction * (pcurve.last - pcurve.first))

    def breaks(self) -> Array:
        """Fractions at which the trace is not C2, repeated for the multiplicity a cubic needs there.

        Along a seam all knots of the surface are breaks, so that a cubic is the surface's own curve there.
        """
        pcurve, surface = self.pcurve, self.surface
        own = (pcurve.curve.breaks() - pcurve.first) / (pcurve.last - pcurve.first)
        found = [_repeated(own[(own > 0.0) & (own < 1.0)])]
        for axis, knots in ((0, surface.knots_u), (1, surface.knots_v)):
            levels = knots[DEGREE + 1 : -DEGREE - 1]
            levels = levels if self.on_seam else _repeated(levels)
            for level in np.unique(levels):
                passed = crossings(partial(self._coordinate, axis), 0.0, 1.0, np.array([level]))
                found.append(np.repeat(passed, np.count_nonzero(levels == level)))
        return np.concatenate(found)

    def spans(self) -> int:
        """Number of lattice spans the trace can pass."""
        return len(self.surface.knots_u) + len(self.surface.knots_v)


@dataclass(frozen=True)
class PlacedCurve:
    """An edge's own curve over its range, and the matrix (4, 4) that takes it into world coordinates."""

    curve: Curve
    matrix: Array
    first: float
    last: float

    def at(self, fraction: Array) -> Array:
        """Points at fractions of the edge's range, (n,) in [0, 1] to (n, 3)."""
        points = self.curve(self.first + fraction * (self.last - self.first))
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def spans(self) -> int:
        """Number of spans of the curve."""
        if isinstance(self.curve, Line):
            return 0
        return len(self.curve.breaks()) + (len(self.curve.knots) if isinstance(self.curve, Spline) else 0)


def _repeated(knots: Array) -> Array:
    """Knots of multiplicity two and more, with their repetitions."""
    distinct, first, count = np.unique(np.round(knots, 12), return_index=True, return_counts=True)
    several = count >= 2
    return np.repeat(knots[first[several]], count[several])


def edge_curve(traces: Sequence[Trace], first: float, last: float, closed: bool, tolerance: float) -> Spline:
    """Cubic through the mean of the traces over [first, last]; ends equal where the edge is ``closed``.

    An edge on the seam of a closed surface is that surface's own curve there, and one that ends on the seam follows
    that surface alone: off by a mere 1e-6 mm, readers of STEP cannot tell on which side of the seam they are.
    """
    along = [trace for trace in traces if trace.on_seam]
    if along:
        tolerance = min(tolerance, _SEAM_TOLERANCE)
    traces = along or [trace for trace in traces if trace.at_seam(0.0) or trace.at_seam(1.0)] or traces

    def mean(t: Array) -> Array:
        fraction = np.minimum(np.maximum((t - first) / (last - first), 0.0), 1.0)
        return np.asarray(np.mean([trace.at(fraction) for trace in traces], axis=0))

    breaks = first + (last - first) * np.concatenate([trace.breaks() for trace in traces])
    breaks = without_false_kinks(mean, breaks, last - first, _KINKED_SLOPE)
    curve = fit_curve(mean, first, last, breaks, tolerance)
    if closed:
        curve.poles[0] = curve.poles[-1] = 0.5 * (curve.poles[0] + curve.poles[-1])
    return curve


def largest_gap(curve: PlacedCurve, traces: Sequence[Trace]) -> float:
    """Largest distance in mm between an edge's curve and its traces at the same parameter, densely sampled."""
    if not traces:
        return 0.0
    spans = max(trace.spans() for trace in traces) + curve.spans()
    fraction = np.linspace(0.0, 1.0, _GAP_SAMPLES + _GAP_SAMPLES_PER_SPAN * spans)
    points = curve.at(fraction)
    return max(float(np.linalg.norm(trace.at(fraction) - points, axis=1).max()) for trace in traces)
