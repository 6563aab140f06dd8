# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preview in the 3D view: deformed faces in the colours of their deviation, the others as they are, lattices."""
from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import Part
from scipy.spatial import cKDTree

from ...objects.jobs.registration_job import Job
from ..view3d.colours import packed_colours
from ..view3d.overlay import ColouredMesh, Overlay, lattice_nodes, lines_node, mesh_node, points_node, shaded_node
from .patches import Patch

PLAIN, FROZEN = (0.78, 0.8, 0.82), (0.38, 0.55, 0.75)
PICKED, WRONG, SHOWN = 0xF29A2EFF, 0xC9352BFF, 0x2E9E4FFF
"""Packed colours of faces that are picked, that the scan does not show, and that it shows instead."""
REST = 0x2673BF66
"""Packed colour of scan points that do not lie on a previewed face: half transparent."""
_RESTING = 15_000
"""Scan points that are drawn beside the previewed faces (unit: a picture hardly changes with more)."""
_BESIDE = 0.02
"""Of the part's size: scan points nearer than this to the corners of a previewed face's cells are its own (unit: what
lies farther off is worth a pick)."""
_DEFLECTION = 1 / 800
"""Of the part's size, in the drawing of faces that are not deformed."""


class PreviewDrawing:
    """Draws patches into an overlay; nodes of faces that stay the same are kept."""

    def __init__(self, overlay: Overlay) -> None:
        self._overlay = overlay
        self._meshes: list[ColouredMesh] = []
        self._others: tuple[Any, Any] | None = None
        self._left: tuple[Any, tuple[str, ...], Any] | None = None

    def show(self, job: Job, patches: Sequence[Patch], limit: float, with_lattice: bool) -> None:
        """Draw what a job makes of its part."""
        shape, frozen = job.source.model.shape, job.request.freeze
        scanned = [patch for patch in patches if patch.registered]
        if [mesh.triangles is patch.triangles for mesh, patch in zip(self._meshes, scanned, strict=False)] != (
                [True] * max(len(scanned), len(self._meshes))):
            self._meshes = [ColouredMesh(patch.triangles, over=False) for patch in scanned]
        for mesh, patch in zip(self._meshes, scanned, strict=True):
            mesh.update(patch.points, packed_colours(patch.values, limit))
        lattices = [patch.lattice for patch in patches if patch.lattice is not None] if with_lattice else []
        others = self._rest(shape, frozenset(patch.name for patch in patches), frozenset(frozen))
        outlines = lines_node([line for patch in patches for line in patch.outline])
        adapting = [shaded_node(patch.points, patch.triangles, PLAIN) for patch in patches if not patch.registered]
        self._overlay.show([others, outlines, *adapting, *(mesh.node for mesh in self._meshes),
                            *lattice_nodes(lattices), *self._points_left(job, scanned)], job.source.T_document_part)

    def _points_left(self, job: Job, scanned: Sequence[Patch]) -> list[Any]:
        """The scan beside the faces that it deforms: there are more to pick."""
        key = job.scan, tuple(patch.name for patch in scanned)
        if self._left is None or self._left[0] is not key[0] or self._left[1] != key[1]:
            points = job.scan.points[:: max(1, len(job.scan.points) // _RESTING)]
            corners = np.concatenate([patch.points[np.unique(patch.triangles)] for patch in scanned])
            far = cKDTree(corners).query(points)[0] > _BESIDE * job.source.model.shape.BoundBox.DiagonalLength
            self._left = *key, points[far]
        points = self._left[2]
        return [points_node(points, np.full(len(points), REST, dtype=np.uint32), 2.0)] if len(points) else []

    def _rest(self, shape: Part.Shape, deformed: frozenset[str], frozen: frozenset[str]) -> Any:
        """The faces that are not deformed, and the edges that are not theirs."""
        key = shape, deformed, frozen
        if self._others is None or self._others[0] != key:
            self._others = key, _plain_faces(shape, deformed, frozen)
        return self._others[1]


def marks(shape: Part.Shape, colours: Mapping[str, int]) -> list[Any]:
    """Faces of a shape in one packed colour each, drawn over the part."""
    nodes = []
    for name, colour in colours.items():
        points, triangles = shape.Faces[int(name[4:]) - 1].tessellate(_fineness(shape))
        if triangles:
            nodes.append(mesh_node(np.array([tuple(point) for point in points]), np.array(triangles),
                                   np.full(len(points), colour, dtype=np.uint32)))
    return nodes


def _fineness(shape: Part.Shape) -> float:
    return max(shape.BoundBox.DiagonalLength * _DEFLECTION, 1e-3)


def _plain_faces(shape: Part.Shape, deformed: Collection[str], frozen: Collection[str]) -> Any:
    from pivy import coin

    group = coin.SoGroup()
    deflection = _fineness(shape)
    edges = []
    for number, face in enumerate(shape.Faces, 1):
        name = f"Face{number}"
        if name in deformed:
            continue
        points, triangles = face.tessellate(deflection)
        edges += face.Edges
        if triangles:
            colour = FROZEN if name in frozen else PLAIN
            group.addChild(shaded_node(np.array([tuple(point) for point in points]), np.array(triangles), colour))
    lines = [np.array([tuple(point) for point in edge.discretize(24)]) for edge in edges if not edge.Degenerated]
    if lines:
        group.addChild(lines_node(lines))
    return group
