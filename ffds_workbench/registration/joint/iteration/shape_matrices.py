# SPDX-License-Identifier: LGPL-2.1-or-later
"""Matrices of the priors at a shape, which are reused for shapes nearby."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ..linear import SomeBlocks
from ..problem import Problem
from ..surfaces import normals

_STRAIN_LASTS = 0.004
"""Over the size of the least solid: until the shape has moved by this, the strain matrices are kept (unit: a small
share of a span, in which no face turns so far that the steps would go astray)."""
_SAME_NORMAL = 0.02
"""Change of a normal up to which the thickness rows are kept (theory: it changes the thickness by 0.02²/2, one in five
thousand)."""


@dataclass(frozen=True)
class ThicknessRows:
    """The thickness of sheets along normals (pairs, 3), and the blocks that its rows make."""

    normal: Array
    blocks: SomeBlocks


@dataclass(frozen=True)
class ShapeMatrices:
    """What the priors add to the normal matrix at a shape near by.

    Attributes
    ----------
    strain : (3, 3, size) on the pattern, without its weights
    thickness : along which normals thickness is measured
    moved : how far the shape has moved since ``strain`` was found, in mm

    Parameters of the methods
    -------------------------
    problem : what stays the same while the solve runs
    control_points : (controls, 3) of the displacement in mm
    """

    strain: Array
    thickness: ThicknessRows
    moved: float = 0.0

    @classmethod
    def of(cls, problem: Problem, control_points: Array) -> ShapeMatrices:
        """Those of the shape that the control points give."""
        return cls(_strain_blocks(problem, control_points), _thickness_rows(problem, control_points))

    def renewed_strain(self, problem: Problem, control_points: Array) -> ShapeMatrices:
        """With the strain of the current shape, if it has moved too far."""
        if self.moved <= _STRAIN_LASTS * float(problem.body_size.min()):
            return self
        return replace(self, strain=_strain_blocks(problem, control_points), moved=0.0)

    def renewed_thickness(self, problem: Problem, control_points: Array) -> ShapeMatrices:
        """With the thickness rows of the current shape, if its normals differ."""
        return replace(self, thickness=_thickness_rows(problem, control_points, self.thickness))


def _thickness_rows(problem: Problem, control_points: Array, known: ThicknessRows | None = None) -> ThicknessRows:
    """Rows of the thickness along the sheets' current normals; those ``known`` if the normals hardly differ."""
    normal = problem.couplings.sheet_normals(control_points)
    if known is not None and np.abs(normal - known.normal).max(initial=0.0) < _SAME_NORMAL:
        return known
    return ThicknessRows(normal, problem.pattern.from_vector(problem.couplings.thickness_matrix(normal)))


def _strain_blocks(problem: Problem, control_points: Array) -> Array:
    """Normal matrix of the strain at the current shape, without its weights: (3, 3, size)."""
    stiffness, sheet = problem.stiffness, problem.sheet_of_span
    normal = normals(stiffness.places.displaced(problem.lattices, control_points, 3), stiffness.places.outward)[0]

    def matrices(spans: slice) -> Array:
        rows = stiffness.strain_rows(problem.lattices, control_points, normal, sheet, spans)
        flat = rows.reshape(len(rows), -1, 48)
        weight = np.repeat(stiffness.stretched[spans], 3, axis=1)[:, :, None]
        return np.matmul((weight * flat).swapaxes(1, 2), flat).reshape(-1, 3, 16, 3, 16)

    return problem.pattern.from_span_blocks(matrices)
