# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coin nodes over the 3D view: coloured points and faces, control lattices. No document objects, not pickable."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCADGui as Gui
import numpy as np
from numpy.typing import NDArray
from pivy import coin

from ...objects.lattices import Lattice

Array = NDArray[np.float64]

BEFORE, AFTER = (0.42, 0.46, 0.52), (1.0, 0.45, 0.05)
"""Colours of the control lattice before and after."""


class Overlay:
    """One group of nodes in the view that was active when it was made; ``remove`` it in a ``finally``."""

    def __init__(self, document_name: str) -> None:
        # A view that was closed crashes when it is asked for its graph; the graph itself lives on while it is held.
        self._graph = Gui.getDocument(document_name).ActiveView.getSceneGraph()
        self._covered: list[tuple[Any, Any, Any]] = []
        self._changed: list[tuple[Any, Any]] = []
        self._root = coin.SoSeparator()
        self._root.addChild(_unpickable())
        self._frame = coin.SoMatrixTransform()
        self._root.addChild(self._frame)
        self._content = coin.SoGroup()
        self._root.addChild(self._content)
        self._graph.addChild(self._root)

    def show(self, nodes: Sequence[Any], frame: Array | None = None) -> None:
        """Show these nodes instead of the earlier ones; ``frame`` (4, 4) takes their coordinates to the document's."""
        if frame is not None:
            self._frame.matrix.setValue(coin.SbMatrix(*frame.T.ravel().tolist()))
        self._content.removeAllChildren()
        for node in nodes:
            self._content.addChild(node)

    def cover(self, *items: Any) -> None:
        """Leave these document objects, and no others, undrawn: they would hide the overlay. No property changes.

        They can still be picked.
        """
        wanted = list(dict.fromkeys(items))
        if [item for item, _, _ in self._covered] == wanted:
            return
        self._uncover()
        for item in wanted:
            style = coin.SoDrawStyle()
            style.style = coin.SoDrawStyle.INVISIBLE
            style.setOverride(True)
            group = coin.SoGroup()
            group.addChild(style)
            root = item.ViewObject.RootNode
            root.insertChild(group, 0)
            self._covered.append((item, root, group))

    def pick_through(self, items: Sequence[Any]) -> None:
        """Let clicks through these document objects to what lies behind them: scans lie on the faces that are meant."""
        for item in items:
            self._prefix(item, _unpickable())

    def fade(self, items: Sequence[Any], transparency: float) -> None:
        """Draw these document objects half transparent, 0 … 1, whatever their own properties say."""
        for item in items:
            material = coin.SoMaterial()
            material.transparency.setValue(transparency)
            for name in ("ambientColor", "diffuseColor", "specularColor", "emissiveColor", "shininess"):
                getattr(material, name).setIgnored(True)
            material.setOverride(True)
            self._prefix(item, material)

    def plain(self) -> None:
        """Draw and pick everything as it was again."""
        while self._changed:
            root, node = self._changed.pop()
            root.removeChild(node)

    def _prefix(self, item: Any, node: Any) -> None:
        root = item.ViewObject.RootNode
        root.insertChild(node, 0)
        self._changed.append((root, node))

    def _uncover(self) -> None:
        while self._covered:
            _, root, group = self._covered.pop()
            root.removeChild(group)

    def remove(self) -> None:
        """Take everything out of the view; harmless where the view is gone already."""
        self._uncover()
        self.plain()
        if self._graph.findChild(self._root) >= 0:
            self._graph.removeChild(self._root)


def foremost(view: Any, place: tuple[int, int], points: Array, pixels: int = 6) -> int | None:
    """Which of the points (n, 3) is drawn at ``place`` on the screen, in front of all others; None for none."""
    origin, beside = (np.array(view.getPoint(place[0] + shift, place[1])) for shift in (0, pixels))
    direction = np.array(view.getViewDirection())
    towards = points - origin
    depth = towards @ direction
    near = np.flatnonzero(np.einsum("ij,ij->i", towards, towards) - depth**2 < np.sum((beside - origin) ** 2))
    return int(near[np.argmin(depth[near])]) if len(near) else None


def points_node(points: Array, colours: NDArray[np.uint32], size: float = 3.0) -> Any:
    """Coloured points: (n, 3) in mm and (n,) packed colours."""
    node = coin.SoSeparator()
    node.addChild(_flat_light())
    style = coin.SoDrawStyle()
    style.pointSize = size
    node.addChild(style)
    node.addChild(_colours(colours, coin.SoMaterialBinding.PER_VERTEX))
    node.addChild(_coordinates(points))
    node.addChild(coin.SoPointSet())
    return node


