# SPDX-License-Identifier: LGPL-2.1-or-later
"""Judges an as-built file as it reads back, by OCCT alone: its numbers, its soundness, its mesh, and the distances of
the true points and edges from it."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import Part
from FreeCAD import Vector
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ..simulated.sheet import to_polyline
from . import numbers
from .case import WorldTruth

FLAGS = ("observed", "bridged", "carried")
_STEPS = 8
_CONVERGED = 1e-10
"""mm."""
_GRID = 24
_DOUBTFUL = 3.0
"""A distance by Newton's steps this many times the median of its face's is looked for anew by OCCT's search."""
_ALONG = 33
_POLYLINE = 400
_MESH = 1e-3
"""Largest distance of the mesh from the faces, of the diagonal of the part's box: some five times finer than FreeCAD
shows parts."""
_SAME_POINT = 1e-7
"""Corners of the mesh are one point within this share of that diagonal."""


def judge(nominal: Part.Shape, path: Path, truth: WorldTruth, bands: Mapping[str, Array],
          floor: float) -> dict[str, Any]:
    """Everything that is found out about a written file.

    Parameters
    ----------
    bands : ``face`` and ``face_flag`` at the truth's points; ``edge``, ``edge_flag`` and ``edge_off``, the distance
        from the truth, at places of edges
    floor : distance in mm within which an edge is where it should be
    """
    back = Part.read(str(path))
    lost = numbers.changes(nominal, back)
    row: dict[str, Any] = {"lost": lost, "valid": bool(back.isValid()), "opened": _opened(nominal, back),
                           "tolerance": [_tolerance(nominal), _tolerance(back)],
                           "gap": [_gap(nominal), _gap(back)], "mesh": [_mesh(nominal), _mesh(back)]}
    row["nominal"] = _figures(nominal, truth, np.abs(distances(nominal, truth)))
    if len(back.Faces) != len(nominal.Faces) or len(back.Edges) != len(nominal.Edges):
        return row
    lost += numbers.strays(back, truth.edges, floor)
    off = distances(back, truth)
    row |= _figures(back, truth, off)
    row["faces"] = [float(off[truth.face == k].mean()) if (truth.face == k).any() else None
                    for k in range(len(back.Faces))]
    row["bands"] = _held(off, bands["face"], bands["face_flag"])
    row["edge_bands"] = _held(bands["edge_off"], bands["edge"], bands["edge_flag"])
    return row


def distances(shape: Part.Shape, truth: WorldTruth) -> Array:
    """Distances (n,) in mm of the true points from the surfaces of their faces."""
    off = np.zeros(len(truth.face))
    for index in np.unique(truth.face):
        own = np.flatnonzero(truth.face == index)
        off[own] = _from_face(shape.Faces[index], truth.warped[own], truth.uv[own])
    return off


def _from_face(face: Part.Face, points: Array, uv: Array | None = None) -> Array:
    """Distances of points (n, 3) from a face's surface: Newton's steps from the nominal's (u, v), where it is known,
    and from the nearest of a grid, as files may turn a surface round; what is still far off, from the nearest point
    that OCCT finds."""
    surface = face.Surface
    u0, u1, v0, v1 = face.ParameterRange
    middles = (np.arange(_GRID) + 0.5) / _GRID  # never a pole, where all directions of u are one
    grid = np.stack(np.meshgrid(u0 + (u1 - u0) * middles, v0 + (v1 - v0) * middles), axis=-1).reshape(-1, 2)
    nearest = cKDTree([tuple(surface.value(u, v)) for u, v in grid.tolist()]).query(points)[1]
    off = _newton(surface, points, grid[nearest])
    if uv is not None:
        off = np.minimum(off, _newton(surface, points, uv))
    for k in np.flatnonzero(off > _DOUBTFUL * np.median(off) + _CONVERGED):
        found = surface.value(*surface.parameter(Vector(*points[k])))
        off[k] = min(off[k], float(np.linalg.norm(np.array(tuple(found)) - points[k])))
    return off


def _newton(surface: Part.Surface, points: Array, uv: Array) -> Array:
    """Distances after Gauss-Newton steps from (u, v), inside the surface's bounds where it is not periodic; none is
    longer than the surface, as near a pole they have no bound."""
    bounds = np.array(surface.bounds()).reshape(2, 2)
    longest = np.ptp(bounds, axis=1)
    bounds[[surface.isUPeriodic(), surface.isVPeriodic()]] = -np.inf, np.inf
    nearest = np.full(len(points), np.inf)
    for _ in range(_STEPS):
        foot, along_u, along_v = (np.array([tuple(surface.getDN(u, v, *order) if order else surface.value(u, v))
                                            for u, v in uv.tolist()]) for order in ((), (1, 0), (0, 1)))
        away = points - foot
        distance = np.linalg.norm(away, axis=1)
        better = distance < nearest - _CONVERGED
        nearest = np.minimum(nearest, distance)
        if not better.any():
            break
        e, f, g, p, q = (np.einsum("ij,ij->i", a, b) for a, b in ((along_u, along_u), (along_u, along_v),
                                                                  (along_v, along_v), (along_u, away), (along_v, away)))
        determinant = np.maximum(e * g - f * f, 1e-12 * e * g + 1e-300)
        step = np.stack([g * p - f * q, e * q - f * p], axis=1) / determinant[:, None]
        uv = np.clip(uv + np.clip(step, -longest, longest), bounds[:, 0], bounds[:, 1])
    return nearest


