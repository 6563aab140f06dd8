# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows that tie control points of different faces: shared edges, poles, thickness, edge angles, frozen faces, pose.

All of them are linear in the displacement with constant coefficients; where a rotation enters, it is the current one,
on the right-hand side.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_matrix, csr_matrix, diags, vstack

from ...arrays import Array
from ..lengths import Lengths
from ..settings import JointSettings
from ..surfaces import JointPart, Lattices, places_on_faces
from .shared_edges import SharedEdgePlaces, shared_edge_places
from .sheet_pairs import SheetPairs

_FROZEN = 0.1
"""Standard deviation of faces that must not move, over that with which faces agree along an edge (unit: far less)."""
_POSE_SHARE, _CONTACT_SHARE = 1e-5, 1e-3
"""Weight of the pose, and of all contacts of two solids, over what the whole scan weighs (unit: no observed motion
feels so little)."""
_METRIC_RIDGE = 1e-9
"""Of a metric's trace, added to it where tangents are parallel (theory: far above rounding)."""
_SMOOTH_ANGLE = 0.2
"""Angle in rad up to which faces count as one smooth surface, which stays smooth however it deforms (unit: 11°)."""


@dataclass(frozen=True)
class CouplingMatrices:
    """Normal matrices of the couplings that have weights of their own, needed once.

    Attributes
    ----------
    shear : (controls, controls) of d_back − d_front, the same for x, y and z
    smooth, dihedral : (3 controls, 3 controls) of the angles of smooth edges and of all others
    """

    shear: csr_matrix
    smooth: bsr_matrix
    dihedral: bsr_matrix

    @property
    def graphs(self) -> list[csr_matrix]:
        """Scalar patterns (controls, controls) of all."""
        return [self.shear, *(csr_matrix((np.ones(len(matrix.indices)), matrix.indices, matrix.indptr),
                                         shape=self.shear.shape) for matrix in (self.smooth, self.dihedral))]


@dataclass(frozen=True)
class Couplings:
    """Constant rows and what is needed for their right-hand sides.

    Attributes
    ----------
    scalar : (controls, controls) normal matrix of edges, poles, frozen faces and pose; the same for x, y and z
    pairs, edges : the places that are coupled
    hinges : the places on edges where there is an angle, the samples of what follows
    pair_normal : (pairs, 3) nominal normal of the sheets
    angle : (samples,) nominal angle of the edges in rad
    thickness_rows : (pairs, controls) d_back − d_front
    thickness_weight : (pairs,) 1/mm²
    dihedral_rows : (samples, 3 controls) change of the angle between the faces
    dihedral_weight : (samples,) 1/rad²
    sharp : (samples,) whether the faces meet at an angle

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    trust : factor on the weight of sharp edges' angles
    """

    scalar: csr_matrix
    pairs: SheetPairs
    edges: SharedEdgePlaces
    hinges: SharedEdgePlaces
    pair_normal: Array
    angle: Array
    thickness_rows: csr_matrix
    thickness_weight: Array
    dihedral_rows: bsr_matrix
    dihedral_weight: Array
    sharp: NDArray[np.bool_]

    def matrices(self) -> CouplingMatrices:
        """Normal matrices of what is not in ``scalar`` and stays the same at every shape."""
        shear = (self.thickness_rows.T @ diags(self.thickness_weight) @ self.thickness_rows).tocsr()
        return CouplingMatrices(shear, *(_normal_matrix(self.dihedral_rows.tocsr()[which].tobsr((1, 3)),
                                                        self.dihedral_weight[which])
                                         for which in (~self.sharp, self.sharp)))

    def thickness_load(self, control_points: Array, thickness: float, shear: float, normal: Array) -> Array:
        """Gradient towards d_back − d_front = −t (n − n₀), Kirchhoff's straight normals: (controls, 3).

        ``thickness`` and ``shear`` weigh the parts along ``normal``, (pairs, 3), and across it.
        """
        across, along = self.thickness_misfit(control_points, normal)
        misfit = thickness * across[:, None] * normal + shear * along
        return -(self.thickness_rows.T @ (self.thickness_weight[:, None] * misfit))

    def thickness_misfit(self, control_points: Array, normal: Array) -> tuple[Array, Array]:
        """d_back − d_front + t (n − n₀): along ``normal`` (pairs, 3), (pairs,), and what is left across it, (pairs, 3).

        Along the current normal it is the change of the distance between the skins, wherever they slide to.
        """
        if not len(self.pairs.thickness):
            return np.zeros(0), np.zeros((0, 3))
        turned = self.sheet_normals(control_points) - self.pair_normal
        misfit = self.thickness_rows @ control_points + self.pairs.thickness[:, None] * turned
        across = np.einsum("nx,nx->n", misfit, normal)
        return across, misfit - across[:, None] * normal

    def thickness_matrix(self, normal: Array) -> bsr_matrix:
        """Normal matrix of d_back − d_front along ``normal``, (pairs, 3): (3 controls, 3 controls)."""
        return _normal_matrix(_along(self.thickness_rows, normal), self.thickness_weight)

    def sheet_normals(self, control_points: Array) -> Array:
        """Current normals of the sheets at the pairs, from both skins: (pairs, 3)."""
        return _sheet_normals(self.pairs, control_points)

    def dihedral_load(self, control_points: Array, trust: float) -> Array:
        """Gradient that brings every edge back to its nominal angle, sharp ones as far as trusted: (controls, 3)."""
        weight = np.where(self.sharp, trust, 1.0) * self.dihedral_weight
        return -(self.dihedral_rows.T @ (weight * self.angle_change(control_points))).reshape(-1, 3)

    def angle_change(self, control_points: Array) -> Array:
        """Change of the angles of the edges from the nominal ones, (samples,) in rad."""
        change = _angle(self.hinges, control_points) - self.angle
        return np.mod(change + np.pi, 2 * np.pi) - np.pi

    def measured_thickness(self, control_points: Array) -> Array:
        """Current thickness at the pairs in mm."""
        normal = _sheet_normals(self.pairs, control_points)
        gap = (self.pairs.front.nominal[0] + self.pairs.front.displacement(control_points)
               - self.pairs.back.nominal[0] - self.pairs.back.displacement(control_points))
        return np.einsum("nx,nx->n", gap, normal)


