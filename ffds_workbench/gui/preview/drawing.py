# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preview in the 3D view: deformed faces in the colours of their deviation, the others as they are, lattices."""
from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import Part

from ..view3d.colours import packed_colours
from ..view3d.overlay import ColouredMesh, Overlay, lattice_nodes, lines_node, shaded_node
from .patches import Patch

PLAIN, FROZEN = (0.78, 0.8, 0.82), (0.38, 0.55, 0.75)
_DEFLECTION = 1 / 800
"""Of the part's size, in the drawing of faces that are not deformed."""


class PreviewDrawing:
    """Draws patches into an overlay; nodes of faces that stay the same are kept."""

    def __init__(self, overlay: Overlay) -> None:
        self._overlay = overlay
        self._meshes: list[ColouredMesh] = []
        self._others: tuple[Any, Any] | None = None

    def show(self, shape: Part.Shape, patches: Sequence[Patch], frozen: Collection[str], limit: float,
             with_lattice: bool, frame: Any) -> None:
        """Draw a part in its own frame, ``frame`` (4, 4) taking it to the document's."""
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
                            *lattice_nodes(lattices)], frame)

    def _rest(self, shape: Part.Shape, deformed: frozenset[str], frozen: frozenset[str]) -> Any:
        """The faces that are not deformed, and the edges that are not theirs."""
        key = shape, deformed, frozen
        if self._others is None or self._others[0] != key:
            self._others = key, _plain_faces(shape, deformed, frozen)
        return self._others[1]


def _plain_faces(shape: Part.Shape, deformed: Collection[str], frozen: Collection[str]) -> Any:
    from pivy import coin

    group = coin.SoGroup()
    deflection = max(shape.BoundBox.DiagonalLength * _DEFLECTION, 1e-3)
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
