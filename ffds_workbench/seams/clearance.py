# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the torch's tip gets to a seam and away from it without passing through the part."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import Part

from .programs.moves import SeamMoves
from .weldment import Weldment

_ALONG = np.linspace(0.1, 1.0, 10)
"""Where on the way to look, from the seam (0) outwards: at the seam itself the torch is in the joint."""
_WITHIN = 0.05


def blocked_ways(shape: Part.Shape, paths: Sequence[SeamMoves]) -> list[str]:
    """A sentence for each approach or retract that leads through a solid."""
    weldment = Weldment(shape)
    sentences = []
    for path in paths:
        points = path.poses[:, :3, 3]
        ways = (("approach to", path.approach, points[0], points[1]),
                ("retract from", path.retract, points[-1], points[-2]))
        for what, away, end, next_to_it in ways:
            # A little within the seam: its end may lie in the part's own border.
            way = end + _WITHIN * (next_to_it - end) + _ALONG[:, None] * (away[:3, 3] - end)
            if any(weldment.in_material(point) for point in way):
                sentences.append(f"The {what} {path.name} leads through the part: shorten it, lean the torch or weld "
                                 "from another start.")
    return sentences
