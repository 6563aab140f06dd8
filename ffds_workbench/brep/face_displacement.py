# SPDX-License-Identifier: LGPL-2.1-or-later
"""The displacement of one face, as the rebuild takes it: a function, and where its detail lies.

This module owns the type only. Registrations, fields in space and tests all make these; the rebuild samples them
wherever its own accuracy requires it.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _nowhere() -> Array:
    return np.zeros(0)


@dataclass(frozen=True)
class FaceDisplacement:
    """How the points of one face move.

    Attributes
    ----------
    evaluate : ``(uv, points) -> displacement``: (n, 2) parameters on the face and the (n, 3) points of the nominal face
        there, in mm and world coordinates, to (n, 3) in mm. It must agree with the neighbours' along every shared edge,
        with itself across a seam, and be constant at a pole, as a field in space does by construction. It is called
        with parameters in the face's range, and with whole arrays.
    knots_u, knots_v : interior parameters, (k,) each, that must become knots of the face's control lattice: the
        displacement's own knots, or lines close enough that no feature slips between them; may be empty
    """

    evaluate: Callable[[Array, Array], Array]
    knots_u: Array = field(default_factory=_nowhere)
    knots_v: Array = field(default_factory=_nowhere)
