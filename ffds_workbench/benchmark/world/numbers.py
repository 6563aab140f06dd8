# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a file that was read back has its nominal's faces, edges and vertices under the same numbers.

Written for itself, so that the project's certificate is judged and not asked.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import Part

from ...registration.arrays import Array
from ..simulated.sheet import to_polyline

KINDS = ("Solids", "Shells", "Faces", "Wires", "Edges", "Vertexes")
_NEARER = 0.3
"""An edge's middle is taken for another edge's where that is nearer than this share of its distance from its own."""


def changes(nominal: Part.Shape, back: Part.Shape) -> list[str]:
    """One sentence for each thing whose numbers changed; the order inside one list, which STEP cannot keep, is free."""
    counts = [f"{kind}: {len(getattr(nominal, kind))} became {len(getattr(back, kind))}" for kind in KINDS
              if len(getattr(nominal, kind)) != len(getattr(back, kind))]
    if counts:
        return counts
    pairs = {"faces of Solid": [_members(shape.Solids, shape.Faces, "Faces") for shape in (nominal, back)],
             "edges of Face": [_members(shape.Faces, shape.Edges, "Edges") for shape in (nominal, back)],
             "vertices of Edge": [_members(shape.Edges, shape.Vertexes, "Vertexes") for shape in (nominal, back)],
             "sizes of the wires of Face": [[sorted(len(wire.Edges) for wire in face.Wires) for face in shape.Faces]
                                            for shape in (nominal, back)]}
    return [f"{what}{_some(wrong)}" for what, (before, after) in pairs.items()
            if (wrong := [k + 1 for k, (a, b) in enumerate(zip(before, after, strict=True)) if a != b])]


def strays(shape: Part.Shape, true_edges: Array, floor: float) -> list[str]:
    """Edges whose middle lies on another edge's true line rather than on their own.

    Parameters
    ----------
    true_edges : (edges, k, 3) in mm
    floor : distance in mm within which an edge is where it should be
    """
    found = []
    for number, edge in enumerate(shape.Edges):
        if edge.Degenerated:
            continue
        middle = np.array([tuple(edge.valueAt(sum(edge.ParameterRange) / 2))])
        own = to_polyline(middle, true_edges[number])[0]
        if own > floor:
            others = np.linalg.norm(true_edges - middle, axis=2).min(axis=1)
            others[number] = np.inf
            if others.min(initial=np.inf) < _NEARER * own:
                found.append(number + 1)
    return [f"middle of Edge{_some(found)}"] if found else []


def _members(owners: Sequence[Part.Shape], members: Sequence[Part.Shape], kind: str) -> list[list[int]]:
    """Numbers of the members of each owner, ascending."""
    numbers: dict[int, list[tuple[int, Part.Shape]]] = {}
    for number, member in enumerate(members):
        numbers.setdefault(member.hashCode(), []).append((number, member))
    return [sorted(next((number for number, item in numbers.get(member.hashCode(), ()) if item.isSame(member)), -1)
                   for member in getattr(owner, kind)) for owner in owners]


def _some(numbers: Sequence[int]) -> str:
    """The first few of a list of numbers."""
    return ", ".join(map(str, numbers[:5])) + (f" and {len(numbers) - 5} more" if len(numbers) > 5 else "")