def _figures(shape: Part.Shape, truth: WorldTruth, off: Array) -> dict[str, Any]:
    """Figures of the points, and of the edges that bound a face: the others are no part of a body.

    A seam, where a face meets itself, is no line on the part: where it runs around a pipe is a choice of whoever drew
    it, and no scan can show it. It is judged across the surface, by the distance of its true points from the face. How
    far it is from its true line counts in ``edge_lines`` alone, which takes every edge for a line.
    """
    seams = {edge.hashCode(): face for face in shape.Faces for edge in face.Edges if edge.isSeam(face)}
    bounds = {edge.hashCode() for face in shape.Faces for edge in face.Edges}
    edges, lines = [], []
    for edge, before, true in zip(shape.Edges, truth.edges_nominal, truth.edges, strict=True):
        if not edge.Degenerated and np.ptp(before, axis=0).max() > 0 and edge.hashCode() in bounds:
            first, last = edge.ParameterRange
            line = np.array([tuple(edge.valueAt(t)) for t in np.linspace(first, last, _POLYLINE)])
            lines.append(to_polyline(true, line))
            face = seams.get(edge.hashCode())
            edges.append(lines[-1] if face is None else _from_face(face, true))
    return {"visible": figures(off[truth.visible]), "hidden": figures(off[~truth.visible]),
            **{name: figures(np.concatenate(found)) if found else None
               for name, found in (("edges", edges), ("edge_lines", lines))}}


def figures(off: Array) -> dict[str, float] | None:
    """Mean, 95th percentile and maximum in mm; None where there is nothing."""
    if not len(off):
        return None
    return {"mean": float(off.mean()), "p95": float(np.percentile(off, 95)), "max": float(off.max())}


def _held(off: Array, band: Array, flag: NDArray) -> dict[str, dict[str, int]]:
    return {name: {"places": int((flag == name).sum()), "held": int(((off <= band) & (flag == name)).sum())}
            for name in FLAGS}


def _opened(nominal: Part.Shape, back: Part.Shape) -> int:
    """Closed shells fewer than before."""
    return max(0, sum(shell.isClosed() for shell in nominal.Shells) - sum(shell.isClosed() for shell in back.Shells))


def _tolerance(shape: Part.Shape) -> float:
    return max(item.Tolerance for items in (shape.Faces, shape.Edges, shape.Vertexes) for item in items)


def _gap(shape: Part.Shape) -> float:
    """Largest distance in mm of an edge's curve from its faces along its pcurves, and of its ends from its vertices."""
    largest = 0.0
    for edge in shape.Edges:
        if not edge.Degenerated:
            ends = [edge.valueAt(t) for t in edge.ParameterRange]
            largest = max([largest, *(min(end.distanceToPoint(vertex.Point) for end in ends)
                                      for vertex in edge.Vertexes)])
    for face in shape.Faces:
        value = face.Surface.value
        for edge in face.Edges:
            found = None if edge.Degenerated else face.curveOnSurface(edge)
            if found is not None:
                (curve, *ends), (first, last) = found[:3], edge.ParameterRange
                pairs = zip(np.linspace(ends[0], ends[1], _ALONG), np.linspace(first, last, _ALONG), strict=True)
                largest = max([largest, *(_between(value, curve.value(s), edge.valueAt(t)) for s, t in pairs)])
    return largest


def _between(value: Any, uv: Any, point: Vector) -> float:
    return float(value(uv.x, uv.y).distanceToPoint(point))


def _mesh(shape: Part.Shape) -> dict[str, Any]:
    """Faces that OCCT cannot mesh, and sides of triangles in the whole mesh that do not meet another."""
    size = shape.BoundBox.DiagonalLength
    vertices, triangles = shape.tessellate(_MESH * size)
    points = np.array([tuple(vertex) for vertex in vertices]).reshape(-1, 3)
    corner = np.unique(np.round(points / (_SAME_POINT * size)), axis=0, return_inverse=True)[1].reshape(-1)
    return {"unmeshed": [number for number, face in enumerate(shape.Faces, 1) if not face.tessellate(_MESH * size)[1]],
            "open": _open_sides(corner[np.array(triangles, dtype=int).reshape(-1, 3)])}


def _open_sides(triangles: NDArray[np.intp]) -> int:
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    sides = sides[sides[:, 0] != sides[:, 1]]
    return int((np.unique(sides, axis=0, return_counts=True)[1] % 2).sum()) if len(sides) else 0
