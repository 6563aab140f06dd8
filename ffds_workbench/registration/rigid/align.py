# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of the paper: many poses proposed, the best ones refined, each verified against the model, one kept."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..splines import Array
from .alignment import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .fine import refine
from .motions import angle, apply, even_rotations, motion, shift
from .search import Candidates, Probe, distinct, field_of, improve, scores
from .sketch import Plane, Sketch, find_table, sketch_of, thin
from .smooth import settle
from .symmetry import Symmetry, symmetry_of
from .target import Target
from .units import plausible_scales, unit_name
from .verify import Evidence, examine, facing_normals, is_rough


@dataclass(frozen=True)
class Stage:
    """One round of the search.

    Attributes
    ----------
    points : of the scan that are looked at
    widest, closest, steps : gates of the Gauss-Newton steps, as shares of the part's size
    width : distance, as a share of the size, at which a point counts half in the score
    kept : poses that go on
    turn : poses closer than this (rad) are one; 0 keeps them all
    """

    points: int
    widest: float
    closest: float
    steps: int
    width: float
    kept: int
    turn: float


_THOROUGH = (Stage(120, 0.30, 0.10, 6, 0.05, 240, 0.0), Stage(250, 0.10, 0.05, 6, 0.04, 40, 0.12),
             Stage(600, 0.05, 0.03, 8, 0.03, 12, 0.05))
_QUICK = (Stage(100, 0.30, 0.07, 8, 0.04, 8, 0.1), Stage(400, 0.07, 0.02, 6, 0.015, 1, 0.05))
_LOCAL = (Stage(150, 0.08, 0.05, 6, 0.04, 30, 0.08), Stage(600, 0.05, 0.03, 8, 0.03, 5, 0.04))
_AROUND_ROTATIONS, _AROUND_TURN, _AROUND_SHIFT = 16, 0.35, 0.08
"""How far, in rad and as a share of the part's size, the surroundings of the best pose are searched once more."""
_QUICK_ROTATIONS, _QUICK_TURN, _QUICK_POINTS, _QUICK_POOL = 12, 0.5, 1000, 16_000
_CLEARLY_RIGHT, _TURNED = 0.90, 0.15
"""Share of explained points from which a quick answer is taken, and of the normals that may be turned round for it: of
a sheet matched with its far side up to 0.95 is explained, but more of one matched with the right one."""
_ON = 0.008
"""Distance, as a share of the part's size, from which a point may lie on the part with its normal turned round."""
_CERTAIN = 0.95
"""Certainty from which the surroundings of the best pose are not searched once more."""
_ROTATIONS = 500
_LOCAL_ROTATIONS, _LOCAL_TURN = 60, 0.7
"""Turns from the present pose that a fine alignment looks at, and the largest in rad."""
_WIDE, _DEFORMED = 0.12, 0.002
"""Shares of the part's size: within which a point has its face, and that a fifth lie off a part that is deformed."""
_FEWEST = 50
_MAJOR = 0.1
"""Share of the points from which a piece of surface has a sign of its own in the search."""
_POLISH_POINTS, _COUNTED = 2_500, 5_000
"""Points for the pose of a deformed part, and for the fitness."""
_FAILS = 0.775
"""Certainty below which a pose is no answer: the ten scans of other parts in the benchmark reach 0.66; those of the
part itself 0.91 where a quarter is cut off and 5 % of the points are stray, 0.86 where they show an eighth of it."""
_LEAST_COVERAGE = 0.12
_MARGIN = 0.06
"""Poses whose scores differ by less than this share of what is left unexplained fit alike."""
_REACH = 0.02
"""Distance within which a point counts as on the part, as a share of the part's size."""
_SAME_TURN, _SAME_SHIFT = 0.07, 0.03
"""Poses closer than this (rad, share of the part's size) are one."""


@dataclass(frozen=True)
class Verified:
    """A refined pose with what speaks for it and the outward normals it gives the sketch."""

    pose: Array
    evidence: Evidence
    normals: Array
    reason: str = "found"


