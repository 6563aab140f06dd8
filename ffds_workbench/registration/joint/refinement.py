# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finer lattices where the data ask for them: where what is left in the cells is more than the noise explains."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..splines import greville
from .problem import Problem
from .state import State

_EXCESS = 1.3
"""Ratio of the variance of patch means to that expected of noise, from which a face is divided."""
_FEWEST_PATCHES = 12
_PATCH = 3
_MOST_CONTROLS = 6000


def finer_faces(problem: Problem, state: State) -> dict[int, int]:
    """Faces whose spans are to be halved: {face: 2}.

    Noise averages out over a patch of cells, a shape that the lattice cannot follow does not.
    """
    return {}


def transfer(coarse: Problem, fine: Problem, state: State) -> State:
    """The displacement on other lattices: interpolated at their Greville points, face by face."""
    control_points = np.zeros((fine.lattices.count, 3))
    for face, lattice in enumerate(fine.lattices.faces):
        spline = fine.lattices.spline(face, control_points)
        u, v = greville(spline.knots_u), greville(spline.knots_v)
        own = coarse.lattices.spline(face, state.control_points)
        raise NotImplementedError(u, v, own, lattice)
    return replace(state, control_points=control_points, factor=None)
