# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same places on every part of a series, and how far each part has moved there."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from ..api import Result
from ..brep.joint_part import EDGE_SAMPLES
from ..brep.topology import points_on_edge
from ..brep.workpiece import Workpiece
from ..registration.arrays import Array
from ..registration.uv_raster import make_raster
from .told import SeriesPlaces

_CELLS = 100
"""Of a face: a lattice has some eleven spans over a part's size (theory), so that a face has as many places or more."""
_TWO_SIDED = 1.96
_FRACTIONS = np.linspace(0.0, 1.0, EDGE_SAMPLES)


@dataclass(frozen=True)
class PartPlaces:
    """Places on the faces and along the edges of a model.

    Attributes
    ----------
    places : where they are, and how much of the part each stands for
    uv : of each face, (k, 2) parameters of its places
    """

    places: SeriesPlaces
    uv: tuple[Array, ...]


def places_of(part: Workpiece) -> PartPlaces:
    """Places on the nominal part."""
    position, normal, weight, owner, uv = [], [], [], [], []
    for index, face in enumerate(part.faces):
        raster = make_raster(part.geometry(index), _CELLS)
        inside = raster.inside
        position.append(raster.position[inside])
        normal.append(raster.normal[inside])
        weight.append(raster.area[inside])
        owner += [face.name] * int(inside.sum())
        grid = np.stack(np.meshgrid(raster.u, raster.v, indexing="ij"), axis=2).reshape(-1, 2)
        uv.append(grid[inside])
    for number, edge in enumerate(part.edges, 1):
        if not edge.Degenerated:
            position.append(points_on_edge(edge, _FRACTIONS))
            normal.append(np.zeros((EDGE_SAMPLES, 3)))
            weight.append(np.zeros(EDGE_SAMPLES))
            owner += [f"Edge{number}"] * EDGE_SAMPLES
    areas = np.concatenate(weight)
    places = SeriesPlaces(np.concatenate(position), np.concatenate(normal), areas / areas.sum(), np.array(owner))
    return PartPlaces(places, tuple(uv))


def displacement(result: Result, known: PartPlaces) -> tuple[Array, Array]:
    """How a part has moved: (n, 3) in mm at all places, and (n,) the standard deviation of its measurement there, NaN
    where nothing tells."""
    places, moved, sigma = known.places, np.zeros_like(known.places.position), np.full(len(known.places.owner), np.nan)
    joint, first = result.joint, 0
    for index, uv in enumerate(known.uv):
        own = slice(first, first + len(uv))
        first += len(uv)
        if index in result.found.displacements and len(uv):
            moved[own] = result.found.displacements[index].evaluate(uv, places.position[own])
        if joint is not None and len(uv) and len(joint.faces[index].uv):
            face = joint.faces[index]
            nearest = cKDTree(result.part.geometry(index).surface(face.uv)).query(places.position[own])[1]
            sigma[own] = face.bands[nearest] / _TWO_SIDED
    for number, edge in enumerate(result.shape.Edges):
        if edge.Degenerated:
            continue
        own = slice(first, first + EDGE_SAMPLES)
        first += EDGE_SAMPLES
        moved[own] = points_on_edge(edge, _FRACTIONS) - places.position[own]
        if joint is not None and len(joint.edges[number].bands) == EDGE_SAMPLES:
            sigma[own] = joint.edges[number].bands / _TWO_SIDED
    return moved, np.where(np.isfinite(sigma), sigma, np.nan)


def write_field(path: Path, moved: Array, sigma: Array) -> None:
    """Keep what a part has moved, to the nanometre or so."""
    np.savez(path, displacement=moved.astype(np.float32), sigma=sigma.astype(np.float32))