def align(target: Target, scan: Array, mode: str = "global", scales: Sequence[float] | None = None,
          seed: int = 0) -> Alignment:
    """Rigid pose of a scan on the nominal model.

    Parameters
    ----------
    target : the model, see ``target_of``
    scan : (n, 3) in mm, or in a unit that is to be recognised
    mode : "fine" starts from the present pose and its centroid, "global" from anywhere; "local" looks close around the
        present pose, and of poses that fit alike takes the nearest
    scales : factors to try on the scan's coordinates; by default those that its size allows
    seed : of the random choice of points

    Notes
    -----
    Coarse to fine: hundreds of poses with 120 points each, by Gauss-Newton steps on a look-up table of nearest samples
    that face the same way; the few dozen that are left with more points; the best dozen against the exact faces, each
    verified. The best one is polished on thousands of points.
    """
    scales = plausible_scales(scan, target.size) if scales is None else scales
    answer: Alignment | None = None
    for scale in scales:
        attempt = _align_in_mm(target, scan * scale if scale != 1.0 else scan, mode, scale, np.random.default_rng(seed))
        if answer is None or (attempt.verdict != FAILED) > (answer.verdict != FAILED):
            answer = attempt
        if answer.verdict != FAILED:
            break
    if answer is None:
        return _no_answer(f"the scan measures {np.linalg.norm(np.ptp(scan, axis=0)):.3g} mm and the part "
                          f"{target.size:.3g} mm, which no usual unit explains")
    return answer


def _align_in_mm(target: Target, scan: Array, mode: str, scale: float, generator: np.random.Generator) -> Alignment:
    if mode == "fine":
        quick = _quickly(target, scan, scale, generator)
        if quick is not None:
            return quick
    sketch = sketch_of(scan, generator)
    table = find_table(sketch, target.shadow, generator)
    if table is not None:
        scan = scan[table.heights(scan) > table.tolerance]
        sketch = sketch_of(scan, generator)
    if len(sketch.points) < _FEWEST:
        return _no_answer(f"fewer than {_FEWEST} points of the scan belong together")
    if mode == "local":
        verified = _search(target, sketch, table, _around(target, sketch, np.eye(4)), _LOCAL, generator)
        best = _nearest(verified, sketch.points.mean(axis=0))
    else:
        verified = _search(target, sketch, table, _starts(target, sketch, mode), _THOROUGH, generator)
        best = _best(verified, mode)
        if best.evidence.certainty < _CERTAIN:
            verified += _search(target, sketch, table, _around(target, sketch, best.pose), _LOCAL, generator)
            best = _best(verified, mode)
    pose = _polish(target, sketch, best)
    # the pose has moved little: of two fits of a smooth deformation to the same hypothesis the better one counts
    after = examine(target, sketch, pose, _turn(best, pose), table)
    best = Verified(pose, max(best.evidence, after, key=lambda evidence: evidence.score), _turn(best, pose))
    return _answer(target, sketch, table, best, verified, scale)


def _quickly(target: Target, scan: Array, scale: float, generator: np.random.Generator) -> Alignment | None:
    """The pose of a clean scan of an undeformed part that lies within some 30° of it; None if none is clearly right."""
    sketch = sketch_of(scan, generator, _QUICK_POINTS, _QUICK_POOL, 1)
    if len(sketch.points) < _FEWEST or is_rough(target, sketch):
        return None
    centre = sketch.points.mean(axis=0)
    rotations = _turns_up_to(_QUICK_TURN, _QUICK_ROTATIONS)
    candidates = _propose(target, sketch, motion(rotations, target.centre - rotations @ centre), _QUICK, generator)
    clear: list[Verified] = []
    # a sheet is seen from one side, and only its rims tell which
    for signs in (candidates.signs[0], -candidates.signs[0]):
        pose, normals = _refined(target, sketch, candidates.poses[0], signs)
        normals, turned = _mended(target, sketch, pose, normals, 4.0 * sketch.noise)
        evidence = examine(target.light, sketch, pose, normals, None, rounds=0)
        if evidence.explained > _CLEARLY_RIGHT and evidence.certainty > _FAILS and turned < _TURNED:
            clear.append(Verified(pose, evidence, normals))
    if not clear:
        return None
    best = _best(clear, "fine")
    pose = _polish(target, sketch, best)
    return _answer(target, sketch, None, Verified(pose, best.evidence, _turn(best, pose)), clear, scale)