def make_couplings(part: JointPart, lattices: Lattices, pairs: SheetPairs, contacts: csr_matrix,
                   settings: JointSettings, lengths: Lengths, information: float) -> Couplings:
    """All constant rows of a part; ``information`` in 1/mm² is what the whole scan weighs, ``contacts`` the rows of
    `contact_rows`.

    Parameters
    ----------
    lattices : of all faces
    pairs : places on opposite skins of sheets
    settings : weights of the priors
    lengths : of the solve
    """
    count = lattices.count
    edges = shared_edge_places(part, lattices)
    rows = vstack([edges.first.matrix(count) - edges.second.matrix(count), _pole_rows(part, lattices)]).tocsr()
    thickness_rows = pairs.back.matrix(count) - pairs.front.matrix(count)
    # Pairs are independent once per square of the thickness; closer ones share that weight.
    thickness_weight = (np.minimum(pairs.area / np.maximum(pairs.thickness, 1e-9) ** 2, 1.0)
                        / pairs.give**2)
    hinges = edges.take(edges.angled)
    dihedral_rows = _dihedral_rows(hinges, lattices)
    dihedral_weight = hinges.length / max(edges.length.sum(), 1e-12) * len(edges.edge) / settings.dihedral_sigma**2
    scalar = (lengths.edge_agreement**-2 * (rows.T @ rows) + _CONTACT_SHARE * information * (contacts.T @ contacts)
              + diags(_anchor(part, lattices, lengths, information)))
    still = np.zeros((count, 3))
    normal = _sheet_normals(pairs, still)
    angle = _angle(hinges, still)
    return Couplings(scalar.tocsr(), pairs, edges, hinges, normal, angle, thickness_rows, thickness_weight,
                     dihedral_rows, dihedral_weight, np.abs(angle) > _SMOOTH_ANGLE)


def pose_weight(lengths: Lengths, information: float) -> float:
    """Weight of the prior on the pose of a solid, in 1/mm².

    Parameters
    ----------
    lengths : of the solve
    information : what the whole scan weighs, in 1/mm²
    """
    return max(lengths.pose**-2, _POSE_SHARE * information)


