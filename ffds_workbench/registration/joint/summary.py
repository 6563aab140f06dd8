# SPDX-License-Identifier: LGPL-2.1-or-later
"""Turns the last state of the joint solve into its result, or refuses it."""
from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from ...errors import RefusedError
from ..rigid.motions import apply, best_fit
from ..splines import Array
from .bands import TWO_SIDED, edge_bands, normal_bands
from .coverage import BRIDGED, CARRIED, OBSERVED, Coverage, coverage
from .lattice import Index
from .misfit import misfit, nearest_spans
from .posterior import covariance_blocks
from .problem import Problem
from .raster import normals
from .result import EdgeRegistration, Flag, JointFace, JointRegistration, SolidMotion
from .samples import sample
from .shared_noise import shared_errors
from .sheet import parameters
from .state import State
from .trust import is_isometric, observed_strain

_NOT_CONVERGED = 0.5
_FEWEST_USED = 50
_LEAST_SHARE = 0.02
_COLLAPSED = 0.1
Flags = NDArray[np.str_]


def refuse_bad(problem: Problem, state: State) -> None:
    """Raise RefusedError where the result cannot be honest."""
    inside = problem.cells.inside
    position = problem.cells.nominal.position[inside]
    size = float(np.linalg.norm(np.ptp(position, axis=0)))
    jet = problem.cells.displaced(problem.lattices, state.control_points, 3)
    moved = float(np.linalg.norm(jet.position[inside] - position, axis=1).max())
    used = int(state.values.count.sum())
    if used < _FEWEST_USED or used < _LEAST_SHARE * len(problem.scan):
        raise RefusedError(f"Only {used} of {len(problem.scan)} scan points lie near the part: check the unit of the "
                           "scan and align it first.")
    of_face = np.bincount(problem.face_of_cell, weights=state.values.count, minlength=len(problem.part.faces))
    free = int(np.delete(of_face, list(problem.part.frozen)).sum())
    if free < _FEWEST_USED:
        raise RefusedError(f"Only {free} scan points lie near faces that may move: freeze fewer faces, or scan the "
                           "free ones.")
    if not np.isfinite(moved) or moved > size:
        raise RefusedError(f"The displacement found, {moved:.0f} mm, is larger than the part ({size:.0f} mm): "
                           "align the scan first.")
    if state.last_step > _NOT_CONVERGED:
        raise RefusedError(f"The registration did not converge (the last step was {state.last_step:.2f} mm): the scan "
                           "does not hold the part; align it first, or freeze faces.")
    normal, area = normals(jet, problem.cells.outward)
    nominal_normal, nominal_area = normals(problem.cells.nominal, problem.cells.outward)
    expected = _turned(problem, jet.position, nominal_normal)
    turned = np.einsum("skx,skx->sk", normal, expected)
    folded = inside & ((turned <= 0) | (area < _COLLAPSED * nominal_area))
    if folded.any():
        face = problem.part.faces[problem.lattices.face_of_span[np.flatnonzero(folded.any(axis=1))[0]]].name
        raise RefusedError(f"{face} would fold over: the scan does not determine it; freeze it or scan it better.")


def _turned(problem: Problem, position: Array, normal: Array) -> Array:
    """Nominal normals (spans, k, 3) turned with the rigid motion of their solid."""
    result = normal.copy()
    for solid in problem.part.solids:
        spans = np.flatnonzero(np.isin(problem.lattices.face_of_span, solid))
        result[spans] = normal[spans] @ _motion(problem, position, solid).T_asbuilt_nominal[:3, :3].T
    return result


def _motion(problem: Problem, position: Array, solid: Index) -> SolidMotion:
    """Best rigid motion of a solid onto its as-built cells, weighted by area."""
    spans = np.flatnonzero(np.isin(problem.lattices.face_of_span, solid))
    weight = problem.area[spans].ravel()
    a, b = (x[spans].reshape(-1, 3) for x in (problem.cells.nominal.position, position))
    motion = best_fit(a, b, weight)
    left = ((b - apply(motion, a)) ** 2).sum(axis=1)
    return SolidMotion(motion, float(np.sqrt(np.average(left, weights=weight))))


def summarise(problem: Problem, state: State) -> JointRegistration:
    """The result with bands and flags."""
    covariance, factor = covariance_blocks(problem, state)
    seen = coverage(problem, state.values)
    off = misfit(problem, state.values) + (state.unsure / TWO_SIDED) ** 2
    errors = shared_errors(problem, state, factor)
    position = problem.cells.displaced(problem.lattices, state.control_points, 1).position
    return JointRegistration(
        faces=_faces(problem, state, covariance, errors, seen, off),
        edges=_edges(problem, state, covariance, errors, seen, off),
        solids=tuple(_motion(problem, position, solid) for solid in problem.part.solids),
        thickness=_thickness(problem, state), strain=observed_strain(problem, state), isometric=is_isometric(state),
        iterations=state.iterations, last_step=state.last_step, used=int(state.values.count.sum()),
        unsure=state.unsure)


