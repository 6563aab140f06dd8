# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a face's loops begin, so that a reader that meets their edges one by one gives them the same numbers.

Pure arrangement of edge uses, without files or geometry.
"""
from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...registration.arrays import Array
from ..occt_text.records import ShapeReference


@dataclass(frozen=True)
class LoopEdge:
    """An edge in a loop: its index, its orientation with the face taken FORWARD, and how the wire refers to it."""

    edge: int
    orientation: str
    reference: ShapeReference


Loop = tuple[LoopEdge, ...]
Ends = Sequence[tuple[int, int]]
"""Per edge, the vertices at its first and at its last parameter."""


def other(orientation: str) -> str:
    """The opposite orientation; 'i' and 'e' have none."""
    return {"+": "-", "-": "+"}.get(orientation, orientation)


def backwards(loop: Loop) -> Loop:
    """The loop travelled the other way."""
    return tuple(replace(use, orientation=other(use.orientation)) for use in reversed(loop))


def in_order(loop: Loop, ends: Ends) -> bool:
    """Whether every use begins at the vertex where the one before it ends."""
    return all(_end(use, ends) == _start(after, ends) for use, after in zip(loop, loop[1:] + loop[:1], strict=True))


def chained(loop: Loop, ends: Ends, uv: Array) -> Loop | None:
    """The uses in such an order that each begins where the one before ends; None where that comes to no end.

    Parameters
    ----------
    uv : (n, 2, 2) where each use begins and ends in the face's (u, v): of several that begin at the vertex the one that
        begins nearest there follows, as both sides of a seam have the same vertices
    """
    left, order = list(range(1, len(loop))), [0]
    while left:
        follow = [k for k in left if _start(loop[k], ends) == _end(loop[order[-1]], ends)]
        if not follow:
            return None
        order.append(min(follow, key=lambda k: float(np.linalg.norm(uv[k, 0] - uv[order[-1], 1]))))
        left.remove(order[-1])
    result = tuple(loop[k] for k in order)
    return result if in_order(result, ends) else None


def _start(use: LoopEdge, ends: Ends) -> int:
    return ends[use.edge][use.orientation == "-"]


def _end(use: LoopEdge, ends: Ends) -> int:
    return ends[use.edge][use.orientation != "-"]


def begun(loop: Loop, met: Collection[int], degenerated: Sequence[bool]) -> Loop | None:
    """The loop begun so that edges not ``met`` yet come in ascending order; None where no beginning does that.

    STEP has no degenerated edges: readers put them in before the edge that follows, so none may come last.
    """
    new = {use.edge for use in loop} - set(met)
    starts = [0]
    if new:
        starts += [k for k, use in enumerate(loop) if use.edge == min(new)]
    for k in starts:
        while degenerated[loop[k - 1].edge] and not all(degenerated[use.edge] for use in loop):
            k -= 1
        turned = loop[k:] + loop[:k]
        order = list(dict.fromkeys(use.edge for use in turned if use.edge in new))
        if order == sorted(order):
            return turned
    return None
