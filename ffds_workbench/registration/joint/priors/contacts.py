# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where solids of an assembly touch: a motion that nothing observes (a pipe about its axis) follows the neighbour."""
from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, vstack
from scipy.spatial import cKDTree

from ...arrays import Array
from ..surfaces import JointPart, Lattices, SpanGrid, normals, places_on_faces
from .sheet_pairs import parameters

_CONTACT_GAP = 4e-4
"""Over the size of a solid: what lies nearer to it touches it (unit: twice as much as parts are made to fit)."""
_WITHIN_CELL = 0.75
"""Sizes of a cell from its centre within which places belong to it (theory: as of the scan's points)."""


def contact_rows(part: JointPart, lattices: Lattices, cells: SpanGrid, sizes: Array) -> csr_matrix:
    """Rows d_a − d_b, equal weights adding up to one per pair of solids: (contacts, controls).

    Contacts are places along the edges of one solid that lie on a face of another one.

    Parameters
    ----------
    part : the faces, edges and solids
    lattices : of all faces
    cells : places on all faces, span by span
    sizes : (faces,) size in mm of the solid of every face
    """
    owner = part.solid_of_face
    edges = [edge for edge in part.edges if edge.faces and not edge.degenerate]
    rows = [csr_matrix((0, lattices.count))]
    if len(part.solids) < 2 or not edges:
        return rows[0]
    point = np.concatenate([edge.points for edge in edges])
    face = np.concatenate([np.full(len(edge.points), edge.faces[0]) for edge in edges])
    uv = np.concatenate([edge.uv[0] for edge in edges])
    normal = normals(cells.nominal, cells.outward)[0]
    gap = _CONTACT_GAP * sizes[lattices.face_of_span]
    reach = gap + _cell_sizes(lattices, cells)
    for number in range(len(part.solids)):
        span, place = np.nonzero(cells.inside & (owner[lattices.face_of_span] == number)[:, None])
        if not len(span):
            continue
        own, within = cells.nominal.position[span, place], float(reach[span].max(initial=0.0))
        near_box = (point >= own.min(axis=0) - within) & (point <= own.max(axis=0) + within)
        other = np.flatnonzero((owner[face] != number) & near_box.all(axis=1))
        tree = cKDTree(own)
        near = tree.query(point[other], distance_upper_bound=within)[1]
        other, near = other[near < len(span)], near[near < len(span)]
        span, place = span[near], place[near]
        offset = point[other] - cells.nominal.position[span, place]
        tangents = cells.nominal.tangents[span, place]
        metric = np.einsum("nax,nbx->nab", tangents, tangents)
        step = np.linalg.solve(metric, np.einsum("nax,nx->na", tangents, offset)[:, :, None])[:, :, 0]
        size = lattices.step[span] / np.sqrt(cells.inside.shape[1])
        touching = ((np.abs(np.einsum("nx,nx->n", offset, normal[span, place])) < gap[span])
                    & (np.abs(step) < _WITHIN_CELL * size).all(axis=1))
        there = parameters(lattices, cells, span, place) + step
        for neighbour in np.unique(owner[face[other[touching]]]):
            which = np.flatnonzero(touching & (owner[face[other]] == neighbour))
            here = places_on_faces(part.faces, lattices, face[other[which]], uv[other[which]])
            opposite = places_on_faces(part.faces, lattices, lattices.face_of_span[span[which]], there[which])
            rows.append((here.matrix(lattices.count) - opposite.matrix(lattices.count)) / np.sqrt(len(which)))
    return vstack(rows).tocsr()


def _cell_sizes(lattices: Lattices, cells: SpanGrid) -> Array:
    """Length in mm of the sides of a cell together, the largest of every span: (spans,)."""
    sides = np.linalg.norm(cells.nominal.tangents, axis=3) * lattices.step[:, None] / np.sqrt(cells.inside.shape[1])
    return np.asarray(sides.sum(axis=2).max(axis=1))
