# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motions that map the nominal part onto itself: a scan cannot distinguish the poses that they connect.

Every such motion keeps the area centroid and the inertia of the surface, so only turns about the principal axes come
into question, and where two principal moments agree, turns about the third axis by any angle.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Array
from ..motions import angle, apply, even_rotations, motion, turn_name
from .model import Target, kept_with_target
from .refine import refine
from .settings import SymmetrySettings


@dataclass(frozen=True)
class Symmetry:
    """Self-motions of the part.

    Attributes
    ----------
    motions : (k, 4, 4) without the identity; of a continuous symmetry a few representatives
    exact : (k,) whether the part is the same after it; else only nearly so
    axis : (3,) axis of a body of revolution, or None
    ends_alike : whether a body of revolution is the same end for end
    half_turn : a turn this close to a half turn, in rad, is one about the opposite axis as well
    """

    motions: Array
    exact: Array
    axis: Array | None
    ends_alike: bool = False
    half_turn: float = 0.01

    def text(self) -> str:
        """One phrase for the user, empty if there is no symmetry."""
        if self.axis is not None:
            x, y, z = np.round(self.axis, 2) + 0.0
            if self.ends_alike:
                return f"a body of revolution about the axis ({x:.2f}, {y:.2f}, {z:.2f}), symmetric end for end"
            return f"a body of revolution about the axis ({x:.2f}, {y:.2f}, {z:.2f})"
        phrases = [turn_name(Rotation.from_matrix(pose[:3, :3]).as_rotvec(), self.half_turn)
                   for pose in self.motions[self.exact]]
        return "the same after a turn of " + " or ".join(phrases) if phrases else ""


@kept_with_target
def symmetry_of(target: Target) -> Symmetry:
    """Find the self-motions of a part."""
    samples, size, settings = target.samples, target.size, target.settings.symmetry
    arm = samples.points - target.centre
    weight = samples.area / samples.area.sum()
    moments, axes = np.linalg.eigh((arm * weight[:, None]).T @ arm)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    generator = np.random.default_rng(0)
    chosen = generator.choice(len(weight), min(settings.points, len(weight)), replace=False, p=weight)
    points = samples.points[chosen]
    found: list[Array] = []
    exact: list[bool] = []
    families = _families(moments, axes, settings)
    for family in families:
        poses = motion(family, target.centre - family @ target.centre)
        misses = np.array([_misses(target, points[:150], pose).mean() for pose in poses])
        if len(poses) == settings.angles - 1 and misses.max() < 0.5 * settings.nearly * size:
            turned = [_is_exact(target, points, pose) for pose in poses]
            if all(turned):
                return _revolution(target, points, poses, families[-1])
        lowest = np.ones(len(poses), dtype=bool)
        if len(poses) > 3:
            lowest = (misses <= np.roll(misses, 1)) & (misses <= np.roll(misses, -1))
        for pose in poses[(misses < 2.0 * settings.nearly * size) & lowest]:
            pose = refine(target, points, pose, tuple(k * settings.nearly * size for k in (4.0, 2.0)), 5)
            new = angle(pose, np.eye(4)) > 0.05 and all(angle(pose, other) > 0.05 for other in found)
            if new and _misses(target, points, pose).mean() < settings.nearly * size:
                exact.append(_is_exact(target, points, pose))
                if exact[-1]:
                    pose = refine(target, samples.points[::4], pose, (settings.exactly * size,))
                found.append(pose)
    return Symmetry(np.array(found).reshape(-1, 4, 4), np.array(exact, dtype=bool), None,
                    half_turn=settings.half_turn)


def _revolution(target: Target, points: Array, turns: Array, flips: Array) -> Symmetry:
    """A body of revolution, some of whose turns stand for all, and the flip end for end if it is the same after it."""
    flip = motion(flips[:1], target.centre - flips[:1] @ target.centre)
    motions = np.concatenate([turns[8::9], flip]) if _is_exact(target, points, flip[0]) else turns[8::9]
    axis = _axis(turns[8])
    return Symmetry(motions, np.ones(len(motions), dtype=bool), axis * np.sign(axis[np.argmax(np.abs(axis))]),
                    len(motions) > len(turns[8::9]))


def _families(moments: Array, axes: Array, settings: SymmetrySettings) -> list[Array]:
    """Rotations that keep the moments of inertia, neighbours next to one another: a list of (k, 3, 3)."""
    alike = settings.moments * moments[2]
    low, high = moments[1] - moments[0] < alike, moments[2] - moments[1] < alike
    half_turns = Rotation.from_rotvec(np.pi * axes.T).as_matrix()
    if low and high:
        return [rotation[None] for rotation in even_rotations(300)]
    if not (low or high):
        return [half_turns]
    k = 2 if low else 0
    angles = 2.0 * np.pi * np.arange(1, settings.angles) / settings.angles
    turns = Rotation.from_rotvec(angles[:, None] * axes[:, k]).as_matrix()
    flip = half_turns[(k + 1) % 3]
    return [turns, np.concatenate([flip[None], turns @ flip])]


def _misses(target: Target, points: Array, pose: Array) -> Array:
    """Distances in mm of the turned points from the part, seen or not, beyond what the sampling itself leaves; (n,)."""
    moved, whole = apply(pose, points), target.whole
    nearest = whole.tree.query(moved)[1]
    height, normal = whole.heights(moved, nearest)
    beside = np.linalg.norm(moved - whole.samples.points[nearest] - height[:, None] * normal, axis=1)
    return np.hypot(height, np.maximum(beside - 1.5 * whole.spacing, 0.0))


def _is_exact(target: Target, points: Array, pose: Array) -> bool:
    return bool(np.quantile(_misses(target, points, pose), 0.99) < target.settings.symmetry.exactly * target.size)


def _axis(pose: Array) -> Array:
    turn = Rotation.from_matrix(pose[:3, :3]).as_rotvec()
    return turn / np.linalg.norm(turn)
