# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the joint solve stands: the displacement, and what the last iteration learnt."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...errors import RefusedError
from ..splines import Array
from .cholesky import FrontCholesky
from .lattice import Index
from .problem import Problem
from .values import CellValues

_TYPICAL = 0.75
"""Quantile of the distances from the nominal part that tells how far the part has moved."""
_REACH = 1.5
_LEAST_REACH = 3.0


@dataclass(frozen=True)
class State:
    """One point of the iteration.

    Attributes
    ----------
    control_points : (controls, 3) displacement in mm
    noise : (faces,) in mm
    reach : largest gate in mm, from how far the scan lies from the nominal part
    isometry : (spans,) weight of the strain per mm²
    thickness : multiplies the weight of the sheets' thickness
    strain : rms strain found on observed faces
    near : scan points near the edges, once they are needed
    nearest : nearest cells of the scan points of this stage, while the shape hardly moves
    factor : of an earlier normal matrix; after the last stage of one with all data
    values : of the last iteration
    last_step : largest movement of a cell in the last iteration, in mm
    iterations : so far
    """

    control_points: Array
    noise: Array
    reach: float
    isometry: Array
    thickness: float = 1.0
    strain: float = 0.0
    near: Array | None = None
    nearest: Index | None = None
    factor: FrontCholesky | None = None
    values: CellValues | None = None
    last_step: float = np.inf
    iterations: int = 0


def start(problem: Problem) -> State:
    """The nominal shape.

    Raises
    ------
    RefusedError : the scan is farther from the part than the part is large
    """
    inside = problem.cells.inside
    position = problem.cells.nominal.position[inside]
    size = float(np.linalg.norm(np.ptp(position, axis=0)))
    distance = cKDTree(position).query(problem.sample, distance_upper_bound=size, workers=-1)[0]
    typical = float(np.sort(distance)[int(_TYPICAL * (len(distance) - 1))])
    if not np.isfinite(typical):
        raise RefusedError("The scan does not overlap the part: most of it is farther away than the part is large; check the "
                           "unit of the scan and align it first.")
    faces = len(problem.part.faces)
    return State(np.zeros((problem.lattices.count, 3)), np.full(faces, problem.statistics.noise),
                 max(_LEAST_REACH, _REACH * typical, 4 * problem.statistics.noise),
                 np.zeros(len(problem.lattices.controls)))
