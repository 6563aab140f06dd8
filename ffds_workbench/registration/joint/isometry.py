# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a part kept its lengths: the strain that the scan shows, and the weight that isometry gets from it."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..splines import Array
from .problem import Problem
from .raster import normals
from .settings import Stage
from .state import State

_ISOMETRIC, _STRETCHED = 0.003, 0.005
"""Rms strain up to which a part counts as isometric, and from which it does not."""
_OBSERVED = 0.3
"""Share of a span's cells that make it observed."""
_WALL = 0.1
"""Isometry of faces that are no skin of a sheet, relative to the skins'."""
_OFF = 1e-3
_FACES_OFF, _SIGNIFICANT = 2, 5.0
"""Faces off the scan that drop isometry, and by how many standard deviations they must be; one may be clutter."""


def observed_strain(problem: Problem, state: State) -> float:
    """Rms strain of the mid surface over the observed spans of sheets (of all faces, if there is no sheet)."""
    stiffness, lattices = problem.stiffness, problem.lattices
    thickness = problem.couplings.pairs.of_face[lattices.face_of_span]
    jet = stiffness.places.displaced(lattices, state.control_points, 3)
    strain = stiffness.strain(lattices, state.control_points, normals(jet, stiffness.places.outward)[0], thickness)[0]
    cells = problem.cells.inside
    seen = (state.values.weight.reshape(cells.shape) > 0).sum(axis=1) > _OBSERVED * cells.sum(axis=1)
    if (thickness > 0).any():
        seen &= thickness > 0
    area = stiffness.area * seen[:, None]
    return float(np.sqrt((area[..., None] * strain**2).sum() / max(area.sum(), 1e-12)))


def count_faces_off(problem: Problem, state: State) -> int:
    """How many faces lie off the scan as a whole, by more than the noise: isometry keeps them from following it."""
    values, face = state.values, problem.face_of_cell
    weight, pull = (np.bincount(face, weights=x, minlength=len(problem.part.faces))
                    for x in (values.weight, values.weight * values.height))
    mean = pull / np.maximum(weight, 1e-12)
    return int(((np.abs(mean) > problem.statistics.noise) & (np.abs(mean) * np.sqrt(weight) > _SIGNIFICANT)).sum())


def judge_stretch(problem: Problem, state: State, stage: Stage) -> State:
    """The state with the weights of isometry and thickness, and the strain they were decided from.

    Until the first soft stage is over a sheet counts as isometric; then the strain decides, once.
    """
    settings = problem.settings
    if stage.soft and state.strain:
        return state
    strain = observed_strain(problem, state) if stage.soft else 0.0
    off = stage.soft and count_faces_off(problem, state) >= _FACES_OFF
    stretched = {"on": 0.0, "off": 1.0}.get(settings.isometry)
    if stretched is None:
        stretched = float(np.clip((strain - _ISOMETRIC) / (_STRETCHED - _ISOMETRIC), 0, 1))
        stretched = 1.0 if off else stretched
    weight = settings.isometry_weight ** (1 - stretched) * settings.isometry_weight_soft**stretched
    if settings.isometry == "off":
        weight = _OFF
    skin = problem.couplings.pairs.of_face[problem.lattices.face_of_span] > 0
    weights: Array = np.where(skin, weight, min(_WALL * weight, settings.isometry_weight_soft))
    thickness = (settings.thickness_sigma / settings.thickness_sigma_soft) ** (2 * stretched)
    return replace(state, isometry=weights, strain=strain, faces_off=off, thickness=thickness)


def is_isometric(state: State) -> bool:
    """Whether the strain that was found, and how the faces follow the scan, let the part count as isometric."""
    return state.strain <= 0.5 * (_ISOMETRIC + _STRETCHED) and not state.faces_off
