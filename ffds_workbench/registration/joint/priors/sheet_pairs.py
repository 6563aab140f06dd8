# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pairs of opposite places on a solid: the two skins of a thin sheet, and its dominant thickness."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ...face_geometry import FaceGeometry
from ..surfaces import FacePlaces, Lattices, SpanGrid, normals, places_on_faces

_NORMAL_SCALE = 1 / 6
"""Of the size of the solid: what a unit of difference between normals counts for when opposite places are looked for
(unit)."""
_OPPOSITE_COSINE = -0.95
"""Cosine of the normals of the two skins of a sheet at the most (unit: 18°)."""
_LEAST_SHEET_SHARE = 0.5
"""Of a solid's area, that has the same thickness where the solid is a sheet (unit: most of it)."""
_LEAST_SLENDERNESS = 5.0
"""Side of the square with the area of one skin, over the thickness, from which a solid is a sheet (unit: what is
stouter does not bend like one)."""
_SAME_THICKNESS = 0.08
"""Relative difference of thicknesses that are one (unit: sheets thin a little in bends)."""
_LEAST_RADIUS = 0.75
"""Of a convex skin, relative to the thickness (theory: an outer bend has the whole thickness or more, and at half of it
there is no mid surface): what is rounder, as the round of an edge, is no skin."""
_MASSIVE_GIVE = 0.003
"""Change of the distance between opposite faces of a massive part, over it: they move together (calibrated: by hand, on
the families of ``./ffds benchmark accuracy``)."""


@dataclass(frozen=True)
class SheetPairs:
    """Opposite places on the skins of all sheets and the faces of massive parts.

    Attributes
    ----------
    front, back : the places, pair by pair
    thickness : (n,) nominal distance in mm
    area : (n,) share of the skin in mm² that the pair stands for
    give : (n,) how much the distance may change, in mm
    solid_thickness : nominal thickness in mm of each solid, 0 where it is no sheet
    of_face : (faces,) nominal thickness in mm of the sheet whose skin the face is, 0 elsewhere
    """

    front: FacePlaces
    back: FacePlaces
    thickness: Array
    area: Array
    give: Array
    solid_thickness: tuple[float, ...]
    of_face: Array


def find_pairs(faces: tuple[FaceGeometry, ...], solids: tuple[Index, ...], lattices: Lattices, cells: SpanGrid,
               gauss: SpanGrid, area: Array, curvature: Array, sizes: Array, change: float) -> SheetPairs:
    """Pairs from the Gauss places (``area`` elements (spans, k)) to the cells opposite, through the material.

    Parameters
    ----------
    faces : of the part
    solids : faces (k,) of each solid
    lattices : of all faces
    gauss : the Gauss places
    curvature : (spans, k, 3) of the nominal faces there, as in `Stiffness`
    sizes : (faces,) size in mm of the solid of every face
    change : expected change of the thickness of a sheet, over it
    """
    roundest = _most_convex(curvature, area, lattices.face_of_span, len(faces))
    outward = tuple(normals(places.nominal, places.outward)[0] for places in (cells, gauss))
    found = [_pairs_of(solid, lattices, cells, gauss, area, outward, _NORMAL_SCALE * sizes[solid[0]])
             for solid in solids]
    of_face = np.zeros(len(faces))
    thickness_of_solid, kept = [], []
    for solid, pairs in zip(solids, found, strict=True):
        thickness, share, keep = _dominant(pairs, area[np.isin(lattices.face_of_span, solid)].sum())
        is_sheet = share >= _LEAST_SHEET_SHARE
        thickness_of_solid.append(thickness if is_sheet else 0.0)
        some, give = (pairs[keep], change) if is_sheet else (pairs, _MASSIVE_GIVE)
        kept.append(np.column_stack([some, give * some[:, 6]]))
        if is_sheet:
            skins = np.unique(pairs[keep][:, :2].astype(int))
            of_face[skins] = np.where(roundest[skins] * _LEAST_RADIUS * thickness < 1, thickness, 0.0)
    table = np.concatenate([np.zeros((0, 9)), *kept])
    table = table[table[:, 0] < table[:, 1]]
    both = places_on_faces(faces, lattices, table[:, :2].T.astype(np.intp).ravel(),
                           np.concatenate([table[:, 2:4], table[:, 4:6]]))
    front, back = np.arange(len(both)).reshape(2, -1)
    return SheetPairs(both.take(front), both.take(back), table[:, 6], table[:, 7], table[:, 8],
                      tuple(thickness_of_solid), of_face)


