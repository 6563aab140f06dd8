# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much each prior is trusted: less if the part visibly stretched, sheared or bent more than expected.

Every prior is a sum of squares in chi-square units. At the solution its cost should be about the number of parameters
that the scan determines against it (MacKay, Neural Computation 4, 1992, eq. 4.8): a prior that costs more is too tight.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from .iteration import State, mean_curvature_change
from .priors import PriorTrust
from .problem import Problem
from .settings import Stage
from .surfaces import normals

_EXPECTED = PriorTrust(isometry=25.0, thickness=20.0, shear=5.0, dihedral=3.0, sliding=60.0)
"""Number of independent shapes that a scan determines against each prior. Some are half or less of what traces of the
covariance say: deformations are smooth, so that a few large shapes cost as much as many small ones would
(calibrated: ``./ffds benchmark accuracy``, on its families)."""
_WON_BACK = ("isometry", "shear", "dihedral")
_EXPECTED_CONTROLS = 1000.0
"""The expected numbers grow in proportion with the control points above this number (calibrated: as above)."""
_LEAST_TRUST = PriorTrust(isometry=1e-5, thickness=1e-2, shear=1e-5, dihedral=1e-5, sliding=0.1)
"""A sheet bends, stretches and even shears far more easily than it changes its thickness (unit)."""
_LEAST_TRUST_MASSIVE = 0.1
"""Least trust in the thickness of massive parts, of which only the opposite side says where an unseen one lies
(unit)."""
_ISOMETRY_OFF = 1e-6
"""Trust in the isometry that the user has taken away (unit: as good as none)."""
_ISOMETRIC_TRUST = 0.1
"""A part counts as isometric while its isometry is trusted by more than this (unit)."""
_MOST_WON_BACK = 3.0
"""Factor that the trust in isometry does not gain within a stage. *unit*: isometric parts gain half as much."""
_OBSERVED_SHARE = 0.3
"""Share of a span's cells that make it observed (unit)."""


def update_prior_trust(problem: Problem, state: State, stage: Stage) -> State:
    """The state with its trust in the priors renewed; until the soft stages all are trusted.

    A prior with full trust forces the shape to comply and then costs little. So the first soft stage expects less of
    some of them, and trust is regained from there. In the stage with the body field it stays.
    """
    if stage.body:
        return state
    trust, mode = PriorTrust(), problem.settings.isometry
    if stage.soft:
        cost, number = cost_of_each_prior(problem, state), max(1.0, problem.lattices.count / _EXPECTED_CONTROLS)
        expected = PriorTrust(**{name: number * value * (stage.allowance if name in _WON_BACK else 1.0)
                                 for name, value in vars(_EXPECTED).items()})
        least = _LEAST_TRUST if problem.skin.any() else replace(_LEAST_TRUST, thickness=_LEAST_TRUST_MASSIVE)
        trust = PriorTrust(**{name: float(np.clip(getattr(expected, name) / max(getattr(cost, name), 1e-12),
                                                  getattr(least, name), 1.0)) for name in vars(trust)})
    if mode != "auto":
        trust = replace(trust, isometry=1.0 if mode == "on" else _ISOMETRY_OFF)
    return replace(state, trust=trust)


def cost_of_each_prior(problem: Problem, state: State) -> PriorTrust:
    """What each prior costs at the current shape with its full weight, in chi-square units."""
    control_points = state.control_points
    couplings, stiffness, settings = problem.couplings, problem.stiffness, problem.settings
    normal = normals(stiffness.places.displaced(problem.lattices, control_points, 3), stiffness.places.outward)[0]
    strain = stiffness.strain(problem.lattices, control_points, normal, problem.sheet_of_span)
    strain = (stiffness.stretched * (strain**2).sum(axis=2)).sum(axis=1)
    across, along = couplings.thickness_misfit(control_points, state.cache.matrices.thickness.normal)
    weight, turned = couplings.thickness_weight, couplings.angle_change(control_points)[couplings.sharp]
    return PriorTrust(isometry=float(problem.isometry_weights(PriorTrust())[0] * strain[problem.skin].sum()),
                      thickness=float((weight * across**2).sum()),
                      shear=float((weight[:, None] * along**2).sum()),
                      dihedral=float((couplings.dihedral_weight[couplings.sharp] * turned**2).sum()),
                      sliding=stiffness.sliding(problem.lattices, control_points, normal)
                      / (settings.curvature * settings.curvature_length) ** 2)


def prior_cost(problem: Problem, state: State) -> float:
    """What all priors together cost at the final shape, in chi-square units.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    state : where the solve stands
    """
    settings, stiffness = problem.settings, problem.stiffness
    normal = normals(stiffness.places.displaced(problem.lattices, state.control_points, 3), stiffness.places.outward)[0]
    change = stiffness.curvature_change(problem.lattices, state.control_points, normal)
    change -= mean_curvature_change(problem, state.control_points, normal)[:, None, :]
    bending = float((stiffness.weight * (change**2).sum(axis=2)).sum())
    cost, trust = cost_of_each_prior(problem, state), state.trust
    return (bending / (settings.curvature * settings.curvature_length) ** 2
            + sum(getattr(cost, name) * getattr(trust, name) for name in vars(trust)))


def strain_at(problem: Problem, control_points: Array) -> Array:
    """Strain of the mid surface at the Gauss places: (spans, k, 3)."""
    stiffness = problem.stiffness
    jet = stiffness.places.displaced(problem.lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    return stiffness.strain(problem.lattices, control_points, normal, problem.sheet_of_span)


def observed_strain(problem: Problem, state: State) -> float:
    """Rms strain of the mid surface over the observed spans of sheets (of all faces, if there is no sheet)."""
    stiffness = problem.stiffness
    strain = strain_at(problem, state.control_points)
    cells = problem.cells.inside
    seen = (state.values.weight.reshape(cells.shape) > 0).sum(axis=1) > _OBSERVED_SHARE * cells.sum(axis=1)
    if problem.skin.any():
        seen &= problem.skin
    area = stiffness.area * seen[:, None]
    return float(np.sqrt((area[..., None] * strain**2).sum() / max(area.sum(), 1e-12)))


def is_isometric(state: State) -> bool:
    """Whether what the scan shows lets the part count as isometric."""
    return state.trust.isometry > _ISOMETRIC_TRUST


def may_be_isometric(state: State) -> bool:
    """Whether the part may yet come to count as isometric within a stage."""
    return _MOST_WON_BACK * state.trust.isometry > _ISOMETRIC_TRUST
