# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which skin of a sheet the scan shows, given a fit to each: decided by the cost of the fits and by what is seen of the
walls between the skins.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..data import correspond
from ..iteration import State
from ..prior_trust import prior_cost
from ..problem import Problem
from ..surfaces import normals

# What is clearly less is a judgement (unit), tried on the sheets of tests/registration/test_joint_shapes.py.
_COST_RATIO, _COST_OF_LOST_POINT = 0.8, 9.0
"""The fit to one skin is right if it costs less than this factor times the other (calibrated: by hand, on the sheets of
tests/registration/test_joint_shapes.py). A point left out counts as one three standard deviations away, 3² in
chi-square units (theory)."""
_WALL_POINTS, _WALL_RATIO = 50, 3
"""Otherwise the fit is right that explains clearly more points on the walls beside the skins: more than the second
number times the other fit's, plus the first (calibrated: as above)."""
_MOVED_CLEARLY_LESS, _MOVED_ALIKE = 0.6, 0.9
"""Otherwise the fit that moved less is right if its movement is below the first factor times the other's. Above it this
is a guess, with bands as wide as the sheet is thick. A fit that the scan's normals favour is kept unless the other
moved less by the first factor, with such wide bands if it moved less by the second (calibrated: as above)."""


def choose_skin(problem: Problem, states: list[State], by_normals: bool) -> State:
    """Choose the right one of two fits of a sheet, one to each of its skins; a single fit is returned as it is.

    If neither costs nor walls decide, the first is right if the scan's normals say so and it did not move far
    more. Without normals the one that moved less is a guess, with bands as wide as the sheet is thick, unless it moved
    far less.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    states : the fits, one or two
    by_normals : whether the scan's normals decide that the first is right
    """
    if len(states) == 1:
        return states[0]
    costs, matched, walls, moved = (np.array(item) for item in zip(*(_evidence(problem, state) for state in states),
                                                                   strict=True))
    costs = costs + _COST_OF_LOST_POINT * (matched.max() - matched)
    for own, other in ((0, 1), (1, 0)):
        if costs[own] < _COST_RATIO * costs[other]:
            return states[own]
    for own, other in ((0, 1), (1, 0)):
        if walls[own] > _WALL_RATIO * walls[other] + _WALL_POINTS:
            return states[own]
    thickness = max(problem.couplings.pairs.solid_thickness)
    if by_normals:
        chosen = states[int(moved[1] < _MOVED_CLEARLY_LESS * moved[0])]
        return replace(chosen, unsure=thickness) if moved[1] < _MOVED_ALIKE * moved[0] else chosen
    chosen = states[int(np.argmin(moved))]
    return chosen if moved.min() < _MOVED_CLEARLY_LESS * moved.max() else replace(chosen, unsure=thickness)


def _evidence(problem: Problem, state: State) -> tuple[float, float, int, float]:
    """Evidence for a fit: its cost in chi-square units, how many points of the sample are matched, how many
    scan points lie on faces that are no skin, and the mean movement of all matched ones along the normals in mm."""
    jet = problem.cells.displaced(problem.lattices, state.control_points)
    found = correspond(problem.scan, problem.frames(jet), 4 * problem.lengths.start)
    walls = problem.couplings.pairs.of_face[problem.face_of_cell[found.cell]] == 0
    normal = normals(problem.cells.nominal, problem.cells.outward)[0]
    moved = np.einsum("skx,skx->sk", jet.position - problem.cells.nominal.position, normal).ravel()[found.cell]
    misfit = float((state.values.weight * state.values.height**2).sum())
    return (prior_cost(problem, state) + misfit, float(state.values.count.sum()), int(walls.sum()),
            float(np.abs(moved).mean()) if len(moved) else np.inf)
