# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which sub-shapes of a shape are not valid, by name."""
from __future__ import annotations

from collections.abc import Sequence

import Part

WHOLE = "the shape as a whole"
_NAMED = 5
"""Unit: so many names a sentence holds."""


def invalid_parts(shape: Part.Shape) -> tuple[str, ...]:
    """The names of the sub-shapes that are invalid by OCCT's check, each by itself; empty for a valid shape.

    The whole shape is named where none of its vertices, edges, faces, shells and solids is at fault by itself.
    """
    if shape.isValid():
        return ()
    kinds = (("Vertex", shape.Vertexes), ("Edge", shape.Edges), ("Face", shape.Faces), ("Shell", shape.Shells),
             ("Solid", shape.Solids))
    return tuple(f"{kind}{number}" for kind, parts in kinds for number, part in enumerate(parts, 1)
                 if not part.isValid()) or (WHOLE,)


def newly_invalid(before: Part.Shape, after: Part.Shape) -> tuple[str, ...]:
    """The names of what is not valid in a shape and was in the one before it."""
    found = invalid_parts(after)
    known = invalid_parts(before) if found else ()
    return tuple(name for name in found if name not in known)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence, the first ones of many."""
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(names[:_NAMED]) + more
