# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the joint solve stands: the displacement, and what the last iteration learnt."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array, Index
from .assembly import strain_blocks
from .body_field import BodyRows
from .data import Borders, CellHeights, NearEdges, Scatter, no_heights
from .linear import FrontCholesky
from .priors import PriorTrust
from .problem import Problem, ThicknessRows


@dataclass(frozen=True)
class StepCache:
    """What the next step uses again, because the shape hardly changes.

    Attributes
    ----------
    strain_matrices : `strain_blocks` of a shape near by
    thickness_rows : along which normals thickness is measured
    moved : how far the shape has moved since `strain_matrices`, in mm
    nearest : nearest cells of the scan points of this stage, once they were matched
    facing : outward normals of all scan points, zero where unknown; None where it does not matter
    near_edges, borders : scan points near the edges and visible borders, from the soft stages on
    body : what the body tells of its faces, in its stage
    factor, factor_bending : of an earlier normal matrix, and the multiple of the bending weight in it
    """

    strain_matrices: Array
    thickness_rows: ThicknessRows
    moved: float = 0.0
    nearest: Index | None = None
    facing: Array | None = None
    near_edges: NearEdges | None = None
    borders: Borders | None = None
    body: BodyRows | None = None
    factor: FrontCholesky | None = None
    factor_bending: float = 0.0


@dataclass(frozen=True)
class State:
    """One point of the iteration.

    Attributes
    ----------
    control_points : (controls, 3) displacement in mm
    reach : largest gate in mm, from how far the scan lies from the nominal part
    values : of the last iteration
    cache : what the next one uses again
    facing : outward normals of the sample's points, zero where unknown; None where it does not matter
    trust : in the priors
    last_step : largest movement of a cell in the last iteration, in mm
    iterations : so far
    face_steps : (faces,) largest movement of a cell of every face in the last iteration, in mm
    unsure : how far the whole part may be off in mm, because the scan may show the other skin of a sheet
    """

    control_points: Array
    reach: float
    values: CellHeights
    cache: StepCache
    facing: Array | None = None
    trust: PriorTrust = field(default_factory=PriorTrust)
    last_step: float = np.inf
    iterations: int = 0
    unsure: float = 0.0
    face_steps: Array | None = None


def fresh_cache(problem: Problem, control_points: Array) -> StepCache:
    """The cache for a first step on a shape."""
    return StepCache(strain_blocks(problem, control_points), problem.thickness_rows(control_points))


def start(problem: Problem) -> State:
    """The nominal shape."""
    faces, lengths = len(problem.part.faces), problem.lengths
    still = np.zeros((problem.lattices.count, 3))
    scatter = Scatter(np.full(faces, lengths.noise), np.zeros(faces), np.full(faces, lengths.start))
    return State(still, lengths.reach, no_heights(problem.distance.size, scatter), fresh_cache(problem, still))
