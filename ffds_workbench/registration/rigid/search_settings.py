# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far and how long an alignment searches: the quick and the thorough ways of one algorithm, as settings.

The three words are those of `settings`.
"""
from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class SearchStage:
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


Rounds = tuple[tuple[float, int], ...]
"""Rounds of a fit of a smooth deformation: gates in sizes, and degrees of its polynomials."""
_GATES = (0.1, 0.05, 0.025, 0.0125, 0.006, 0.003)  # sizes; theory: halved, from the largest deformation and more on
LARGEST_DEGREE = 4                                 # theory: bend, twist and what varies along them
STIFF: Rounds = tuple((gate, 2) for gate in _GATES)                        # distinguish the part from another one
SOFT: Rounds = STIFF[:2] + tuple((gate, LARGEST_DEGREE) for gate in _GATES[2:])    # follow a deformed part


@dataclass(frozen=True)
class Rung:
    """One round in which the hypotheses that are left are weighed anew.

    Attributes
    ----------
    stride : of the sketch's points, one of so many is looked at
    rounds : of the smooth deformation
    afresh : the pose is refined and the deformation begins at none; else it goes on from the rung before
    """

    stride: int
    rounds: Rounds
    afresh: bool = True


@dataclass(frozen=True)
class Effort:
    """A way to search, quick or thorough.

    Attributes
    ----------
    points, pool, finer : of the sketch, see ``sketch_of``
    stride : of the sketch's points, all but the last refinement look at one of so many
    table_from : in sizes; a table is looked for where a scan reaches farther from its centroid
    starts : "anywhere", "nearby" or "around" the present pose
    stages : of the search
    both_sides : every pose is tried with either side of the scan's surface
    refine_steps, refine_stride : steps of the refinement of each hypothesis, and stride of its points
    settle_steps : of a second refinement after stray normals were flipped
    rungs : taken in turn; where the answer has to be clear, until it is
    clear : whether the answer has to be clear; otherwise any goes to the verdict
    prefers : of poses that fit equally well, the one with the best "score", the least "turn", or the "nearest"
    look_around : the surroundings of a best pose that is not sure are searched as well
    """

    points: int
    pool: int
    finer: int
    stride: int
    table_from: float
    starts: str
    stages: tuple[SearchStage, ...]
    both_sides: bool
    refine_steps: int
    refine_stride: int
    settle_steps: int
    rungs: tuple[Rung, ...]
    clear: bool
    prefers: str
    look_around: bool


# Theory: a share of n points is known to 0.5/√n, a pose to σ/√n, which gives the numbers of points; gates end at what
# the next stage can tell. Unit: gates begin at what the starts leave. Calibrated: by hand, on the scans of
# ``./ffds benchmark alignment``: how many poses are kept from stage to stage.
QUICK = Effort(
    points=1_500, pool=24_000, finer=1, stride=3, table_from=0.75, starts="close",
    stages=(SearchStage(90, 0.30, 0.07, 7, 0.04, 6, 0.1), SearchStage(250, 0.07, 0.02, 5, 0.015, 1, 0.05)),
    both_sides=True, refine_steps=5, refine_stride=2, settle_steps=0,
    rungs=(Rung(1, ()), Rung(1, STIFF[:2], afresh=False), Rung(1, SOFT[2:4], afresh=False)), clear=True,
    prefers="turn", look_around=False)
# Theory, unit, calibrated: as above.
NEARBY = Effort(
    points=2_000, pool=40_000, finer=4, stride=1, table_from=0.0, starts="nearby",
    stages=(SearchStage(120, 0.30, 0.10, 6, 0.05, 240, 0.0), SearchStage(250, 0.10, 0.05, 6, 0.04, 40, 0.12),
            SearchStage(600, 0.05, 0.03, 8, 0.03, 12, 0.05)),
    both_sides=False, refine_steps=12, refine_stride=1, settle_steps=8, rungs=(Rung(4, STIFF), Rung(1, SOFT)),
    clear=False, prefers="turn", look_around=True)
ANYWHERE = replace(NEARBY, starts="anywhere", prefers="score")
# Theory, unit, calibrated: as above.
AROUND = replace(NEARBY, starts="around", prefers="nearest", look_around=False,
                 stages=(SearchStage(150, 0.08, 0.05, 6, 0.04, 30, 0.08),
                         SearchStage(600, 0.05, 0.03, 8, 0.03, 5, 0.04)))


@dataclass(frozen=True)
class SearchSettings:
    """Where the search starts, and its steps."""

    close_turns: int = 12                # theory: the steps converge from 0.3 rad, and 12 are so far apart
    close_turn: float = 0.5              # rad; unit: a scan that was laid on by eye is turned by less than 30°
    nearby_turns: int = 60               # theory: 0.3 rad apart
    nearby_turn: float = 0.7             # rad; unit: 40°, for a margin
    anywhere_turns: int = 500            # theory: 0.3 rad apart over all rotations
    around_turns: int = 16               # theory: 0.2 rad apart
    around_turn: float = 0.35            # rad; unit: what a deformation turns a pose by, several times over
    around_shift: float = 0.08           # sizes; unit: the same of shifts
    centres: int = 5                     # unit: no scan shows much more than five times the part
    one_centre: float = 1.4              # sizes of a scan up to which the part is in its middle; unit
    other_centre: float = 0.3            # sizes that another centre is off the known ones; theory: the gate's reach
    centre_reach: float = 0.5            # sizes; theory: half a part around its centre
    major_piece: float = 0.1             # of the points; theory: less does not change the order
    voxels: int = 40                     # of the look-up along the part; theory: off by a fortieth, below any gate
    margin: float = 0.2                  # sizes around the part that it covers; unit: beyond, the border counts
    same_side_cosine: float = 0.35       # of a sample and an axis; theory: 1/√3 and the normals' noise
    side_floor: float = 0.02             # weight of points whose normal disagrees; theory: Tikhonov, a step in any case
    pull: float = 0.1                    # towards the sample itself; unit: outlines guide where planes slide
    damping: float = 1e-3                # theory: Levenberg; a thousandth of the points' weight
    longest_turn: float = 0.5            # rad per step; theory: linear up to there
    blind_agreement: float = 0.6         # of normals that are guesses; theory: mean of |cos| is a half, and a little