def _mended(target: Target, sketch: Sketch, pose: Array, normals: Array, near: float) -> tuple[Array, float]:
    """Normals turned round one by one where the point then lies ``near`` (mm) the part, and the share of those."""
    moved = apply(pose, sketch.points)
    off = np.flatnonzero(_heights(target.light, moved, normals) > near)
    turned = np.zeros(len(moved), dtype=bool)
    turned[off] = _heights(target.light, moved[off], -normals[off]) < near
    return np.where(turned[:, None], -normals, normals), float(turned.mean())


def _heights(target: Target, points: Array, normals: Array) -> Array:
    """Distances in mm from the faces that face the same way, infinite where there are none nearby; (n,)."""
    distance, nearest = target.nearest(points, normals, 0.05 * target.size)
    return np.where(np.isfinite(distance), np.abs(target.heights(points, nearest)[0]), np.inf)


def _turn(found: Verified, pose: Array) -> Array:
    """The outward normals in the model's frame after the pose has moved on a little."""
    return found.normals @ found.pose[:3, :3] @ pose[:3, :3].T


def _best(verified: Sequence[Verified], mode: str) -> Verified:
    """The pose that scores best; a fine alignment takes the one that turns least among those that fit alike."""
    alike = _alike(verified)
    if mode != "global":
        nearest = min(float(angle(v.pose, np.eye(4))) for v in alike)
        alike = [v for v in alike if angle(v.pose, np.eye(4)) < nearest + _SAME_TURN]
    return max(alike, key=lambda v: v.evidence.score)


def _alike(verified: Sequence[Verified]) -> list[Verified]:
    """The poses that fit as well as the best one."""
    best = max(v.evidence.score for v in verified)
    return [v for v in verified if v.evidence.score >= best - _MARGIN * (1.0 - best)]


def _nearest(verified: Sequence[Verified], place: Array) -> Verified:
    """Of the poses that fit alike, the one that moves ``place`` least: a start by hand says which side is meant."""
    return min(_alike(verified), key=lambda v: float(shift(v.pose, np.eye(4), place)))


def _starts(target: Target, sketch: Sketch, mode: str) -> Array:
    """Poses to start from, (k, 4, 4)."""
    if mode == "fine":
        rotations = _turns_up_to(_LOCAL_TURN, _LOCAL_ROTATIONS)
        # the last one leaves the part where the scan is now
        goals = np.concatenate([_centres(sketch.points, target.size), target.centre[None]])
        return np.concatenate([motion(rotations, target.centre - rotations @ centre) for centre in goals])
    centres = _centres(sketch.points, target.size)
    rotations = even_rotations(_ROTATIONS)
    return np.concatenate([motion(rotations, target.centre - rotations @ centre) for centre in centres])


def _around(target: Target, sketch: Sketch, pose: Array) -> Array:
    """Poses a little turned and shifted from one that may have settled beside the right one; (k, 4, 4)."""
    place = apply(pose, sketch.points).mean(axis=0)
    rotations = _turns_up_to(_AROUND_TURN, _AROUND_ROTATIONS)
    shifts = _AROUND_SHIFT * target.size * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
    return np.concatenate([motion(rotations, place + shift - rotations @ place) for shift in shifts]) @ pose


def _centres(points: Array, size: float, most: int = 5) -> Array:
    """Where the part may be in the scan: the centroid, or places spread over a scan larger than the part."""
    middle = points.mean(axis=0)
    if np.linalg.norm(np.ptp(points, axis=0)) < 1.4 * size:
        return middle[None]
    centres = [middle]
    distance = np.linalg.norm(points - middle, axis=1)
    while len(centres) < most and distance.max() > 0.3 * size:
        far = points[np.argmax(distance)]
        around = points[np.linalg.norm(points - far, axis=1) < 0.5 * size].mean(axis=0)
        centres.append(around)
        distance = np.minimum(distance, np.minimum(np.linalg.norm(points - around, axis=1),
                                                   np.linalg.norm(points - far, axis=1)))
    return np.array(centres)


def _search(target: Target, sketch: Sketch, table: Plane | None, starts: Array, stages: Sequence[Stage],
            generator: np.random.Generator) -> list[Verified]:
    """The most promising poses, refined and verified."""
    candidates = _propose(target, sketch, starts, stages, generator)
    return [_verify(target, sketch, table, pose, signs)
            for pose, signs in zip(candidates.poses, candidates.signs, strict=True)]


