# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a part kept its lengths: the strain that the scan shows, and the weight that isometry gets from it."""
from __future__ import annotations

import numpy as np

from ..splines import Array
from .problem import Problem
from .raster import normals
from .settings import JointSettings
from .values import CellValues

_ISOMETRIC, _STRETCHED = 0.003, 0.005
"""Rms strain up to which a part counts as isometric, and from which it does not."""
_WALL = 0.1
"""Isometry of faces that are no skin of a sheet, relative to the skins'."""
_LEAST_WEIGHT = 1e-3


def observed_strain(problem: Problem, control_points: Array, values: CellValues) -> float:
    """Rms strain of the mid surface over the spans that the scan observes."""
    stiffness, lattices = problem.stiffness, problem.lattices
    jet = stiffness.places.displaced(lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    thickness = problem.couplings.pairs.of_face[lattices.face_of_span]
    strain = stiffness.strain(lattices, control_points, normal, thickness)[0]
    seen = (values.weight.reshape(problem.cells.inside.shape) > 0).sum(axis=1) > 0.3 * problem.cells.inside.sum(axis=1)
    seen &= (thickness > 0) | ~(problem.couplings.pairs.of_face > 0).any()
    area = stiffness.area * seen[:, None]
    return float(np.sqrt((area[..., None] * strain**2).sum() / max(area.sum(), 1e-12)))


def isometry_weights(problem: Problem, control_points: Array, values: CellValues, settings: JointSettings,
                     decide: bool) -> Array:
    """Weight per mm² of the strain in every span: (spans,)."""
    skin = problem.couplings.pairs.of_face[problem.lattices.face_of_span] > 0
    weight = settings.isometry_weight
    if settings.isometry == "off":
        weight = _LEAST_WEIGHT
    elif settings.isometry == "auto" and decide:
        strain = observed_strain(problem, control_points, values)
        share = np.clip((strain - _ISOMETRIC) / (_STRETCHED - _ISOMETRIC), 0, 1)
        weight = float(np.exp((1 - share) * np.log(weight) + share * np.log(settings.isometry_weight_soft)))
        print('strain', strain, weight)
    return np.where(skin, weight, min(_WALL * weight, settings.isometry_weight_soft))
