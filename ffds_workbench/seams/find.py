# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which edges are seams: those that are named, and those where parts meet."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError, RefusedError
from .chains import Seam, Stretch, grow, join, refuse_branches
from .joints import find_joints
from .settings import SeamSettings
from .weldment import Weldment

NAMED_TOLERANCE = 0.5
"""A named edge that lies on another part within this (mm) over all its length is a joint of the two parts."""
_ALL_OF_IT = 0.97
_MOST_OF_IT = 0.5


@dataclass(frozen=True)
class FoundSeams:
    """Seams, and in ``notes`` a sentence for each thing that was left out."""

    seams: tuple[Seam, ...]
    notes: tuple[str, ...]


def named_seams(weldment: Weldment, names: Sequence[str], settings: SeamSettings, chain: bool = False,
                tolerance: float = NAMED_TOLERANCE) -> FoundSeams:
    """Seams along named edges, joined where they go on along tangency.

    An edge that lies on another part over most of its length is a joint: the weld runs there, and joins the faces that
    open to the air, of both parts. Any other edge has the two faces that it bounds.

    Parameters
    ----------
    names : "EdgeN", numbered as FreeCAD numbers the shape
    chain : add all edges that go on from the named ones along tangency

    Raises
    ------
    InputError : there is no such edge
    RefusedError : an edge is a point, has not two faces, or is too short; the edges branch
    """
    edges = list(dict.fromkeys(weldment.edge_index(name) for name in names))
    if not edges:
        raise InputError("Name at least one edge for the seam.")
    for edge in edges:
        weldment.sides(edge)
    if chain:
        edges = list(dict.fromkeys(other for edge in edges for other in grow(weldment, edge, settings.corner)))
    stretches, notes = [], []
    for edge in edges:
        joints, covered = _joints_on(weldment, edge, tolerance)
        if _MOST_OF_IT <= covered < _ALL_OF_IT:
            notes.append(f"Edge{edge + 1} lies on another part over {covered:.0%} of its length: the seam runs there "
                         "alone.")
        stretches += joints if covered >= _MOST_OF_IT else [Stretch(edge, 0.0, 1.0, weldment.sides(edge))]
    refuse_branches(weldment, stretches)
    seams, branchings = join(weldment, stretches, settings.corner)
    if branchings:
        raise RefusedError(branchings[0] + ": name the edges of one path.")
    for seam in seams:
        length = seam_length(weldment, seam)
        if length < settings.min_length:
            raise RefusedError(f"{seam.name} is only {length:.2g} mm long: a seam needs at least "
                               f"{settings.min_length:g} mm.")
    return FoundSeams(tuple(seams), tuple(notes))


def joint_seams(weldment: Weldment, tolerance: float, settings: SeamSettings, names: Sequence[str] = ()) -> FoundSeams:
    """Seams where edges of one part lie on another part within ``tolerance`` mm; those that touch named edges, if any.

    Raises
    ------
    InputError : the tolerance is no length, or there is no such edge
    RefusedError : nothing is found
    """
    if not 0.0 < tolerance <= 50.0:
        raise InputError(f"The tolerance for joints must be a length between 0 and 50 mm, not {tolerance:g}.")
    if len(weldment.parts) < 2:
        raise RefusedError("The model is a single part, so no part lies on another: name the edges of the seam.")
    wanted = {weldment.edge_index(name) for name in names}
    stretches, left_out = find_joints(weldment, tolerance, None, settings.min_length)
    seams, branchings = join(weldment, stretches, settings.corner)
    if wanted:
        seams = [seam for seam in seams if wanted & {stretch.edge for stretch in seam.stretches}]
        missing = wanted - {stretch.edge for seam in seams for stretch in seam.stretches}
        if missing:
            edge = min(missing)
            raise RefusedError(f"Edge{edge + 1} lies on no other part within {tolerance:g} mm: use a larger tolerance "
                               "or name it without one.")
    if not seams:
        reason = f": {left_out[0].rstrip('.')}" if left_out else ""
        raise RefusedError(f"No part lies on another within {tolerance:g} mm{reason}.")
    return FoundSeams(tuple(seams), (*left_out, *(f"{branching}." for branching in branchings)))


def _joints_on(weldment: Weldment, edge: int, tolerance: float) -> tuple[list[Stretch], float]:
    """The joints along one edge, whole where they cover all but its ends, and the share of it that they cover."""
    joints, _ = find_joints(weldment, tolerance, [edge])
    for joint in joints:
        if joint.end - joint.start >= _ALL_OF_IT:
            return [replace(joint, start=0.0, end=1.0)], 1.0
    return joints, sum(joint.end - joint.start for joint in joints)


def seam_length(weldment: Weldment, seam: Seam) -> float:
    """Length of a seam in mm, by chords."""
    along = np.linspace(0.0, 1.0, 65)
    return sum(float(np.linalg.norm(np.diff(weldment.curve(stretch.edge, stretch.fractions(along)).points, axis=0),
                                    axis=1).sum()) for stretch in seam.stretches)
