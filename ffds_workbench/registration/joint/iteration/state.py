# SPDX-License-Identifier: LGPL-2.1-or-later
"""The state of the joint solve: the displacement, what the last step found, and what the next one reuses."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array, Index
from ..body_field import BodyRows
from ..data import Borders, CellHeights, NearEdges, Scatter, no_heights
from ..linear import FrontCholesky
from ..priors import PriorTrust
from ..problem import Problem
from .shape_matrices import ShapeMatrices


@dataclass(frozen=True)
class PointCache:
    """What is known of the scan points.

    Attributes
    ----------
    nearest : (n,) nearest cells of the points of this stage, once they were matched
    outward : (n, 3) outward normals of all points, zero where unknown; None where it does not matter
    """

    nearest: Index | None = None
    outward: Array | None = None


@dataclass(frozen=True)
class EdgeCache:
    """What is known of the visible edges, from the soft stages on.

    Attributes
    ----------
    near : scan points near them
    borders : where the scan ends at them
    """

    near: NearEdges | None = None
    borders: Borders | None = None


@dataclass(frozen=True)
class EarlierFactor:
    """The Cholesky factor of an earlier normal matrix, and the multiple of the bending weight in that."""

    cholesky: FrontCholesky
    bending: float


@dataclass(frozen=True)
class StepCache:
    """What the next step reuses, because the shape hardly changes.

    Attributes
    ----------
    matrices : of the priors
    points : of the scan
    edges : that are visible
    body : what the body tells of its faces, in its stage
    factor : of the last normal matrix that was factored
    """

    matrices: ShapeMatrices
    points: PointCache = PointCache()
    edges: EdgeCache = EdgeCache()
    body: BodyRows | None = None
    factor: EarlierFactor | None = None


@dataclass(frozen=True)
class State:
    """One point of the iteration.

    Attributes
    ----------
    control_points : (controls, 3) displacement in mm
    values : of the last iteration
    cache : what the next one reuses
    outward : (n, 3) outward normals of the sample's points, zero where unknown; None where it does not matter
    trust : in the priors
    last_step : largest movement of a cell in the last iteration, in mm
    iterations : so far
    face_steps : (faces,) largest movement of a cell of every face in the last iteration, in mm
    unsure : how far the whole part may be off in mm, because the scan may show the other skin of a sheet
    """

    control_points: Array
    values: CellHeights
    cache: StepCache
    outward: Array | None = None
    trust: PriorTrust = field(default_factory=PriorTrust)
    last_step: float = np.inf
    iterations: int = 0
    unsure: float = 0.0
    face_steps: Array | None = None


def start(problem: Problem) -> State:
    """The nominal shape of a ``problem``."""
    faces, lengths = len(problem.part.faces), problem.lengths
    still = np.zeros((problem.lattices.count, 3))
    scatter = Scatter(np.full(faces, lengths.noise), np.zeros(faces), np.full(faces, lengths.start))
    return State(still, no_heights(problem.distance.size, scatter),
                 StepCache(ShapeMatrices.of(problem, still)))
