# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark calibrate``: the threshold that the alignment's verdict rests on, and its error rates.

Right poses and scans of other parts are measured on families that no reported figure uses: the threshold is set on some
of them and judged on the others. Other parts are of other families. Variants, of the same family with other sizes, are
listed separately: one that a smooth deformation turns into the part is not another part to an alignment.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from ..registration.motions import angle, apply, shift
from ..registration.rigid import FAILED, Alignment, RigidSettings, align
from .pages.page import Section, Table, write
from .simulated.loose_scans import CONDITIONS, LoosePart, loose_parts, random_start
from .simulated.other_parts import CALIBRATION, HELD_OUT

Array = np.ndarray
_PARTS = 42
"""Of either kind of families: each with five scans of its own and five of other parts, 210 verdicts of either kind, and
two of variants; a multiple of the families, so that those of all parts are other ones."""
_SEEDS = 11, 12
_RIGHT_TURN, _RIGHT_SHIFT = np.deg2rad(3.0), 0.02
"""A pose is right within this turn and this share of the part's size; what is beyond is another place."""
OWN, OTHER, VARIANT = "the part", "other part", "variant"
_VARIANTS = CONDITIONS[:2]
_REFUSED = 0.01
"""Share of the right poses that may be refused: half of what is asked of other families, which may be harder."""


@dataclass(frozen=True)
class VerdictCase:
    """One verdict.

    Attributes
    ----------
    family, other, condition : of the part, of the part that was scanned, and how
    shows : `OWN`, `OTHER` or `VARIANT`
    right : whether one of the poses found is the right one
    certainty : mean of the score and of what is explained, which the verdict rests on
    refused : with the settings as they are
    """

    family: str
    other: str
    condition: str
    shows: str
    right: bool
    certainty: float
    refused: bool


def run(folder: Path, progress: Callable[[str], None], parts: int = _PARTS) -> str:
    """Measure; writes calibrate.json, .md and .html into the folder and returns the tables as Markdown."""
    folder.mkdir(parents=True, exist_ok=True)
    calibration = verdicts(list(loose_parts(CALIBRATION, parts, _SEEDS[0])), len(CALIBRATION), progress)
    held_out = verdicts(list(loose_parts(HELD_OUT, parts, _SEEDS[1])), len(HELD_OUT), progress)
    least = least_certainty(calibration)
    field = Table("Calibrated field of `VerdictSettings`", ("field", "found", "as it is"), [
        ["least_certainty", f"{least:.2f}", f"{RigidSettings().verdict.least_certainty:.2f}"]])
    rates = Table("Error rates of the verdict as it is", (
        "families", "scans of the part", "refused", "accepted at a wrong pose", "scans of other parts", "accepted",
        "scans of variants", "accepted"), [
        _rates("set on: " + ", ".join(CALIBRATION), calibration),
        _rates("judged on: " + ", ".join(HELD_OUT), held_out)])
    data = {"least_certainty": least, "calibration": [asdict(one) for one in calibration],
            "held_out": [asdict(one) for one in held_out]}
    return write(folder, "calibrate", "Calibration of the alignment",
                 [Section("Calibration of the alignment", tables=[field, rates])], data)


def verdicts(parts: Sequence[LoosePart], families: int, progress: Callable[[str], None]) -> list[VerdictCase]:
    """The verdicts on each part's own scans and on as many of other parts, which follow one another by family."""
    found = []
    for number, part in enumerate(parts):
        for k, condition in enumerate(CONDITIONS):
            progress(f"Aligning: {part.family}, {number + 1} of {len(parts)}, {condition}")
            scanned = {OWN: number, OTHER: number + 1 + k % (families - 1)}
            if condition in _VARIANTS:
                scanned[VARIANT] = number + families * (k + 1)
            found += [_verdict(part, parts[other % len(parts)], condition, shows, [number, k])
                      for shows, other in scanned.items()]
    return found


def _verdict(part: LoosePart, other: LoosePart, condition: str, shows: str, seed: Sequence[int]) -> VerdictCase:
    scan, truth = other.scans[condition]
    moved = random_start(scan, "global", np.random.default_rng(seed))
    found = align(part.target, apply(moved, scan), "global", scales=(1.0,), seed=seed[0])
    return VerdictCase(part.family, other.family, condition, shows,
                       shows == OWN and is_right(found, moved, truth, part), found.certainty,
                       found.verdict == FAILED)


def is_right(found: Alignment, moved: Array, truth: Array, part: LoosePart) -> bool:
    """Whether a pose that was found for a scan moved by (4, 4) leads to the truth (4, 4)."""
    target = part.target
    return any(angle(pose.T_model_scan @ moved, truth) < _RIGHT_TURN
               and shift(pose.T_model_scan @ moved, truth, target.centre) < _RIGHT_SHIFT * target.size
               for pose in found.poses)


def least_certainty(cases: Sequence[VerdictCase]) -> float:
    """The strictest threshold: other parts stay far below, so it is one that nearly all right poses reach."""
    return float(np.quantile([case.certainty for case in cases if case.right], _REFUSED))


def _rates(name: str, cases: Sequence[VerdictCase]) -> list[str]:
    own, others, variants = ([case for case in cases if case.shows == shows] for shows in (OWN, OTHER, VARIANT))
    wrong = sum(not case.refused and not case.right for case in own)
    row = [name, str(len(own)), _share(sum(case.refused for case in own), len(own)), str(wrong)]
    for some in (others, variants):
        row += [str(len(some)), _share(sum(not case.refused for case in some), len(some))]
    return row


def _share(number: int, of: int) -> str:
    return f"{number} ({100 * number / of:.1f} %)"