def _most_convex(curvature: Array, area: Array, face_of_span: Index, faces: int) -> Array:
    """Largest convex curvature of every face within its trims, (faces,) in 1/mm; at least 0."""
    first, mixed, second = np.moveaxis(curvature, -1, 0)
    convex = np.hypot(0.5 * (first - second), mixed / np.sqrt(2.0)) - 0.5 * (first + second)
    result = np.zeros(faces)
    np.maximum.at(result, face_of_span, np.where(area > 0, convex, 0.0).max(axis=1))
    return result


def _pairs_of(solid: Index, lattices: Lattices, cells: SpanGrid, gauss: SpanGrid, area: Array,
              outward: tuple[Array, ...], scale: float) -> Array:
    """Rows face, opposite face, u, v, opposite u, v, distance, area of one solid; ``outward`` are the normals at the
    cells and at the Gauss places, ``scale`` in mm is what a unit of difference between normals counts for."""
    spans = np.flatnonzero(np.isin(lattices.face_of_span, solid))
    span, cell = (index.ravel() for index in np.nonzero(cells.inside[spans]))
    span = spans[span]
    own_span, own = np.nonzero(gauss.inside[spans])
    own_span = spans[own_span]
    if not len(span) or not len(own):
        return np.zeros((0, 8))
    there, there_normal = cells.nominal.position[span, cell], outward[0][span, cell]
    here, normal = gauss.nominal.position[own_span, own], outward[1][own_span, own]
    tree = cKDTree(np.hstack([there, scale * there_normal]), balanced_tree=False, compact_nodes=False)
    near = tree.query(np.hstack([here, -scale * normal]))[1]
    offset, cosine = there[near] - here, np.einsum("nx,nx->n", normal, there_normal[near])
    depth = -np.einsum("nx,nx->n", offset, there_normal[near]) / np.where(cosine < -0.1, cosine, -1.0)
    hit = -depth[:, None] * normal - offset
    tangents = cells.nominal.tangents[span[near], cell[near]]
    metric = np.einsum("nax,nbx->nab", tangents, tangents)
    step = np.linalg.solve(metric, np.einsum("nax,nx->na", tangents, hit)[:, :, None])[:, :, 0]
    per_cell = lattices.step[span[near]] / np.sqrt(cells.inside.shape[1])
    good = (cosine < _OPPOSITE_COSINE) & (depth > 0) & (np.abs(step / per_cell) < 1.0).all(axis=1)
    uv, uv_back = parameters(lattices, gauss, own_span, own), parameters(lattices, cells, span[near], cell[near])
    face = lattices.face_of_span
    table = np.column_stack([face[own_span], face[span[near]], uv, uv_back + step, depth, area[own_span, own]])
    return table[good & (table[:, 0] != table[:, 1])]


def parameters(lattices: Lattices, places: SpanGrid, span: Index, place: Index) -> Array:
    """(u, v) of places given by span and number within the span: (n, 2).

    Parameters
    ----------
    lattices : of all faces
    place : (n, 3) in mm
    """
    uv = np.zeros((len(span), 2))
    faces = lattices.face_of_span[span]
    corner = np.array([f.corner for f in lattices.faces])[faces]
    first = np.array([f.first_span for f in lattices.faces])[faces]
    columns = np.array([f.spans[1] for f in lattices.faces])[faces]
    uv[:, 0] = (span - first) // columns
    uv[:, 1] = (span - first) % columns
    return corner + lattices.step[span] * (uv + places.local[place])


def _dominant(pairs: Array, whole_area: float) -> tuple[float, float, Array]:
    """Most frequent thickness by area, the share of the area that has it, and which pairs have it."""
    if not len(pairs):
        return 0.0, 0.0, np.zeros(0, dtype=bool)
    depth, area = pairs[:, 6], pairs[:, 7]
    order = np.argsort(depth)
    cumulative = np.concatenate([[0.0], np.cumsum(area[order])])
    high = np.searchsorted(depth[order], depth * (1 + _SAME_THICKNESS), side="right")
    low = np.searchsorted(depth[order], depth * (1 - _SAME_THICKNESS), side="left")
    mass = cumulative[high] - cumulative[low]
    best = float(depth[np.argmax(mass)])
    keep = np.abs(depth - best) <= _SAME_THICKNESS * best
    thickness = float(np.average(depth[keep], weights=area[keep]))
    slender = np.sqrt(0.5 * whole_area) >= _LEAST_SLENDERNESS * thickness
    return thickness, float(area[keep].sum() / whole_area) if slender else 0.0, keep