def _thickness(problem: Problem, state: State) -> tuple[float | None, ...]:
    pairs = problem.couplings.pairs
    measured = problem.couplings.measured_thickness(state.control_points)
    result = []
    for solid, nominal in zip(problem.part.solids, pairs.solid_thickness, strict=True):
        own = np.isin(pairs.front.face, solid)
        result.append(float(np.average(measured[own], weights=pairs.area[own])) if nominal and own.any() else None)
    return tuple(result)


def _faces(problem: Problem, state: State, covariance: Array, errors: Array, seen: Coverage, off: Array
           ) -> tuple[JointFace, ...]:
    places, lattices = problem.stiffness.places, problem.lattices
    jet = places.displaced(lattices, state.control_points, 3)
    normal = normals(jet, places.outward)[0]
    span, place = np.nonzero(places.inside)
    face = lattices.face_of_span[span]
    uv = parameters(lattices, places, span, place)
    gap_inside = seen.gap_of(face, places.nominal.position[span, place])
    gap = np.zeros(places.inside.shape)
    gap[span, place] = gap_inside
    beyond = np.maximum(gap - 2 * seen.near, 0.0)
    bands = normal_bands(problem, covariance, errors, places.tables[0], normal, beyond, _border(problem),
                         off)[span, place]
    flags = seen.flags(gap_inside, face, 2 * seen.near)
    points = np.bincount(problem.face_of_cell, weights=state.values.count, minlength=len(problem.part.faces))
    result = []
    for index, geometry in enumerate(problem.part.faces):
        own = face == index
        result.append(JointFace(geometry.name, lattices.spline(index, state.control_points), int(points[index]),
                                float(seen.share[index]), float(state.noise[index]), _most(flags[own]),
                                _rms(bands[own]), uv[own], bands[own], flags[own]))
    return tuple(result)


def _border(problem: Problem) -> Array:
    """Distance in mm of the Gauss places from the border of their face, that of the cells around them: (spans, k)."""
    per_span = int(np.sqrt(problem.cells.inside.shape[1]))
    cell = np.floor(problem.stiffness.places.local * per_span).astype(int)
    return problem.distance[:, cell[:, 0] * per_span + cell[:, 1]]


def _edges(problem: Problem, state: State, covariance: Array, errors: Array, seen: Coverage, off: Array
           ) -> tuple[EdgeRegistration, ...]:
    part, lattices = problem.part, problem.lattices
    edges = [edge for edge in part.edges if edge.faces]
    number = np.concatenate([np.full(len(edge.points), k) for k, edge in enumerate(part.edges) if edge.faces])
    nominal = np.concatenate([edge.points for edge in edges])
    first, last = (np.concatenate([np.full(len(edge.points), edge.faces[k]) for edge in edges]) for k in (0, -1))
    samples = sample(part.faces, lattices, first, np.concatenate([edge.uv[0] for edge in edges]))
    points = samples.nominal[0] + samples.displacement(state.control_points)
    near = seen.edge_near(float(problem.margin.max()))
    gaps = [seen.gap_of(face, nominal) for face in (first, last)]
    gap = np.maximum(np.minimum(*gaps) - near, 0.0)
    flags = _better(seen.flags(gaps[0], first, near), seen.flags(gaps[1], last, near))
    spans = nearest_spans(problem, np.concatenate([first, last]), np.tile(nominal, (2, 1)))
    bands = edge_bands(problem, covariance, errors, samples, _directions(points, number), gap,
                       off[spans].reshape(2, -1).max(axis=0))
    result = []
    for index, edge in enumerate(part.edges):
        own = number == index
        result.append(EdgeRegistration(edge.name, points[own], bands[own], flags[own], _most(flags[own]),
                                       _rms(bands[own])))
    return tuple(result)


def _directions(points: Array, number: Index) -> Array:
    after, before = np.roll(points, -1, axis=0), np.roll(points, 1, axis=0)
    last, first = np.roll(number, -1) != number, np.roll(number, 1) != number
    step = np.where(last[:, None], points, after) - np.where(first[:, None], points, before)
    return step / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12)


def _better(first: Flags, second: Flags) -> Flags:
    """The stronger of two flags: an edge is observed if either of its faces is observed there."""
    order = {OBSERVED: 0, BRIDGED: 1, CARRIED: 2}
    rank = np.minimum([order[f] for f in first], [order[f] for f in second])
    return np.array([OBSERVED, BRIDGED, CARRIED])[rank]


def _most(flags: Flags) -> Flag:
    if not len(flags):
        return "carried"
    names, count = np.unique(flags, return_counts=True)
    return cast(Flag, str(names[np.argmax(count)]))


def _rms(bands: Array) -> float:
    return float(np.sqrt(np.mean(bands**2))) if len(bands) else float("inf")
