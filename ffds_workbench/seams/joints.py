# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints: stretches of one part's edges that lie on another part, and the two faces that a weld there joins.

An edge lies on a face where its points are nearer than a tolerance and it runs along the face, not into it. Of its own
two faces and the other part's, the weld joins the pair that opens widest towards free air.
"""
from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from .chains import Stretch
from .weldment import Weldment

_SAMPLES = 33
_COARSE = 4
_ALONG = np.sin(np.deg2rad(20.0))
_LEAST_OPENING = np.deg2rad(20.0)
_FLAT = np.deg2rad(150.0)
_LARGE = 0.5
_BESIDE = 0.01
"""Farther beside a face's border than this (mm, and what it is farther inside), an edge no longer lies on it."""
_SAME_RUN = 0.9
"""Two faces belong to the same run of an edge where they share this much of it."""


@dataclass(frozen=True)
class _Run:
    """Fractions of an edge between which it lies on a face of another part."""

    face: int
    start: float
    end: float

    def shared(self, other: _Run) -> float:
        """Length in common, in fractions."""
        return min(self.end, other.end) - max(self.start, other.start)


def find_joints(weldment: Weldment, tolerance: float, edges: Iterable[int] | None = None,
                min_length: float = 0.0) -> tuple[list[Stretch], list[str]]:
    """All stretches where an edge of one part lies on another part within ``tolerance`` mm.

    Parameters
    ----------
    edges : look at these only
    min_length : shorter stretches (mm) are left out and reported

    Returns
    -------
    stretches : each joint once, though it may be an edge of both parts
    left_out : a sentence for each that is too short
    """
    found: list[tuple[Stretch, float]] = []
    left_out = []
    for edge in range(len(weldment.edges)) if edges is None else edges:
        for stretch in _joints_of_edge(weldment, edge, tolerance):
            length = _length(weldment, stretch)
            if length >= min_length:
                found.append((stretch, length))
            elif length > 4.0 * tolerance:
                left_out.append(f"{stretch.name} lies on another part over {length:.2g} mm only, too short for a seam.")
    return _each_once(weldment, found, tolerance), left_out


def _joints_of_edge(weldment: Weldment, edge: int, tolerance: float) -> list[Stretch]:
    try:
        own = weldment.sides(edge)
    except RefusedError:
        return []
    part = weldment.part_of_face.get(own[0])
    if part is None or part != weldment.part_of_face.get(own[1]):
        return []
    stretches = []
    for other, faces in enumerate(weldment.parts):
        if other != part:
            runs = [run for face in faces for run in _runs(weldment, edge, face, tolerance)]
            for on, start, end in _together(runs):
                stretch = _joined_faces(weldment, edge, own, on, (start, end), tolerance)
                if stretch is not None:
                    stretches.append(stretch)
    return stretches


def _runs(weldment: Weldment, edge: int, face: int, tolerance: float) -> list[_Run]:
    """Where an edge lies on a face, its ends found by bisection."""
    fractions = np.linspace(0.0, 1.0, _SAMPLES)
    curve = weldment.curve(edge, fractions)
    box = weldment.faces[face].BoundBox
    low, high = np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])
    close = ((curve.points > low - tolerance) & (curve.points < high + tolerance)).all(axis=1)
    if np.count_nonzero(close) < 2:
        return []
    on = np.zeros(_SAMPLES, dtype=bool)
    coarse = np.flatnonzero(close & (np.arange(_SAMPLES) % _COARSE == 0))
    distances = weldment.distances(face, curve.points[coarse])
    # A distance from the face changes by no more than one walks: most points need no search.
    apart = np.linalg.norm(curve.points[:, None] - curve.points[coarse], axis=2)
    close &= (distances - apart).max(axis=1, initial=-np.inf) <= tolerance
    if np.count_nonzero(close) < 2:
        return []
    nearest = weldment.nearest((face,), curve.points[close])
    along = np.abs(np.einsum("ij,ij->i", curve.tangents[close], nearest.normals)) < _ALONG
    on[close] = (nearest.distances <= tolerance) & along
    runs = []
    for first, last in _true_runs(on):
        # An end is sought from the second sample inwards: the first may already lie beyond the face's border.
        inner_first, inner_last = min(first + 1, last), max(last - 1, first)
        start = 0.0 if first == 0 else _border(weldment, edge, face, tolerance, fractions[[inner_first, first - 1]])
        at_end = last == _SAMPLES - 1
        end = 1.0 if at_end else _border(weldment, edge, face, tolerance, fractions[[inner_last, last + 1]])
        if end > start:
            runs.append(_Run(face, start, end))
    return runs


def _true_runs(flags: Array) -> list[tuple[int, int]]:
    """First and last index of each run of True."""
    steps = np.diff(np.concatenate([[False], flags, [False]]).astype(int))
    return list(zip(np.flatnonzero(steps == 1).tolist(), (np.flatnonzero(steps == -1) - 1).tolist(), strict=True))


