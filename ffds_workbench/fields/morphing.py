# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a field to the displacements of a part's faces: one continuous field in space closes every edge by itself.

Bodies that share no vertex may move apart: each gets a field of its own where the vectors name their faces.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..brep.continuity import side_lengths
from ..brep.face_displacement import FaceDisplacement
from ..brep.workpiece import Workpiece, WorkpieceFace
from ..errors import InputError
from ..registration.arrays import Array
from ..registration.space import SpaceField
from .field import VectorField

_STILL = 1e-9
"""A face stays as it is where nothing of it moves by more than this (mm; unit: far below what the fit of a surface
leaves)."""
_LINES = 25
"""Most lines that seed a face's lattice: from there on it is refined where it has to be (unit: time)."""
_CELLS_PER_LINE = 4.0
"""Cells of the field in space from one of these lines to the next (unit: time)."""
_AROUND = 17
"""Vectors around one, itself among them, that tell what it should be like (unit: half of them may be wild)."""
_FARTHEST = 0.25
"""Over the size of the part: vectors farther from it belong to another part, or to one that stands elsewhere (unit:
fields of meshes may reach beyond the model)."""


@dataclass(frozen=True)
class Misses:
    """How closely the field in space follows the vectors it was made of.

    Attributes
    ----------
    positions : (n, 3) of all vectors, in mm
    distance : (n,) of the moved places from where the vectors lead, in mm, before the factor; of vectors that move no
        body, their length
    ignored : (n,) whether a vector was left out
    """

    positions: Array
    distance: Array
    ignored: NDArray[np.bool_]

    def beyond(self, tolerance: float) -> NDArray[np.intp]:
        """The vectors that are missed by more than a tolerance in mm, worst first."""
        worst = np.argsort(-self.distance, kind="stable")
        return worst[self.distance[worst] > tolerance]


@dataclass(frozen=True)
class Morphing:
    """What a field does to a part.

    Attributes
    ----------
    displacements : by face index, of every face that moves
    misses : how closely the vectors are followed
    largest : displacement in mm that is applied
    """

    displacements: dict[int, FaceDisplacement]
    misses: Misses
    largest: float


@dataclass(frozen=True)
class _InSpace:
    """A field in space as `FaceDisplacement.evaluate` takes it."""

    field: SpaceField

    def __call__(self, uv: Array, points: Array) -> Array:
        return self.field(points)


def displacements(part: Workpiece, field: VectorField, factor: float = 1.0, ignore: float = 0.0) -> Morphing:
    """The displacements of a part's faces by a field.

    Parameters
    ----------
    part : the nominal part
    field : of it
    factor : that it is multiplied with; 0 leaves the part as it is
    ignore : share of the vectors, the ones that agree least with those around them, that may be left out

    Raises
    ------
    InputError : the factor or the share makes no sense, or the field lies elsewhere than the part
    """
    if not np.isfinite(factor):
        raise InputError(f"A factor of {factor} makes no sense: 1 applies the field, -1 its reverse.")
    if not 0.0 <= ignore < 1.0:
        raise InputError(f"A share of {ignore:g} vectors to ignore makes no sense: give one from 0 to below 1.")
    _refuse_elsewhere(part, field)
    ignored = _least_agreeing(field, ignore)
    used = field.take(~ignored) if ignored.any() else field
    misses = np.linalg.norm(field.displacements, axis=1)
    moved: dict[int, FaceDisplacement] = {}
    for faces, rows in _bodies(part, used):
        in_space = used.take(rows).in_space if len(rows) < len(used) else used.in_space
        mine = _rows_of(field, faces) if len(rows) < len(used) else np.arange(len(field))
        misses[mine] = np.linalg.norm(in_space(field.positions[mine]) - field.displacements[mine], axis=1)
        scaled = in_space.scaled(factor)
        for index in faces:
            found = _face_displacement(part.faces[index], scaled) if factor else None
            if found is not None:
                moved[index] = found
    return Morphing(moved, Misses(field.positions, misses, ignored), abs(factor) * used.largest)


def _refuse_elsewhere(part: Workpiece, field: VectorField) -> None:
    box = part.shape.BoundBox
    low, high = np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])
    beyond = np.linalg.norm(np.maximum(np.maximum(low - field.positions, field.positions - high), 0.0), axis=1)
    far = beyond > _FARTHEST * box.DiagonalLength
    if far.any():
        raise InputError(f"{int(far.sum())} of {len(field)} vectors of the field lie up to {beyond.max():.3g} mm off "
                         f"the part: take the part that the field was made of, where it stood, in mm.")


def _least_agreeing(field: VectorField, share: float) -> NDArray[np.bool_]:
    """The share of vectors that are farthest from the median of those around them."""
    out = np.zeros(len(field), dtype=bool)
    count = int(share * len(field))
    if count:
        around = cKDTree(field.positions).query(field.positions, min(_AROUND, len(field)))[1].reshape(len(field), -1)
        usual = np.median(field.displacements[around], axis=1)
        out[np.argsort(-np.linalg.norm(field.displacements - usual, axis=1), kind="stable")[:count]] = True
    return out


def _bodies(part: Workpiece, field: VectorField) -> list[tuple[Sequence[int], NDArray[np.intp]]]:
    """Faces that hang together by vertices, with the vectors that move them."""
    everything: list[tuple[Sequence[int], NDArray[np.intp]]] = [(range(len(part.faces)), np.arange(len(field)))]
    if field.faces is None or not (field.faces > 0).all():
        return everything
    groups = _connected(part)
    if len(groups) == 1:
        return everything
    return [(faces, rows) for faces in groups if len(rows := _rows_of(field, faces))]


def _rows_of(field: VectorField, faces: Sequence[int]) -> NDArray[np.intp]:
    assert field.faces is not None
    return np.flatnonzero(np.isin(field.faces - 1, list(faces)))


def _connected(part: Workpiece) -> list[list[int]]:
    """Faces that hang together by edges or vertices."""
    topology = part.topology
    faces, vertices = topology.counts["faces"], topology.counts["vertices"]
    pairs = [(face, faces + vertex) for face, own in enumerate(topology.face_vertices) for vertex in own]
    pairs += [(face, other) for edge in topology.edge_faces for face in edge for other in edge]
    rows, columns = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    size = faces + vertices
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    label = connected_components(graph, directed=False)[1][:faces]
    return [np.flatnonzero(label == number).tolist() for number in np.unique(label)]


def _face_displacement(face: WorkpieceFace, field: SpaceField) -> FaceDisplacement | None:
    """How a field moves a face; None where nothing of it moves."""
    box = face.box
    sides, lines = ((box.u0, box.u1), (box.v0, box.v1)), []
    for side, length in zip(sides, side_lengths(face), strict=True):
        count = int(np.clip(np.ceil(length / (_CELLS_PER_LINE * field.cell)), 1, _LINES))
        lines.append(np.linspace(*side, count + 1)[1:-1])
    dense = [np.linspace(*side, 4 * (len(own) + 1) + 9) for side, own in zip(sides, lines, strict=True)]
    if np.abs(field(face.on_grid(*dense).reshape(-1, 3))).max() <= _STILL:
        return None
    return FaceDisplacement(_InSpace(field), lines[0], lines[1])
