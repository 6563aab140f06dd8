# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search over many poses at once: one Gauss-Newton step for all of them."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motions import angle, apply, shift, twist_motion, twist_rows
from ..model import NearestField


@dataclass(frozen=True)
class Candidates:
    """Poses under trial.

    Attributes
    ----------
    poses : (k, 4, 4), T_model_scan
    signs : (k, p) for each piece of the scan's surface +1 if its normals point out of the part, −1 if into it
    """

    poses: Array
    signs: Array

    def __getitem__(self, chosen: NDArray) -> Candidates:
        return Candidates(self.poses[chosen], self.signs[chosen])

    def __len__(self) -> int:
        return len(self.signs)

    @classmethod
    def all_signs(cls, poses: Array, pieces: int) -> Candidates:
        """Every pose with every combination of signs."""
        signs = np.array(list(product((1.0, -1.0), repeat=pieces)))
        return cls(np.tile(poses, (len(signs), 1, 1)), np.repeat(signs, len(poses), axis=0))


@dataclass(frozen=True)
class Probe:
    """Points of the scan that the search looks at.

    Attributes
    ----------
    points, normals : (m, 3)
    piece : (m,) the piece of surface that each belongs to
    sided : whether the normals tell one side from the other; else they hardly count
    """

    points: Array
    normals: Array
    piece: NDArray[np.intp]
    sided: bool = True


def improve(field: NearestField, probe: Probe, candidates: Candidates, gates: Sequence[float]) -> Candidates:
    """One Gauss-Newton step per gate for all candidates; ``gates`` are the distances in mm at which the weight
    (Geman-McClure) has fallen to a quarter."""
    settings = field.settings
    poses, scale = candidates.poses, np.array([2.0 / field.size] * 3 + [1.0] * 3)
    for gate in gates:
        moved, offset, normal, agreement = _match_nearest(field, probe, candidates.signs, poses)
        distance = np.einsum("kmi,kmi->km", offset, offset)
        weight = (gate**2 / (gate**2 + distance)) ** 2 * (settings.side_floor + agreement**2)
        height = np.einsum("kmi,kmi->km", normal, offset)
        jacobian = twist_rows(moved - field.centre, normal) * scale
        weighted = jacobian * weight[:, :, None]
        matrix = np.swapaxes(weighted, 1, 2) @ jacobian
        right = -np.einsum("kmi,km->ki", weighted, height)
        # a weak pull towards the sample itself: where planes leave a direction free the outline still guides the pose
        pull = settings.pull * weight
        matrix[:, 3:, 3:] += np.eye(3) * pull.sum(axis=1)[:, None, None]
        right[:, 3:] -= np.einsum("km,kmi->ki", pull, offset)
        matrix += np.eye(6) * (settings.damping * weight.sum(axis=1) + 1e-12)[:, None, None]
        update = np.linalg.solve(matrix, right[:, :, None])[:, :, 0] * scale
        turn = np.linalg.norm(update[:, :3], axis=1, keepdims=True)
        update[:, :3] *= np.minimum(1.0, settings.longest_turn / np.maximum(turn, 1e-12))
        poses = twist_motion(update, field.centre) @ poses
    return Candidates(poses, candidates.signs)


def scores(field: NearestField, probe: Probe, candidates: Candidates, width: float) -> Array:
    """Mean over the points of closeness (to ``width`` mm) times agreement of the normals, 0…1; (k,)."""
    _, offset, normal, agreement = _match_nearest(field, probe, candidates.signs, candidates.poses)
    distance = np.einsum("kmi,kmi->km", offset, offset)
    return (agreement * width**2 / (width**2 + distance)).mean(axis=1)


def _match_nearest(field: NearestField, probe: Probe, signs: Array, poses: Array) -> tuple[Array, Array, Array, Array]:
    """Moved points, their offsets from the nearest samples, those samples' normals, and how well they agree."""
    moved, blind = apply(poses, probe.points), field.settings.blind_agreement
    turned = signs[:, probe.piece, None] * (probe.normals @ np.swapaxes(poses[:, :3, :3], -1, -2))
    nearest = field(moved, turned if probe.sided else None)
    surface_normal = field.normals[nearest]
    cosine = np.einsum("kmi,kmi->km", turned, surface_normal)
    agreement = np.maximum(cosine, 0.0) if probe.sided else blind + (1.0 - blind) * np.abs(cosine)
    return moved, moved - field.points[nearest], surface_normal, agreement


def distinct(candidates: Candidates, score: Array, centre: Array, most: int, turn: float, distance: float,
             ) -> NDArray[np.intp]:
    """Indices of the best candidates that differ by more than ``turn`` rad or ``distance`` mm, best first."""
    kept: list[int] = []
    for k in np.argsort(-score):
        others = candidates[np.array(kept, dtype=np.intp)]
        pose = candidates.poses[k]
        same = ((others.signs == candidates.signs[k]).all(axis=1) & (angle(others.poses, pose) < turn)
                & (shift(others.poses, pose, centre) < distance))
        if not same.any():
            kept.append(int(k))
        if len(kept) == most:
            break
    return np.array(kept, dtype=np.intp)