def _border(weldment: Weldment, edge: int, face: int, tolerance: float, between: Array) -> float:
    """Fraction where the edge leaves the face, between one on it and one off it: too far away, or beside its border."""
    def measured(fraction: float) -> tuple[float, float]:
        point = weldment.curve(edge, np.array([fraction])).points
        nearest = weldment.nearest((face,), point)
        offset = (point - nearest.points)[0]
        return nearest.distances[0], float(np.linalg.norm(offset - (offset @ nearest.normals[0]) * nearest.normals[0]))

    on, off = between.tolist()
    beside = measured(on)[1] + _BESIDE
    for _ in range(16):
        middle = 0.5 * (on + off)
        distance, aside = measured(middle)
        if distance <= tolerance and aside <= beside:
            on = middle
        else:
            off = middle
    return on


def _together(runs: list[_Run]) -> list[tuple[tuple[int, ...], float, float]]:
    """Faces that an edge lies on at the same time, with the run; a run inside a longer one is that one's mere end."""
    groups: list[list[_Run]] = []
    for run in sorted(runs, key=lambda run: run.start - run.end):
        for group in groups:
            shared = run.shared(group[0])
            if shared >= _SAME_RUN * (group[0].end - group[0].start):
                group.append(run)
                break
            if shared >= 0.5 * (run.end - run.start):
                break
        else:
            groups.append([run])
    return [(tuple(sorted({run.face for run in group})), group[0].start, group[0].end) for group in groups]


def _joined_faces(weldment: Weldment, edge: int, own: tuple[int, int], on: tuple[int, ...], run: tuple[float, float],
                  tolerance: float) -> Stretch | None:
    """The stretch with the pair of faces that opens widest, if there is air for a torch."""
    fractions = run[0] + (run[1] - run[0]) * np.array([0.25, 0.5, 0.75])
    points = weldment.curve(edge, fractions).points
    own_normals = {face: weldment.normals_beside(face, edge, fractions) for face in own}
    other_normals = {face: weldment.nearest((face,), points).normals for face in on}
    pairs = []
    for face, other in itertools.product(own, on):
        dots = np.einsum("ij,ij->i", own_normals[face], other_normals[other])
        pairs.append((float(np.pi - np.arccos(np.clip(dots, -1.0, 1.0)).max()), face, other))
    for opening, face, other in sorted(pairs, key=lambda pair: (-round(pair[0], 6), pair[1:])):
        if opening < _LEAST_OPENING:
            return None
        outwards = own_normals[face] + other_normals[other]
        reach = max(0.5, 2.0 * tolerance) / np.linalg.norm(outwards, axis=1, keepdims=True)
        if not any(weldment.in_material(point) for point in points + reach * outwards):
            side = own[0] if face == own[1] else own[1]
            stretch = Stretch(edge, *run, (min(face, other), max(face, other)), on)
            return replace(stretch, kind=_kind(weldment, stretch, face, side, opening))
    return None


def _kind(weldment: Weldment, stretch: Stretch, free: int, contact: int, opening: float) -> str:
    """The joint's name. A part lies (lap) on one of its large faces, and stands (T) on a small one."""
    if len(stretch.other) > 1:
        return "butt" if opening >= _FLAT else "corner"
    around = weldment.faces[free].Surface
    if around.isUClosed() or around.isVClosed():
        return "pipe"
    largest = max(weldment.areas[face] for face in weldment.parts[weldment.part_of_face[contact]])
    return "lap" if weldment.areas[contact] >= _LARGE * largest else "T"


def _length(weldment: Weldment, stretch: Stretch) -> float:
    points = weldment.curve(stretch.edge, stretch.fractions(np.linspace(0.0, 1.0, 65))).points
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _each_once(weldment: Weldment, found: list[tuple[Stretch, float]], tolerance: float) -> list[Stretch]:
    """Without those that others cover: where parts meet edge to edge, each has the joint. Whole edges stay."""
    def order(item: tuple[Stretch, float]) -> tuple[bool, float, int]:
        stretch, length = item
        return (stretch.start, stretch.end) != (0.0, 1.0), -round(length, 2), stretch.edge

    kept: list[tuple[Stretch, Array]] = []
    for stretch, _ in sorted(found, key=order):
        points = weldment.curve(stretch.edge, stretch.fractions(np.linspace(0.02, 0.98, 9))).points
        lines = [line for other, line in kept if _mirrored(weldment, stretch, other)]
        distances = [_distance_to_line(points, line) for line in lines]
        if not distances or np.min(distances, axis=0).max() > 2.0 * tolerance + 0.02:
            line = weldment.curve(stretch.edge, stretch.fractions(np.linspace(0.0, 1.0, 65))).points
            kept.append((stretch, line))
    return sorted((stretch for stretch, _ in kept), key=lambda stretch: (stretch.edge, stretch.start))


def _mirrored(weldment: Weldment, one: Stretch, other: Stretch) -> bool:
    """Whether each is an edge of the part that the other lies on."""
    def parts(stretch: Stretch) -> tuple[int, int]:
        return weldment.part_of_face[weldment.sides(stretch.edge)[0]], weldment.part_of_face[stretch.other[0]]

    return parts(one) == parts(other)[::-1]


def _distance_to_line(points: Array, line: Array) -> Array:
    """Distances of points (n, 3) from a polyline (m, 3)."""
    starts, steps = line[:-1], np.diff(line, axis=0)
    offsets = points[:, None] - starts
    at = np.clip((offsets * steps).sum(2) / np.maximum((steps**2).sum(1), 1e-30), 0.0, 1.0)
    return np.linalg.norm(offsets - at[..., None] * steps, axis=2).min(axis=1)
