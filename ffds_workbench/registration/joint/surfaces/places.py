# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scattered places on the faces (along edges, opposite a sheet's skin): their control points, weights and geometry."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from ...arrays import Array, Index
from ...face_geometry import FaceGeometry
from .lattices import Lattices


@dataclass(frozen=True)
class FacePlaces:
    """n places, each on one face.

    Attributes
    ----------
    face : (n,)
    span : (n,)
    controls : (n, 16) control points of the spans
    weights : (3, n, 16) weights that give d, d_u and d_v
    nominal : (3, n, 3) S₀, S₀_u and S₀_v in mm
    outward : (n,) ±1

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    """

    face: Index
    span: Index
    controls: Index
    weights: Array
    nominal: Array
    outward: Array

    def __len__(self) -> int:
        return len(self.face)

    def displacement(self, control_points: Array) -> Array:
        """d at the places: (n, 3)."""
        return np.asarray(np.matmul(self.weights[0, :, None], control_points[self.controls])[:, 0])

    def tangents(self, control_points: Array) -> Array:
        """Current S_u and S_v: (2, n, 3)."""
        gathered = control_points[self.controls]
        return self.nominal[1:] + np.matmul(self.weights[1:, :, None], gathered)[:, :, 0]

    def normals(self, control_points: Array) -> Array:
        """Current unit normals out of the material: (n, 3)."""
        tangents = self.tangents(control_points)
        return _unit(np.cross(tangents[0], tangents[1])) * self.outward[:, None]

    @property
    def nominal_normals(self) -> Array:
        """Unit normals of the nominal faces out of the material: (n, 3)."""
        return _unit(np.cross(self.nominal[1], self.nominal[2])) * self.outward[:, None]

    def matrix(self, count: int, order: int = 0) -> csr_matrix:
        """Sparse rows that give d (or d_u, d_v: order 1, 2) from ``count`` control points: (n, count)."""
        start = np.arange(len(self) + 1) * 16
        return csr_matrix((self.weights[order].ravel(), self.controls.ravel(), start), shape=(len(self), count))

    def take(self, which: Index | NDArray[np.bool_]) -> FacePlaces:
        """Those of the places that ``which``, indices or a mask (n,), tells."""
        return FacePlaces(self.face[which], self.span[which], self.controls[which], self.weights[:, which],
                          self.nominal[:, which], self.outward[which])


def concatenate(first: FacePlaces, second: FacePlaces) -> FacePlaces:
    """Both, one after the other.

    Parameters
    ----------
    first : the places that come first
    second : those that follow
    """
    return FacePlaces(np.concatenate([first.face, second.face]), np.concatenate([first.span, second.span]),
                      np.concatenate([first.controls, second.controls]),
                      np.concatenate([first.weights, second.weights], axis=1),
                      np.concatenate([first.nominal, second.nominal], axis=1),
                      np.concatenate([first.outward, second.outward]))


def places_on_faces(faces: tuple[FaceGeometry, ...], lattices: Lattices, face: Index, uv: Array) -> FacePlaces:
    """Places at (u, v) (n, 2) on faces (n,), in the order given.

    Parameters
    ----------
    lattices : of all faces
    face : (n,) number of the face
    uv : (n, 2) parameters
    """
    n, orders = len(face), ((0, 0), (1, 0), (0, 1))
    span, local = np.zeros(n, dtype=np.intp), np.zeros((n, 2))
    nominal, outward = np.zeros((3, n, 3)), np.zeros(n)
    order = np.argsort(face, kind="stable")
    for index in np.unique(face):
        at = order[np.searchsorted(face[order], index) : np.searchsorted(face[order], index, side="right")]
        span[at], local[at] = lattices.faces[index].locate(uv[at])
        for k, (du, dv) in enumerate(orders):
            nominal[k, at] = faces[index].surface.derivative(du, dv)(uv[at])
        outward[at] = faces[index].outward
    weights = np.stack([lattices.weights(span, local, du, dv) for du, dv in orders])
    return FacePlaces(np.asarray(face, dtype=np.intp), span, lattices.controls[span], weights, nominal, outward)


def _unit(vectors: Array) -> Array:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