def _anchor(part: JointPart, lattices: Lattices, lengths: Lengths, information: float) -> Array:
    """Weight of d = 0 on every control point: frozen faces, and the prior that a solid sits where it belongs.

    The prior also has a small share of the scan's weight, too little to affect any observed motion: an unobserved
    motion (a body of revolution about its axis) must not follow residual errors elsewhere.
    """
    weight = np.zeros(lattices.count)
    prior = pose_weight(lengths, information)
    for solid in part.solids:
        own = np.isin(lattices.face_of_control, solid)
        weight[own] = prior / max(own.sum(), 1)
    weight[np.isin(lattices.face_of_control, list(part.frozen))] = (_FROZEN * lengths.edge_agreement) ** -2
    return weight


def _sheet_normals(pairs: SheetPairs, control_points: Array) -> Array:
    """Normal of a sheet at the pairs, from both skins: (pairs, 3)."""
    mean = pairs.front.normals(control_points) - pairs.back.normals(control_points)
    return mean / np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-12)


def _along(rows: csr_matrix, direction: Array) -> bsr_matrix:
    """Rows (n, controls) that hold for x, y and z, taken along directions (n, 3): (n, 3 controls)."""
    row = np.repeat(np.arange(rows.shape[0]), np.diff(rows.indptr))
    values = rows.data[:, None] * direction[row]
    return bsr_matrix((values[:, None], rows.indices, rows.indptr), shape=(rows.shape[0], 3 * rows.shape[1]))


def _normal_matrix(rows: bsr_matrix, weight: Array) -> bsr_matrix:
    """Σ weight rowᵀ row in 3 × 3 blocks, of rows (n, 3 controls) in blocks of three."""
    weighted = rows.data * np.repeat(weight, np.diff(rows.indptr))[:, None, None]
    return rows.T @ bsr_matrix((weighted, rows.indices, rows.indptr), shape=rows.shape)


def _pole_rows(part: JointPart, lattices: Lattices) -> csr_matrix:
    """d is the same all along a degenerate edge."""
    blocks = [csr_matrix((0, lattices.count))]
    for shared in part.edges:
        if shared.degenerate:
            for face, uv in zip(shared.faces, shared.uv, strict=True):
                row = places_on_faces(part.faces, lattices, np.full(len(uv), face), uv).matrix(lattices.count)
                blocks.append(row[1:] - row[:-1])
    return vstack(blocks).tocsr()


def _angle(edges: SharedEdgePlaces, control_points: Array) -> Array:
    """Signed angle between the outward normals about the edge's direction: (samples,)."""
    first, second = edges.first.normals(control_points), edges.second.normals(control_points)
    sine = np.einsum("nx,nx->n", np.cross(first, second), edges.direction)
    return np.arctan2(sine, np.einsum("nx,nx->n", first, second))


def _dihedral_rows(edges: SharedEdgePlaces, lattices: Lattices) -> bsr_matrix:
    """Change of `_angle` by the control points, to first order about the nominal shape: (samples, 3 controls).

    A face turns about the edge's direction t by n·∂d/∂m, with m = t × n the direction in the face across the edge.
    """
    sides = []
    for side in (edges.first, edges.second):
        normal = side.normals(np.zeros((lattices.count, 3)))
        across = np.cross(edges.direction, normal)
        tangents = side.tangents(np.zeros((lattices.count, 3)))
        metric = np.einsum("anx,bnx->nab", tangents, tangents)
        metric += _METRIC_RIDGE * np.trace(metric, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        slope = np.linalg.solve(metric, np.einsum("anx,nx->na", tangents, across)[:, :, None])[:, :, 0]
        derivative = np.einsum("na,anc->nc", slope, side.weights[1:])
        values = derivative[:, :, None] * normal[:, None, :]
        start = np.arange(len(side) + 1) * 16
        sides.append(bsr_matrix((values.reshape(-1, 1, 3), side.controls.ravel(), start),
                                shape=(len(side), 3 * lattices.count)))
    return sides[0] - sides[1]
