# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of the paper: many poses proposed, the best ones refined, each weighed against the model, one kept."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..scan_points import sketch_of, table_of_sketch
from .alignment_result import FAILED, Alignment
from .evidence import UnalignedScan, match_scan, weigh_match
from .hypothesis import Hypothesis, choose, clearly_right, is_good, matched_on, promising, refined
from .model import Target
from .polish import polish
from .scan_unit import plausible_scales
from .search import propose, starts_of
from .settings import Effort
from .verdict import Answer, alignment_of, failed_alignment


def align(target: Target, scan: Array, mode: str = "global", scales: Sequence[float] | None = None,
          seed: int = 0) -> Alignment:
    """Rigid pose of a scan on the nominal model.

    Parameters
    ----------
    target : the model, see ``target_of``, and with it the settings
    scan : (n, 3) in mm, or in another unit, which is recognised
    mode : "fine" starts from the present pose and its centroid, "global" from anywhere; "local" searches close to the
        present pose, and takes the nearest of poses that fit equally well
    scales : factors to try on the scan's coordinates; by default those that its size allows
    seed : of the random choice of points

    Notes
    -----
    Coarse to fine: hundreds of poses with 120 points each, by Gauss-Newton steps on a look-up table of nearest samples
    that face the same way; the few dozen that remain with more points; the best dozen against the exact faces, each
    verified. The best one is polished on thousands of points. For a scan that lies nearby a quick search is tried
    first.
    """
    scales = plausible_scales(scan, target.size, target.settings.units) if scales is None else scales
    answer: Alignment | None = None
    for scale in scales:
        generator = np.random.default_rng(seed)
        tries = (_align(target, scan * scale if scale != 1.0 else scan, effort, scale, generator)
                 for effort in target.settings.efforts(mode))
        attempt = next(found for found in tries if found is not None)
        if answer is None or (attempt.verdict != FAILED) > (answer.verdict != FAILED):
            answer = attempt
        if answer.verdict != FAILED:
            break
    if answer is None:
        return failed_alignment(f"the scan measures {np.linalg.norm(np.ptp(scan, axis=0)):.3g} mm and the part "
                                f"{target.size:.3g} mm, which no usual unit explains")
    return answer


def _align(target: Target, points: Array, effort: Effort, scale: float,
           generator: np.random.Generator) -> Alignment | None:
    """The alignment of points (n, 3) in mm with some effort; None where the answer has to be clear and is not."""
    settings = target.settings.verdict
    whole = _look_at(target, points, effort, generator)                    # even points with normals, without a table
    scan = whole.every(effort.stride)
    if len(scan.sketch.points) < settings.least_points or (effort.clear and scan.hides_sides):
        return None if effort.clear else failed_alignment(
            f"fewer than {settings.least_points} points of the scan belong together")
    hypotheses = _search(scan, starts_of(scan, effort.starts), effort, generator)  # Gauss-Newton from many starts
    if not hypotheses:
        return None
    best = choose(hypotheses, effort.prefers)
    if effort.look_around and best.evidence.certainty < settings.sure_certainty:
        around = starts_of(scan, "around", best.pose)                      # it may have settled beside the right one
        hypotheses += _search(scan, around, target.settings.around, generator)
        best = choose(hypotheses, effort.prefers)
    answer = _polished(whole, scan, best)                                  # Kabsch over the whole part, deformed or not
    if effort.clear and not is_good(answer.evidence, target):
        return None
    return alignment_of(scan, answer, hypotheses, scale)                   # good enough, and the only one?


def _look_at(target: Target, points: Array, effort: Effort, generator: np.random.Generator) -> UnalignedScan:
    """Even points of the scan, those of a table left out."""
    sketch = sketch_of(points, generator, effort.points, effort.pool, effort.finer)
    extent = np.linalg.norm(sketch.points - sketch.points.mean(axis=0), axis=1).max()
    # a point too far from the centroid cannot lie on the part
    table = None
    if extent > effort.table_from * target.size:
        table = table_of_sketch(sketch, target.largest_projection, generator)
    if table is not None:
        points = points[table.in_front(points)]
        sketch = sketch_of(points, generator, effort.points, effort.pool, effort.finer)
    return UnalignedScan(target, sketch, table)


def _search(scan: UnalignedScan, starts: Array, effort: Effort, generator: np.random.Generator) -> list[Hypothesis]:
    """The most promising poses, refined and weighed, rung by rung on more points and with more deformation; none where
    the answer has to be clear and is not."""
    found = propose(scan, starts, effort.stages, generator)
    # a sheet is seen from one side, and only its rims tell which
    sides = (1.0, -1.0) if effort.both_sides else (1.0,)
    tried = [(pose, side * signs) for pose, signs in zip(found.poses, found.signs, strict=True) for side in sides]
    hypotheses: list[Hypothesis] = []
    for rung in effort.rungs:
        hypotheses = ([refined(scan, pose, signs, rung, effort) for pose, signs in tried] if rung.afresh else
                      [matched_on(one, rung) for one in hypotheses])
        if not effort.clear:
            hypotheses = promising(hypotheses)
            tried = [(one.pose, one.signs) for one in hypotheses]
        elif clear := clearly_right(hypotheses, bool(rung.rounds)):
            return clear
    return [] if effort.clear else hypotheses


def _polished(whole: UnalignedScan, scan: UnalignedScan, best: Hypothesis) -> Answer:
    """The best pose on all points of the ``whole`` scan, weighed on those of ``scan``: of the fits with the deformation
    and without one the better counts."""
    pose, deformation = polish(whole.target, whole.sketch, best.pose, best.normals_of(whole.sketch, best.pose),
                               best.deformation)
    normals = best.normals_of(scan.sketch, pose)
    if deformation is None and best.deformation.is_none:                   # and so it was weighed before
        return Answer(pose, best.evidence, normals)
    weighed = [weigh_match(scan, pose, normals, match_scan(scan, pose, normals, (), start)[0])
               for start in ((None,) if deformation is None else (None, deformation))]
    return Answer(pose, max([best.evidence, *weighed], key=lambda evidence: evidence.score), normals)