def _propose(target: Target, sketch: Sketch, starts: Array, stages: Sequence[Stage],
             generator: np.random.Generator) -> Candidates:
    """The most promising poses, best first."""
    share = np.bincount(sketch.piece) / len(sketch.piece)
    sided = not is_rough(target, sketch)
    pieces = max(1, int((share[:2] > _MAJOR).sum())) if sided else 1
    field, size = field_of(target), target.size
    candidates = Candidates.all_signs(starts, pieces)
    if not sided:
        candidates = candidates[candidates.signs[:, 0] > 0]
    for stage in stages:
        chosen = generator.choice(len(sketch.points), min(stage.points, len(sketch.points)), replace=False)
        piece = np.where(sketch.piece[chosen] < pieces, sketch.piece[chosen], 0)
        probe = Probe(sketch.points[chosen], sketch.normals[chosen], piece, sided)
        gates = (size * np.geomspace(stage.widest, stage.closest, stage.steps)).tolist()
        candidates = improve(field, probe, candidates, gates)
        score = scores(field, probe, candidates, stage.width * size)
        if stage.turn:
            kept = distinct(candidates, score, field.centre, stage.kept, stage.turn, 0.25 * stage.turn * size)
        else:
            kept = np.argsort(-score)[: stage.kept]
        candidates = candidates[kept]
    return candidates


def _turns_up_to(largest: float, count: int) -> Array:
    """No turn, and turns spread evenly over those of up to ``largest`` rad; (about count, 3, 3)."""
    share = (largest - np.sin(largest)) / np.pi
    turns = Rotation.from_matrix(even_rotations(int(count / share))).as_rotvec()
    near = turns[np.linalg.norm(turns, axis=1) < largest]
    return Rotation.from_rotvec(np.concatenate([np.zeros((1, 3)), near])).as_matrix()


def _verify(target: Target, sketch: Sketch, table: Plane | None, pose: Array, signs: Array) -> Verified:
    """The pose refined against the side of the part that the scan shows, and what speaks for it."""
    pose, normals = _refined(target, sketch, pose, signs)
    if not is_rough(target, sketch):
        mended, turned = _mended(target, sketch, pose, normals, max(_ON * target.size, 4.0 * sketch.noise))
        if 0.0 < turned < _TURNED:
            closer = refine(target.light, sketch.points, pose, (0.04 * target.size,), 8, mended @ pose[:3, :3])
            mended = mended @ pose[:3, :3] @ closer[:3, :3].T
            # of a deformed sheet some points lie nearer to the far side
            if not _is_deformed(target, sketch, closer, mended):
                pose, normals = closer, mended
    return Verified(pose, examine(target.light, sketch, pose, normals, table), normals)


def _refined(target: Target, sketch: Sketch, pose: Array, signs: Array) -> tuple[Array, Array]:
    """The pose after a few steps, and the outward normals of the sketch in the model's frame."""
    light, gate = target.light, 0.08 * target.size
    if is_rough(target, sketch):
        pose = refine(light, sketch.points, pose, (1.5 * gate, gate, 0.5 * gate), 8)
        return pose, facing_normals(light, apply(pose, sketch.points))
    piece = np.where(sketch.piece < len(signs), sketch.piece, 0)
    normals = signs[piece][:, None] * sketch.normals
    pose = refine(light, sketch.points, pose, (gate,), 12, normals)
    return pose, normals @ pose[:3, :3].T


def _polish(target: Target, sketch: Sketch, found: Verified) -> Array:
    """The pose on thousands of points.

    A part that is not deformed lies on its faces, each point on the nearest. Of a deformed one the pose is wanted that
    fits all of it best, not where it deformed least: wide gates, and each point against the side that it shows. Where
    the noise is large the side is a guess, and gross errors reach far: no normals then, and a closer gate.
    """
    if is_rough(target, sketch):
        gate = max(0.02 * target.size, 3.0 * sketch.noise)
        return refine(target, sketch.pool[thin(sketch.pool, _POLISH_POINTS)], found.pose, (2.0 * gate, gate), 15)
    reach = _WIDE * target.size
    if not _is_deformed(target, sketch, found.pose, found.normals):
        return refine(target, sketch.pool, found.pose, (0.02 * target.size,), 6)
    points = sketch.pool[thin(sketch.pool, _POLISH_POINTS)]
    normals = (found.normals @ found.pose[:3, :3])[cKDTree(sketch.points).query(points)[1]]
    pose = refine(target, points, found.pose, (reach,), 8, normals)
    return settle(target, points, pose, normals, reach)


