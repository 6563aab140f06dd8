# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers behind Figures 6 and 9 of the paper, measured anew."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ...registration.face import ControlLattice, displacement_lattice, ffd, ffds, nearest_neighbours
from ..interleaved import median_seconds
from ..simulated.sheet import nominal
from .paper_case import PaperCase
from .paper_methods import METHODS, Judge

Progress = Callable[[str], None]
Row = dict[str, Any]

SOURCE_POINTS = (36, 100, 225, 400, 900, 2500)
CONTROL_POINTS = tuple(range(4, 21))
LATTICE, SOURCE = 10, 400
REPEATS = 20

PUBLISHED_TIMES = {"virtual": {"ffd_hsu_s": 1.67, "ffds_dense_s": 0.10},
                   "measured": {"ffd_hsu_s": 1.69, "ffds_dense_s": 0.10}}
"""Seconds at 400 source points on the paper's 2.8 GHz quad core."""

PUBLISHED_ACCURACY = {"virtual": {"ffds": (25, 0.03), "ffd_hsu": (216, 0.03)},
                      "measured": {"ffds": (36, 0.15), "ffd_hsu": (343, 0.16)}}
"""From how many control points in all, and the paper's metric in mm there."""


def solve_times(case: PaperCase, progress: Progress, repeats: int = REPEATS) -> list[Row]:
    """Figures 6a and 9a: seconds of the solve alone, ΔP from Δp, over the number of source points, N = 10.

    ``ffds_s`` takes B⁺ as a Kronecker product, ``ffds_dense_s`` and ``ffd_hsu_s`` as the dense pseudo-inverse of the
    paper; ``ffd_hsu_touched_s`` leaves out the control points that no source point depends on, ``ffd_hsu_fast_s`` is
    the product form of the lattice in space.
    """
    face = nominal()
    control = displacement_lattice(face.surface, (LATTICE, LATTICE))
    volume = ffd.enclose(face, (LATTICE, LATTICE, LATTICE))
    rows = []
    for count in SOURCE_POINTS:
        progress(f"Solve times, {case.name}: {count} source points")
        u, v, on_face = ffds.equidistant_grid(face, count)
        source = ffd.FaceSource(u, v, face.surface.on_grid(u, v), on_face)
        points = source.points.reshape(-1, 3)
        moves = case.target[nearest_neighbours(case.target, points)[1]] - points
        jobs = {
            "ffds_s": partial(ffds.solve_lattice, control, u, v, on_face, moves),
            "ffds_dense_s": partial(_solve_dense, control, source, moves),
            "ffd_hsu_s": partial(ffd.solve_volume_dense, volume, points, moves),
            "ffd_hsu_touched_s": partial(_solve_touched, volume, points, moves),
            "ffd_hsu_fast_s": partial(ffd.solve_volume, volume, source, moves),
        }
        row: Row = {"source_points": len(points)}
        rows.append(row | median_seconds(jobs, repeats))
    return rows


def _solve_dense(control: ControlLattice, source: ffd.FaceSource, moves: Array) -> Array:
    return ffds.pseudo_inverse(ffds.lattice_basis(control, source.u, source.v)) @ moves


def _solve_touched(volume: ffd.VolumeLattice, points: Array, moves: Array) -> Array:
    matrix = ffd.volume_basis(volume, points)
    touched = matrix.any(axis=0)
    result = np.zeros((matrix.shape[1], 3))
    result[touched] = ffds.pseudo_inverse(matrix[:, touched]) @ moves
    return result


def accuracies(case: PaperCase, progress: Progress) -> list[Row]:
    """Figures 6b and 9b: accuracy over the number of control points per direction, 400 source points."""
    judge = Judge(case)
    rows = []
    for n in CONTROL_POINTS:
        progress(f"Accuracy, {case.name}: N = {n}")
        row: Row = {"control_points_per_direction": n, "control_points_ffds": n**2, "control_points_ffd_hsu": n**3}
        for name, register in METHODS.items():
            row[name] = judge.accuracy(register(case.target, (n, n), SOURCE)).as_dict()
        rows.append(row)
    return rows


def whole_step(case: PaperCase, progress: Progress, repeats: int = REPEATS) -> dict[str, float]:
    """Method ``ffds`` with its correspondences and its solve, beside building one k-d tree of the same cloud."""
    progress("Whole step")
    face = nominal()
    return median_seconds({
        "whole_step_s": lambda: ffds.register_ffds(face, case.target, (LATTICE, LATTICE), SOURCE),
        "kdtree_build_s": lambda: cKDTree(case.target),
    }, repeats)