class ColouredMesh:
    """A surface in the colours of the legend, unshaded. Its triangles, (m, 3) indices, stay; the rest may change.

    ``over`` draws it before what lies in it, a face of the part; else behind, as lines on it need.
    """

    def __init__(self, triangles: NDArray[np.integer], over: bool = True) -> None:
        self.triangles = triangles
        self.node = coin.SoSeparator()
        offset = coin.SoPolygonOffset()
        offset.factor = offset.units = -2.0 if over else 2.0
        self.node.addChild(offset)
        self.node.addChild(_flat_light())
        bound = coin.SoMaterialBinding()
        bound.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
        self.node.addChild(bound)
        self._packed, self._places = coin.SoPackedColor(), coin.SoCoordinate3()
        self.node.addChild(self._packed)
        self.node.addChild(self._places)
        self.node.addChild(_faces(triangles))

    def update(self, points: Array, colours: NDArray[np.uint32]) -> None:
        """Corners (n, 3) in mm and their packed colours (n,)."""
        self._places.point.setValues(0, len(points), np.ascontiguousarray(points, dtype=np.float32))
        self._packed.orderedRGBA.setValues(0, len(colours), np.ascontiguousarray(colours, dtype=np.uint32))


def mesh_node(points: Array, triangles: NDArray[np.integer], colours: NDArray[np.uint32], over: bool = True) -> Any:
    """A `ColouredMesh` that stays as it is: (n, 3) in mm, (m, 3) indices, (n,) packed colours."""
    mesh = ColouredMesh(triangles, over)
    mesh.update(points, colours)
    return mesh.node


def shaded_node(points: Array, triangles: NDArray[np.integer], colour: tuple[float, float, float]) -> Any:
    """A surface in one colour, lit: (n, 3) in mm, (m, 3) indices."""
    node = coin.SoSeparator()
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = 0.5
    node.addChild(hints)
    offset = coin.SoPolygonOffset()
    node.addChild(offset)
    material = coin.SoMaterial()
    material.diffuseColor = colour
    node.addChild(material)
    node.addChild(_coordinates(points))
    node.addChild(_faces(triangles))
    return node


def _faces(triangles: NDArray[np.integer]) -> Any:
    faces = coin.SoIndexedFaceSet()
    index = np.column_stack([triangles, np.full(len(triangles), -1)]).astype(np.int32).ravel()
    faces.coordIndex.setValues(0, len(index), index.tolist())
    return faces


def lines_node(lines: Sequence[Array]) -> Any:
    """Polylines in the colour of edges, each (k, 3) in mm."""
    return _lines(coin.SoSeparator(), lines, (0.1, 0.1, 0.12), 1.5)


def bright_node(line: Array) -> Any:
    """A polyline (k, 3) in mm that is meant, in front of everything."""
    return _lines(coin.SoAnnotation(), [line], AFTER, 6.0)


def lattice_nodes(lattices: Sequence[Lattice]) -> list[Any]:
    """Control lattices before and after: their rows and columns as lines, their control points as points."""
    if not lattices:
        return []
    return [_lattice_node([item.nominal for item in lattices], BEFORE, 1.0, 0.0),
            _lattice_node([item.deformed for item in lattices], AFTER, 1.5, 6.0)]


def _lattice_node(grids: Sequence[Array], colour: tuple[float, float, float], width: float, size: float) -> Any:
    lines = [row for grid in grids for row in (*grid, *grid.swapaxes(0, 1))]
    # An annotation is drawn in front of everything: most of a lattice lies just below its face.
    node = _lines(coin.SoAnnotation(), lines, colour, width)
    if size:
        style = coin.SoDrawStyle()
        style.pointSize = size
        node.addChild(style)
        node.addChild(_coordinates(np.concatenate([grid.reshape(-1, 3) for grid in grids])))
        node.addChild(coin.SoPointSet())
    return node


def _lines(node: Any, lines: Sequence[Array], colour: tuple[float, float, float], width: float) -> Any:
    node.addChild(_flat_light())
    base = coin.SoBaseColor()
    base.rgb.setValue(*colour)
    node.addChild(base)
    style = coin.SoDrawStyle()
    style.lineWidth = width
    node.addChild(style)
    node.addChild(_coordinates(np.concatenate(lines)))
    strips = coin.SoLineSet()
    counts = [len(line) for line in lines]
    strips.numVertices.setValues(0, len(counts), counts)
    node.addChild(strips)
    return node


def _unpickable() -> Any:
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    style.setOverride(True)
    return style


def _flat_light() -> Any:
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    return light


def _coordinates(points: Array) -> Any:
    node = coin.SoCoordinate3()
    node.point.setValues(0, len(points), np.ascontiguousarray(points, dtype=np.float32))
    return node


def _colours(colours: NDArray[np.uint32], binding: int) -> Any:
    group = coin.SoGroup()
    bound = coin.SoMaterialBinding()
    bound.value = binding
    group.addChild(bound)
    packed = coin.SoPackedColor()
    packed.orderedRGBA.setValues(0, len(colours), np.ascontiguousarray(colours, dtype=np.uint32))
    group.addChild(packed)
    return group
