# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams as Coin nodes: coloured lines, and a legend that stands still in the corner of the view."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pivy import coin

from ...objects.seams import FIGURES, stations_of, wishes_of
from ..qt import QtWidgets
from ..translating import tr
from .colours import NO_DATA, packed_colours
from .overlay import mesh_node

Array = NDArray[np.float64]
Colours = NDArray[np.uint32]
Entry = tuple[str, int]

PASS, FAIL = 0x2E9E4FFF, 0xD0311FFF
_UNITS = {"opening": "°", "rotation": "°"}
_LEFT, _BOTTOM, _WIDE, _TALL = -0.96, -0.55, 0.035, 0.07
"""Of the legend's boxes, where the view is 2 wide and 2 high."""
_STEPS = 9
_ROUND, _RADIUS = 8, 0.006
"""Corners of a bead, and its radius as a share of the part's size."""
_INK = (0.05, 0.08, 0.12)


def seam_nodes(item: Any, colour_by: str, legend: bool) -> list[Any]:
    """The nodes that show a Seams object, in the document's coordinates; not pickable, the object's own lines are."""
    stations = stations_of(item)
    limits = vars(wishes_of(item).limits)
    if colour_by == "Verdict":
        colours, title, entries = verdict_colours(stations, limits), tr("Seams"), _verdicts()
    else:
        name = colour_by.lower()
        values = stations.get(FIGURES[name], np.full(len(stations["s"]), np.nan))
        limit = max(limits[name], 1e-6)
        colours, title = packed_colours(values, limit), f"{colour_by}, {_UNITS.get(name, 'mm')}"
        steps = np.linspace(-limit, limit, _STEPS)
        entries = [(tr("no data"), NO_DATA), *((f"{step:+.3g}" if abs(step) > 1e-9 else "0", int(colour))
                                           for step, colour in zip(steps, packed_colours(steps, limit), strict=True))]
    bead = _bead(stations, colours, _RADIUS * item.AsBuilt.Shape.BoundBox.DiagonalLength)
    return [bead, _legend(title, entries)] if legend else [bead]


def verdict_colours(stations: dict[str, Array], limits: dict[str, float]) -> Colours:
    """(n,) packed: whether each station passes all limits; grey where there is nothing to compare."""
    values = np.stack([np.abs(stations[column]) / max(limits[name], 1e-12)
                       for name, column in FIGURES.items() if column in stations])
    known, worst = np.isfinite(values).any(axis=0), np.nan_to_num(values).max(axis=0)
    return np.where(known, np.where(worst > 1.0, FAIL, PASS), NO_DATA).astype(np.uint32)


def _verdicts() -> list[Entry]:
    return [(tr("nothing to compare"), NO_DATA), (tr("beyond a limit"), FAIL), (tr("within all limits"), PASS)]


def _bead(stations: dict[str, Array], colours: Colours, radius: float) -> Any:
    """The seams as round beads: lines would half vanish in the faces they lie on."""
    points, tangents, normals = (np.stack([stations[prefix + axis] for axis in "xyz"], axis=1)
                                 for prefix in ("", "t", "n1"))
    aside = np.cross(tangents, normals)
    turns = np.arange(_ROUND) * 2.0 * np.pi / _ROUND
    rings = points[:, None] + radius * (np.cos(turns)[:, None] * normals[:, None]
                                        + np.sin(turns)[:, None] * aside[:, None])
    # From each station to the next of the same seam, unless they share a place where one edge follows another.
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    first = np.flatnonzero((np.diff(stations["seam"]) == 0) & (step > 1e-9))[:, None] * _ROUND
    here, after = np.arange(_ROUND), (np.arange(_ROUND) + 1) % _ROUND
    a, b, c, d = first + here, first + after, first + _ROUND + after, first + _ROUND + here
    triangles = np.concatenate([np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))])
    node = coin.SoSeparator()
    node.addChild(_unpickable())
    node.addChild(mesh_node(rings.reshape(-1, 3), triangles, np.repeat(colours, _ROUND)))
    return node


def _legend(title: str, entries: list[Entry]) -> Any:
    """Boxes and words in front of everything; the view's bounding box knows nothing of them."""
    holder = coin.SoType.fromName("SoSkipBoundingGroup").createInstance()
    front = coin.SoAnnotation()
    holder.addChild(front)
    camera = coin.SoOrthographicCamera()
    camera.viewportMapping, camera.aspectRatio = coin.SoCamera.LEAVE_ALONE, 1.0
    camera.position = (0.0, 0.0, 1.0)
    camera.height, camera.nearDistance, camera.farDistance = 2.0, 0.5, 1.5
    for child in (_unpickable(), camera, _flat()):
        front.addChild(child)
    low = _BOTTOM + _TALL * np.arange(len(entries))
    corners = np.array([[0.0, 0.0], [_WIDE, 0.0], [_WIDE, 0.9 * _TALL], [0.0, 0.9 * _TALL]])
    boxes = corners + np.stack([np.full(len(low), _LEFT), low], axis=1)[:, None]
    front.addChild(_boxes(boxes, np.array([colour for _, colour in entries], dtype=np.uint32)))
    base = coin.SoBaseColor()
    base.rgb.setValue(*_INK)
    front.addChild(base)
    font = coin.SoFont()
    font.name = QtWidgets.QApplication.font().family()
    font.size = 14.0
    front.addChild(font)
    front.addChild(_words(title, _LEFT, float(low[-1] + 1.5 * _TALL)))
    for (text, _), height in zip(entries, low, strict=True):
        front.addChild(_words(text, _LEFT + 1.4 * _WIDE, float(height + 0.25 * _TALL)))
    return holder


def _boxes(corners: Array, colours: Colours) -> Any:
    node = coin.SoSeparator()
    bound = coin.SoMaterialBinding()
    bound.value = coin.SoMaterialBinding.PER_FACE
    node.addChild(bound)
    node.addChild(_packed(colours))
    node.addChild(_coordinates(np.dstack([corners, np.zeros(corners.shape[:2])]).reshape(-1, 3)))
    faces = coin.SoFaceSet()
    faces.numVertices.setValues(0, len(corners), [4] * len(corners))
    node.addChild(faces)
    return node


def _words(text: str, x: float, y: float) -> Any:
    node = coin.SoSeparator()
    place = coin.SoTranslation()
    place.translation = (x, y, 0.0)
    node.addChild(place)
    words = coin.SoText2()
    words.string = text
    node.addChild(words)
    return node


def _packed(colours: Colours) -> Any:
    node = coin.SoPackedColor()
    node.orderedRGBA.setValues(0, len(colours), np.ascontiguousarray(colours))
    return node


def _coordinates(points: Array) -> Any:
    node = coin.SoCoordinate3()
    node.point.setValues(0, len(points), np.ascontiguousarray(points, dtype=np.float32))
    return node


def _unpickable() -> Any:
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    return style


def _flat() -> Any:
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    return light
