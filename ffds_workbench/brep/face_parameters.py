# SPDX-License-Identifier: LGPL-2.1-or-later
"""The (u, v) of a FreeCAD face: the parameter box, the trims and the knots of its surface."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import Part

from ..registration.arrays import Array
from ..registration.splines import DEGREE
from .surface_fit import ParameterBox

_CURVE_SAMPLES = 65
"""Places along an edge that bound its parameters (theory: an arc is covered to 3e-4 of its length, less than the
widening)."""
_QUARTER_TURN = 0.5 * np.pi
"""Largest turn of a span that a cubic follows, in rad (theory)."""
_WIDENING = 0.002
"""Of a range of parameters, that is added on either side where edges are curved (theory: more than lies between two
samples of them)."""
_COINCIDENT = 1e-7
"""Points of a surface this close, in mm, are one (theory: Open CASCADE's own precision, 1e-7)."""
_SEAM_SLOPE = 1e-5
"""Largest relative change of slope across a seam that still counts as smooth (theory: far above rounding, far below
what light shows)."""


def forward(face: Part.Face) -> Part.Face:
    """The face taken FORWARD, whose wires give the right pcurve of a seam."""
    return face.reversed() if face.Orientation == "Reversed" else face


def closed_form(surface: Part.GeometrySurface) -> Callable[[Array, Array], Array] | None:
    """S(u, v) for arrays of u and v, exact but for rounding, of planes and cylinders; None for other surfaces.

    Most faces are of these, and a call of OCCT for every point takes a hundred times as long.
    """
    kind = type(surface).__name__
    if kind not in ("Plane", "Cylinder"):
        return None
    origin, right, up = (np.array(tuple(surface.value(u, v)))
                         for u, v in ((0.0, 0.0), (_QUARTER_TURN, 0.0), (0.0, 1.0)))
    along = up - origin
    if kind == "Plane":
        across = (right - origin) / _QUARTER_TURN
        return lambda u, v: origin + u[..., None] * across + v[..., None] * along
    centre = 0.5 * (origin + np.array(tuple(surface.value(np.pi, 0.0))))
    axes = origin - centre, right - centre
    return lambda u, v: (centre + np.cos(u)[..., None] * axes[0] + np.sin(u)[..., None] * axes[1]
                         + v[..., None] * along)


def trims(face: Part.Face) -> tuple[tuple[Array, ...], bool]:
    """Closed polylines in (u, v), one per wire, and whether any of the pcurves is curved."""
    face = forward(face)
    polylines, curved = [], False
    for wire in face.Wires:
        pieces = []
        ordered = wire.OrderedEdges
        for edge in ordered if len(ordered) >= len(wire.Edges) else wire.Edges:
            pcurve = face.curveOnSurface(edge)
            if pcurve is None:
                continue
            curve, first, last = pcurve[:3]
            straight = type(curve).__name__ == "Line2d"
            curved |= not straight
            samples = [curve.value(t) for t in np.linspace(first, last, 2 if straight else _CURVE_SAMPLES)]
            piece = np.array([(point.x, point.y) for point in samples])
            pieces.append(piece[::-1] if edge.Orientation == "Reversed" else piece)
        if pieces:
            polyline = np.concatenate(pieces)
            polylines.append(np.concatenate([polyline, polyline[:1]]))
    return tuple(polylines), curved


def parameter_box(face: Part.Face, polylines: tuple[Array, ...], curved: bool) -> ParameterBox:
    """The box of the trims, a little wider where they are curved, inside the surface's natural bounds.

    A direction that runs over a full period is exactly that period, and closed if the slope is continuous there.
    """
    surface = face.Surface
    low, high = np.concatenate(polylines).min(axis=0), np.concatenate(polylines).max(axis=0)
    natural = _natural_bounds(surface, 0.5 * (low[1] + high[1]))
    sides, closed = [], []
    for k, (is_periodic, is_closed) in enumerate(((surface.isUPeriodic(), surface.isUClosed()),
                                                  (surface.isVPeriodic(), surface.isVClosed()))):
        start, end = natural[2 * k], natural[2 * k + 1]
        a, b = low[k], high[k]
        full = b - a >= (end - start) * (1 - 1e-6) and (is_closed or _meets_itself(surface, natural, k))
        if full:
            a, b = (a, a + (end - start)) if is_periodic else (start, end)
        else:
            margin = _WIDENING * (b - a) if curved else 0.0
            a, b = a - margin, b + margin
            if not is_periodic:
                a, b = max(a, start), min(b, end)
            elif b - a > end - start:
                a, b = 0.5 * (a + b) - 0.5 * (end - start), 0.5 * (a + b) + 0.5 * (end - start)
        sides += [float(a), float(b)]
        closed.append(full)
    u0, u1, v0, v1 = sides
    box = ParameterBox(u0, u1, v0, v1)
    smooth_u, smooth_v = (closed[axis] and _smooth_seam(surface, box, axis) for axis in (0, 1))
    return replace(box, closed_u=smooth_u, closed_v=smooth_v)


def _natural_bounds(surface: Part.GeometrySurface, v_inside: float) -> Array:
    """(u0, u1, v0, v1) of the surface; a cone ends at its apex, on the side of ``v_inside``."""
    natural = np.array(surface.bounds())
    if type(surface).__name__ == "Cone":
        apex = -surface.Radius / np.sin(surface.SemiAngle)
        natural[2 if v_inside > apex else 3] = apex
    return natural


def _meets_itself(surface: Part.GeometrySurface, natural: Array, direction: int) -> bool:
    """Whether opposite sides coincide: OCCT calls a B-spline closed only where that holds to the last digit."""
    u0, u1, v0, v1 = natural
    for f in (0.0, 0.13, 0.5, 0.84, 1.0):
        u, v = u0 + f * (u1 - u0), v0 + f * (v1 - v0)
        ends = ((u0, v), (u1, v)) if direction == 0 else ((u, v0), (u, v1))
        first, last = (surface.value(*end) for end in ends)
        if first.distanceToPoint(last) > _COINCIDENT:
            return False
    return True


def _smooth_seam(surface: Part.GeometrySurface, box: ParameterBox, direction: int) -> bool:
    """Whether the first derivative across the seam is continuous."""
    for f in (0.13, 0.5, 0.84):
        if direction == 0:
            v = box.v0 + f * (box.v1 - box.v0)
            a, b = surface.getDN(box.u0, v, 1, 0), surface.getDN(box.u1, v, 1, 0)
        else:
            u = box.u0 + f * (box.u1 - box.u0)
            a, b = surface.getDN(u, box.v0, 0, 1), surface.getDN(u, box.v1, 0, 1)
        if (a - b).Length > _SEAM_SLOPE * max(a.Length, b.Length, 1e-12):
            return False
    return True


def own_knots(surface: Part.GeometrySurface, box: ParameterBox) -> tuple[Array, Array]:
    """Interior knots that the surface's own form asks for, repeated for multiplicity, in u and v.

    Angles get at least eight spans a turn; knots of B-splines keep their continuity C^(p − m), as far as a cubic can
    (multiplicity 3 − (p − m), clipped to 1…3), so that a non-rational surface of degree ≤ 3 stays exact.
    """
    kind = type(surface).__name__
    if kind == "BSplineSurface":
        return (_cubic_knots(surface.getUKnots(), surface.getUMultiplicities(), surface.UDegree, surface.isUPeriodic()),
                _cubic_knots(surface.getVKnots(), surface.getVMultiplicities(), surface.VDegree, surface.isVPeriodic()))
    if kind in ("OffsetSurface", "RectangularTrimmedSurface"):
        return own_knots(surface.BasisSurface, box)
    if kind == "SurfaceOfExtrusion":
        return _curve_knots(surface.BasisCurve, box.u0, box.u1), np.empty(0)
    if kind == "SurfaceOfRevolution":
        return _angles(box.u0, box.u1), _curve_knots(surface.BasisCurve, box.v0, box.v1)
    angular_u = kind in ("Cylinder", "Cone", "Sphere", "Toroid")
    angular_v = kind in ("Sphere", "Toroid")
    return (_angles(box.u0, box.u1) if angular_u else np.empty(0),
            _angles(box.v0, box.v1) if angular_v else np.empty(0))


def _angles(start: float, end: float) -> Array:
    spans = max(1, int(np.ceil(8 * (end - start) / (2 * np.pi) - 1e-9)))
    return np.linspace(start, end, spans + 1)[1:-1]


def _curve_knots(curve: Part.Curve, start: float, end: float) -> Array:
    kind = type(curve).__name__
    if kind == "BSplineCurve":
        return _cubic_knots(curve.getKnots(), curve.getMultiplicities(), curve.Degree, curve.isPeriodic())
    if kind in ("Circle", "Ellipse", "ArcOfCircle", "ArcOfEllipse"):
        return _angles(start, end)
    if hasattr(curve, "BasisCurve"):
        return _curve_knots(curve.BasisCurve, start, end)
    return np.empty(0)


def _cubic_knots(knots: list[float], multiplicities: list[int], degree: int, periodic: bool) -> Array:
    continuity = degree - np.asarray(multiplicities)
    repeated = np.repeat(np.asarray(knots, dtype=float), np.clip(DEGREE - continuity, 1, DEGREE))
    if not periodic:
        return repeated
    # The face may lie across the seam.
    one, period = repeated[repeated < knots[-1]], knots[-1] - knots[0]
    return np.concatenate([one - period, one, one + period])
