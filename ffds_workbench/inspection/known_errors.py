# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a registration knows of the errors of its faces and edges, as draws of what they may be.

A band is the half width of a 95 % interval at a place; it does not say which places err together. What noise does
reaches as far as a control point; what the registration leaves at borders, in gaps and to its priors reaches along the
whole face. So half of the variance is drawn as B-splines with as many control points as the face's displacement has,
and half as motions and growth of the whole face, of the size that the bands tell in all.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError
from ..registration.arrays import Array
from ..registration.joint import JointFace
from ..registration.splines import basis_matrix, clamped_knots
from .features import ErrorField, no_errors

_FACE_QUANTILE, _EDGE_QUANTILE = 1.96, 2.4477
"""Standard deviations in the 95 % band of a distance, and of a distance in a plane (√χ² of two degrees of freedom)."""
_EDGE_CONTROLS = 11
"""Theory: a lattice has some eleven spans over a part's size."""
_LEAST_CONTROLS = 4
_SAME_MOTION = 1e-3
"""Motions that differ by less than this, of the largest, are one on a face."""


@dataclass(frozen=True)
class KnownErrors:
    """Bands of faces and edges.

    Attributes
    ----------
    entries : of the registration's report, by name; None where the as-built model is taken as exact
    joint : of each face, the bands place by place, where the registration is at hand
    """

    entries: Mapping[str, Mapping[str, Any]] | None
    joint: Mapping[str, JointFace]

    def unknown(self, name: str) -> bool:
        """Whether a face or edge was not measured: the report has no band of it."""
        return self.entries is not None and self.entries.get(name, {}).get("band") is None

    def of_face(self, name: str, uv: Array, box: tuple[float, float, float, float], points: Array,
                normals: Array) -> ErrorField:
        """Errors of points (n, 3) of a face along their normals (n, 3), at parameters (n, 2) in (u0, u1, v0, v1)."""
        if self.entries is None or self.unknown(name):
            return no_errors(len(uv))
        entry = self.entries[name]
        sigma = np.full(len(uv), float(entry["band"]) / _FACE_QUANTILE)
        if name in self.joint and len(self.joint[name].uv):
            face = self.joint[name]
            scale = np.array([max(box[1] - box[0], 1e-300), max(box[3] - box[2], 1e-300)])
            sigma = face.bands[cKDTree(face.uv / scale).query(uv / scale)[1]] / _FACE_QUANTILE
        counts = [max(_LEAST_CONTROLS, int(count)) for count in entry["lattice"] or (_LEAST_CONTROLS,) * 2]
        rows = [_rows(uv[:, axis], box[2 * axis], box[2 * axis + 1], counts[axis]) for axis in (0, 1)]
        near = (rows[0][:, :, None] * rows[1][:, None, :]).reshape(len(uv), -1)
        return ErrorField(_mixed(near, _motions(points, normals), sigma), normals[:, None, :])

    def of_edge(self, name: str, fractions: Array, across: Array) -> ErrorField:
        """Errors of points (n, 3) of an edge at ``fractions`` (n,) along the two directions ``across`` it (n, 2, 3)."""
        if self.entries is None or self.unknown(name):
            return no_errors(len(fractions))
        entry = self.entries[name]
        bands = np.atleast_1d(np.array(entry.get("along", {}).get("bands") or [entry["band"]], dtype=float))
        sigma = np.interp(fractions, np.linspace(0.0, 1.0, len(bands)), bands) / _EDGE_QUANTILE
        near = _rows(fractions, 0.0, 1.0, _EDGE_CONTROLS)
        return ErrorField(_mixed(near, _straight(fractions, 0.0, 1.0), sigma), across)


def known_errors(report: Any, faces: Sequence[JointFace] = ()) -> KnownErrors:
    """What a registration's report knows, and its faces where they are at hand; without a report all is exact.

    Raises
    ------
    InputError : it is no such report
    """
    if report is None:
        return KnownErrors(None, {})
    try:
        entries = {str(entry["name"]): entry for entry in [*report["faces"], *report.get("edges", [])]}
        for entry in entries.values():
            float(entry["band"] or 0.0)
    except (TypeError, KeyError, ValueError) as error:
        raise InputError("The report has no faces with bands: name what register wrote with --report.") from error
    return KnownErrors(entries, {face.name: face for face in faces})


def _rows(x: Array, start: float, end: float, count: int) -> Array:
    return basis_matrix(clamped_knots(start, max(end, start + 1e-12), count), np.clip(x, start, end))


def _sized(basis: Array, sigma: Array) -> Array:
    """Rows of the given size."""
    return np.asarray(basis / np.linalg.norm(basis, axis=1, keepdims=True) * sigma[:, None])


def _straight(x: Array, start: float, end: float) -> Array:
    """A shift and a tilt over a range, (n, 2), of variance one on the mean."""
    return np.column_stack([np.ones(len(x)), np.sqrt(12.0) * ((x - start) / max(end - start, 1e-300) - 0.5)])


def _motions(points: Array, normals: Array) -> Array:
    """What rigid motions and growth of a face do along its normals: (n, k) columns of one size, across each other."""
    off = points - points.mean(axis=0)
    size = max(float(np.linalg.norm(off, axis=1).max()), 1e-300)
    rows = np.column_stack([normals, np.cross(off / size, normals), np.ones(len(points))])
    left, values, _ = np.linalg.svd(rows, full_matrices=False)
    return np.asarray(left[:, values > _SAME_MOTION * values[0]])


def _mixed(near: Array, far: Array, sigma: Array) -> Array:
    """Errors of a size of which half of the variance reaches near, and half far."""
    return np.hstack([_sized(near, np.sqrt(0.5) * sigma), _sized(far, np.sqrt(0.5) * sigma)])
