# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions of a solid within its own surface, which no scan shows: a pipe about its axis.

Those of a surface are the null space of Σ (n · motion)² (Gelfand and Guibas, Shape segmentation using local slippage
analysis, 2004). The solid stays where it was: the mean of its movement along each of them is kept at zero.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from ...arrays import Array, Index
from ..surfaces import JointPart, Lattices, SpanGrid, normals

_SLIDES = 1e-6
"""Mean square of the sine between a motion and the surface, below which it slides in itself (unit: a thousandth)."""


@dataclass(frozen=True)
class FreeMotions:
    """k motions of solids in themselves.

    Attributes
    ----------
    rows : (k, controls, 3) mean of the displacement along each, of the control points' displacement
    texts : one phrase each
    """

    rows: Array
    texts: tuple[str, ...]

    def hold(self, control_points: Array, step: Array, response: Array) -> Array:
        """The step without what moves along the motions: (controls, 3).

        Parameters
        ----------
        control_points, step : (controls, 3) in mm, before the step
        response : (k, controls, 3) steps that pulls along the motions cause
        """
        along = np.einsum("kcx,cx->k", self.rows, control_points + step)
        pulled = np.einsum("kcx,lcx->kl", self.rows, response)
        return np.asarray(step - np.einsum("k,kcx->cx", np.linalg.solve(pulled, along), response))


def find_free_motions(part: JointPart, lattices: Lattices, cells: SpanGrid, area: Array,
                      coupled: csr_matrix) -> FreeMotions:
    """Those of all solids of which no face is frozen, and which touch no other solid.

    Parameters
    ----------
    part : the faces, edges and solids
    lattices : of all faces
    cells : the raster over them
    area : (spans, k) of the cells in mm²
    coupled : (controls, controls) non-zero where control points are coupled
    """
    owner, pairs = part.solid_of_face[lattices.face_of_control], coupled.tocoo()
    touching = set(owner[pairs.row[owner[pairs.row] != owner[pairs.col]]].tolist())
    rows, texts = [np.zeros((0, lattices.count, 3))], []
    for number, solid in enumerate(part.solids):
        if number not in touching and part.frozen.isdisjoint(solid.tolist()):
            found, phrases = _of_solid(lattices, cells, area, solid)
            rows.append(found)
            texts += [f"Solid{number + 1} {phrase}" for phrase in phrases]
    return FreeMotions(np.concatenate(rows), tuple(texts))


def _of_solid(lattices: Lattices, cells: SpanGrid, area: Array, solid: Index) -> tuple[Array, list[str]]:
    """Rows (k, controls, 3) and phrases of one solid."""
    spans = np.flatnonzero(np.isin(lattices.face_of_span, solid))
    place, area = cells.nominal.position[spans], area[spans]
    normal = normals(cells.nominal, cells.outward)[0][spans]
    centre = np.average(place.reshape(-1, 3), axis=0, weights=area.ravel())
    arm = place - centre
    size = np.sqrt(np.average((arm**2).sum(axis=2), weights=area))
    motions = np.concatenate([np.cross(np.eye(3)[:, None, None], arm / size),
                              np.broadcast_to(np.eye(3)[:, None, None], (3, *arm.shape))])
    along = np.einsum("mskx,skx->msk", motions, normal)
    squares, axes = np.linalg.eigh(np.einsum("msk,nsk,sk->mn", along, along, area / area.sum()))
    free = axes[:, squares < _SLIDES].T
    fields = np.einsum("fm,mskx->fskx", free, motions) * (area / area.sum())[:, :, None]
    loads = np.matmul(cells.tables[0].T, fields)
    controls = lattices.controls[spans].ravel()
    rows = np.zeros((len(free), lattices.count, 3))
    for row, load in zip(rows, loads, strict=True):
        np.add.at(row, controls, load.reshape(-1, 3))
    return rows, [_phrase(motion[:3], motion[3:]) for motion in free]


def _phrase(turn: Array, shift: Array) -> str:
    """What a motion does: about or along which direction."""
    kind, axis = ("can turn about", turn) if np.linalg.norm(turn) > np.linalg.norm(shift) else (
        "can slide along", shift)
    axis = axis / np.linalg.norm(axis) * (1.0 if axis[np.argmax(np.abs(axis))] > 0 else -1.0)
    return kind + " ({:.2f}, {:.2f}, {:.2f})".format(*np.round(axis, 2) + 0.0)
