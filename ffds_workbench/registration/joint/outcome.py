# SPDX-License-Identifier: LGPL-2.1-or-later
"""Turns the last state of the joint solve into its result, or refuses it."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ...errors import RefusedError
from ..arrays import Array, Index
from ..motions import apply, best_fit
from .data import Correspondence, correspond
from .iteration import EdgeCache, PointCache, State
from .joint_result import JointRegistration, SolidMotion
from .prior_trust import is_isometric, observed_strain
from .problem import Problem
from .surfaces import normals
from .uncertainty import assess

_TORN_STEP, _TORN_AREA = 0.5, 0.05
"""Faces that move by this share of the largest step wander; of the part's area they may be this share, so that the
others hold them (units)."""
_LEAST_USED_POINTS = 50
"""Points near the part that hold it, and points near its free faces (unit)."""
_LEAST_USED_SHARE = 0.02
"""Of the scan, that has to lie near the part (unit)."""
_COLLAPSED_AREA = 0.1
"""Share of its nominal area below which a cell has collapsed (unit)."""
_OFF_IN_NOISES, _OFF_SHARE, _NEGLIGIBLE = 10.0, 0.2, 1e-5
"""A face does not follow the scan if it lies off its points by more than ten times the noise, a fifth of what the
nominal part does, and 1e-4 of the part's size (calibrated: by hand, on the families of ``./ffds benchmark accuracy``;
unit: less than that nobody sees)."""
_LEAST_JUDGED_POINTS, _LEAST_JUDGED_COVER = 50, 0.3
"""Points and coverage that a face has to have to be judged: what lies near it by chance does not cover it (unit)."""


def torn_faces(problem: Problem, state: State) -> tuple[int, ...]:
    """Small faces that keep moving while the rest of the part has settled: they fit the scan in two places."""
    if state.face_steps is None or state.last_step <= problem.lengths.not_converged:
        return ()
    wandering = state.face_steps > _TORN_STEP * state.last_step
    area = np.bincount(problem.face_of_cell, problem.area.ravel())
    small = area[wandering].sum() < _TORN_AREA * area.sum()
    return tuple(np.flatnonzero(wandering).tolist()) if small else ()


def refuse_unsound(problem: Problem, state: State) -> None:
    """Raise RefusedError where the result cannot be trusted."""
    inside = problem.cells.inside
    position = problem.cells.nominal.position[inside]
    jet = problem.cells.displaced(problem.lattices, state.control_points, 3)
    moved = float(np.linalg.norm(jet.position[inside] - position, axis=1).max())
    used = int(state.values.count.sum())
    if used < _LEAST_USED_POINTS or used < _LEAST_USED_SHARE * len(problem.scan):
        raise RefusedError(f"Only {used} of {len(problem.scan)} scan points lie near the part: check the unit of the "
                           "scan and align it first.")
    of_face = np.bincount(problem.face_of_cell, weights=state.values.count, minlength=len(problem.part.faces))
    free = int(np.delete(of_face, list(problem.part.frozen)).sum())
    if free < _LEAST_USED_POINTS:
        raise RefusedError(f"Only {free} scan points lie near faces that may move: freeze fewer faces, or scan the "
                           "free ones.")
    if not np.isfinite(moved) or moved > problem.size:
        raise RefusedError(f"The displacement found, {moved:.0f} mm, is larger than the part ({problem.size:.0f} mm): "
                           "align the scan first.")
    if state.last_step > problem.lengths.not_converged:
        name = "the part" if state.face_steps is None else problem.part.faces[int(state.face_steps.argmax())].name
        raise RefusedError(f"The registration did not converge (the last step moved {name} by {state.last_step:.2f} "
                           "mm): the scan does not constrain the part; align it first, or freeze faces.")
    _refuse_off_scan(problem, state)
    normal, area = normals(jet, problem.cells.outward)
    nominal_normal, nominal_area = normals(problem.cells.nominal, problem.cells.outward)
    expected = _rotated_normals(problem, jet.position, nominal_normal)
    turned = np.einsum("skx,skx->sk", normal, expected)
    folded = inside & ((turned <= 0) | (area < _COLLAPSED_AREA * nominal_area))
    if folded.any():
        face = problem.part.faces[problem.lattices.face_of_span[np.flatnonzero(folded.any(axis=1))[0]]].name
        raise RefusedError(f"{face} would fold over: the scan does not determine it; freeze it or scan it better.")


def _refuse_off_scan(problem: Problem, state: State) -> None:
    """Raise RefusedError where scan points cover a face that lies far off them, be it farther than the solve reaches: a
    body that moved by more than the rest of the part."""
    noise, farthest = problem.lengths.noise, problem.lengths.farthest
    before = np.median(np.abs(_all_matched(problem, np.zeros_like(state.control_points), farthest).height))
    found = _all_matched(problem, state.control_points, farthest)
    face = problem.face_of_cell[found.cell]
    expected = np.bincount(problem.face_of_cell, problem.area.ravel()) * problem.statistics.density
    enough = np.maximum(_LEAST_JUDGED_COVER * expected * len(problem.sample) / len(problem.scan), _LEAST_JUDGED_POINTS)
    judged = np.flatnonzero(np.bincount(face, minlength=len(enough)) >= enough)
    after = np.array([np.median(np.abs(found.height[face == index])) for index in judged])
    worst = int(np.argmax(after)) if len(after) else 0
    if len(after) and after[worst] > max(_OFF_IN_NOISES * max(noise, _NEGLIGIBLE * problem.size), _OFF_SHARE * before):
        name = problem.part.faces[judged[worst]].name
        raise RefusedError(f"The registration leaves {name} off its scan points, by {after[worst]:.2g} mm where the "
                           f"noise is {noise:.2g} mm: align the scan better, or register the face by itself (--face "
                           f"{name}).")


def _all_matched(problem: Problem, control_points: Array, reach: float) -> Correspondence:
    """All points of the sample within ``reach`` mm of a shape, before any is weighed."""
    jet = problem.cells.displaced(problem.lattices, control_points)
    return correspond(problem.sample, problem.frames(jet), reach)


def _rotated_normals(problem: Problem, position: Array, normal: Array) -> Array:
    """Nominal normals (spans, k, 3) turned with the rigid motion of their solid."""
    result = normal.copy()
    for solid in problem.part.solids:
        spans = np.flatnonzero(np.isin(problem.lattices.face_of_span, solid))
        result[spans] = normal[spans] @ _solid_motion(problem, position, solid).T_asbuilt_nominal[:3, :3].T
    return result


def _solid_motion(problem: Problem, position: Array, solid: Index) -> SolidMotion:
    """Best rigid motion of a solid onto its as-built cells, weighted by area."""
    spans = np.flatnonzero(np.isin(problem.lattices.face_of_span, solid))
    weight = problem.area[spans].ravel()
    a, b = (x[spans].reshape(-1, 3) for x in (problem.cells.nominal.position, position))
    motion = best_fit(a, b, weight)
    left = ((b - apply(motion, a)) ** 2).sum(axis=1)
    return SolidMotion(motion, float(np.sqrt(np.average(left, weights=weight))))


def summarise(problem: Problem, state: State) -> JointRegistration:
    """The result; its bands and flags are computed at first use."""
    position = problem.cells.displaced(problem.lattices, state.control_points, 1).position
    displacements = tuple(problem.lattices.spline(index, state.control_points)
                          for index in range(len(problem.part.faces)))
    kept = replace(state.cache, factor=None, points=PointCache(), edges=EdgeCache(borders=state.cache.edges.borders))
    return JointRegistration(
        displacements, partial(assess, problem, replace(state, cache=kept), displacements),
        solids=tuple(_solid_motion(problem, position, solid) for solid in problem.part.solids),
        thickness=_thickness(problem, state), strain=observed_strain(problem, state), isometric=is_isometric(state),
        iterations=state.iterations, last_step=state.last_step, used=int(state.values.count.sum()),
        unsure=state.unsure, free_motions=problem.free_motions.texts)


def _thickness(problem: Problem, state: State) -> tuple[float | None, ...]:
    pairs = problem.couplings.pairs
    measured = problem.couplings.measured_thickness(state.control_points)
    result = []
    for solid, nominal in zip(problem.part.solids, pairs.solid_thickness, strict=True):
        own = np.isin(pairs.front.face, solid)
        result.append(float(np.average(measured[own], weights=pairs.area[own])) if nominal and own.any() else None)
    return tuple(result)