def _is_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array) -> bool:
    """Whether more than a fifth of the points lie off the part, with normals (n, 3) in the model's frame."""
    moved = apply(pose, sketch.points)
    distance, nearest = target.nearest(moved, normals, _WIDE * target.size)
    height = target.heights(moved, nearest)[0][np.isfinite(distance)]
    return not len(height) or bool(np.quantile(np.abs(height), 0.8) >= max(_DEFORMED * target.size, 3.0 * sketch.noise))


def _answer(target: Target, sketch: Sketch, table: Plane | None, best: Verified, verified: Sequence[Verified],
            scale: float) -> Alignment:
    """The verdict: is the best pose good enough, and does another one fit as well?"""
    evidence = best.evidence
    symmetry = symmetry_of(target)
    rivals = _rivals(target, sketch, table, best, verified, symmetry)
    poses = (CandidatePose(best.pose, evidence.score, "found"),
             *(CandidatePose(rival.pose, rival.evidence.score, rival.reason) for rival in rivals))
    moved = apply(best.pose, sketch.pool[:_COUNTED])
    distance, closest = target.tree.query(moved)
    reach = max(_REACH * target.size, 2.5 * sketch.noise)
    near = distance < reach
    height = target.heights(moved[near], closest[near])[0] if near.any() else np.zeros(1)
    reason, verdict = "", OK
    if evidence.certainty < _FAILS or evidence.coverage < _LEAST_COVERAGE:
        verdict, poses = FAILED, poses[:1]
        reason = (f"only {100 * evidence.explained:.0f} % of the scan lies on the part and only "
                  f"{100 * evidence.coverage:.0f} % of the part is covered at the best pose found")
    elif rivals:
        verdict, reason = AMBIGUOUS, symmetry.text() or "the scan fits in several poses alike"
    sure = float(np.clip((evidence.certainty - _FAILS) / (1.0 - _FAILS), 0.0, 1.0))
    confidence = sure / (len(poses) if verdict == AMBIGUOUS else 1)
    return Alignment(best.pose, verdict, confidence, poses, reach, float(near.mean()),
                     float(np.sqrt(np.mean(height**2))), evidence.explained, evidence.coverage, symmetry.text(), scale,
                     unit_name(scale), table is not None, reason)


def _rivals(target: Target, sketch: Sketch, table: Plane | None, best: Verified, verified: Sequence[Verified],
            symmetry: Symmetry) -> list[Verified]:
    """Other poses that fit as well as the best: the part's symmetry, and what else the search found."""
    turned = []
    for pose, exact in zip(symmetry.motions, symmetry.exact, strict=True):
        if exact:
            turned.append(Verified(pose @ best.pose, best.evidence, best.normals, "symmetry of the part"))
    margin = _MARGIN * (1.0 - best.evidence.score)
    place = sketch.points.mean(axis=0)
    rivals: list[Verified] = []
    found = [v for v in verified if v.evidence.score > best.evidence.score - margin]
    for other in [*turned, *sorted(found, key=lambda v: -v.evidence.score)]:
        known = (best, *rivals)
        if _is_new(other.pose, known, place, target.size) and other.reason == "found":
            other = replace(other, pose=_polish(target, sketch, other))
        if _is_new(other.pose, known, place, target.size):
            rivals.append(other)
    return rivals


def _is_new(pose: Array, known: Sequence[Verified], place: Array, size: float) -> bool:
    return all(angle(pose, other.pose) > _SAME_TURN or shift(pose, other.pose, place) > _SAME_SHIFT * size
               for other in known)


def _no_answer(reason: str) -> Alignment:
    return Alignment(np.eye(4), FAILED, 0.0, (), 0.0, 0.0, 0.0, 0.0, 0.0, "", 1.0, "mm", False, reason)
