# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the alignment. Each says its unit, and in one word where it comes from.

*theory*: it follows from a source or from arithmetic, such as how exact a discrete thing has to be for its use, or how
many points bring noise down to what is asked (standard deviation σ/√n). *unit*: an assumption on the physical world, on
how parts deform and what scanners see, or on what time and memory are worth. *calibrated*: the command ``./ffds
benchmark calibrate`` finds it, from right poses and from scans of other parts, on the families `CALIBRATION` of
``benchmark/simulated/other_parts.py``, which no reported figure uses; calibrated *by hand*: it was picked by looking at
the parts of ``./ffds benchmark alignment``. Several of the others were first picked in that way too: their word
explains them, but did not set them. "Size" is the diagonal of the part's box, σ the noise of the scan: nothing here has
a fixed length, so that a part of 10 mm and one of 3 m are aligned alike.
"""
from __future__ import annotations

from dataclasses import dataclass, field

from .search_settings import ANYWHERE, AROUND, LARGEST_DEGREE, NEARBY, QUICK, STIFF, Effort, Rounds, SearchSettings

__all__ = ["LARGEST_DEGREE", "Effort", "RigidSettings", "Rounds"]


@dataclass(frozen=True)
class SampleSettings:
    """How the part's faces are sampled and what a camera sees of them."""

    samples: int = 24_000                # theory: heights over them are off by spacing³/R², 1e-5 sizes on round faces
    even_samples: int = 2_500            # theory: a share of them is known to 1 %, 0.5/√n
    views: int = 64                      # theory: directions 0.44 rad apart, √(4π/n); what is seen changes slower
    area_cells: int = 40                 # cells per direction; theory: the area density is linear within one
    largest_turn: float = 0.35           # rad from sample to sample; theory: cubic terms below 1 % of the height
    grazing_cosine: float = 0.15         # unit: 81°, beyond which cameras see no surface
    face_on_cosine: float = 0.6          # theory: the depth buffer's slack at steeper views exceeds two pixels
    turn_length: float = 0.04            # sizes that a turn by 1 rad counts as; unit: sheets are thinner
    facing_cosine: float = 0.3           # theory: noisy normals are off by up to 50°, those behind by 130°


@dataclass(frozen=True)
class RimSettings:
    """Where faces end, and where a scan ends along them. Steps are the distance of neighbouring points on a rim."""

    points_per_loop: int = 1_500         # theory: beyond, a rim has more points than a scan
    voxels: int = 80                     # along the part; theory: the nearest rim is known to a voxel's diagonal, 2 %
    near: float = 0.08                   # lengths of the part; unit: no deformation carries an end farther
    ahead: float = 1.2                   # sample spacings; theory: where the surface goes on, a sample is within 1.5
    smooth_cosine: float = 0.8           # unit: 37°; faces that turn less across an edge look like one
    sheet_neighbours: int = 64           # theory: points of both sides of a sheet within 16 steps
    opposite_cosine: float = 0.7         # unit: 45° between the sides of a sheet
    stretch_points: int = 8              # theory: 4 spacings of samples, within which an edge is straight
    band: tuple[float, float] = (1.0, 5.0)  # steps inside the outermost point; theory: where no end thins the points
    least_band_points: int = 5           # theory: the density is known to 45 %, 1/√n
    largest_rank: int = 4                # theory: the k-th random point lies k/density inside the end, ±√k/density
    wall_steps: float = 2.0              # steps; unit: a wall beside an edge is at least as high
    wall_noise: float = 0.4              # σ along the rim, whose face points may be a wall's; unit: mixed pixels
    telling: int = 3                     # of 5 stretches that have to tell; theory: a majority
    odd_sigmas: float = 2.0              # theory: 5 % of a normal distribution lie farther from their median
    uncertainty: float = 0.4             # σ that an end is uncertain by in a dense scan; unit: mixed pixels, edge radii
    usual_loss: float = 2.3              # σ that sensors lose at an edge; unit: a stereo camera's window


@dataclass(frozen=True)
class RefineSettings:
    """Iterative closest points."""

    scale_quantile: float = 0.85         # unit: at most 15 % of the scan are something else
    cutoff: float = 4.0                  # of that quantile; theory: 5.8 σ of normal noise, which then counts in full
    settled: float = 3e-5                # sizes; theory: a tenth of the bias that is asked, .02 mm on 100 mm
    matches_last: float = 0.25           # sample spacings; theory: heights are of second order about a sample


@dataclass(frozen=True)
class DeformationSettings:
    """The smooth deformation that a part may show."""

    correlation: float = 0.6             # half sizes ℓ; unit: sheets bend over their length, not within a hand's width
    amplitude: float = 0.01              # sizes s; unit: welding distorts by a hundredth of a part
    negligible: float = 0.02             # of s; theory: less than noise for s up to 50 σ
    strain_points: int = 75              # theory: three for each of 35 monomials and more
    strain_cost: float = 0.0045          # sizes of height for a strain of 1; unit: metal yields by 0.2 %, 1e-5 sizes
    strain_bounds: tuple[float, float] = (0.0009, 0.045)  # the same where the surface visibly stretches; unit
    strain_heights: float = 150.0        # theory: then all strain costs as much as so many heights of σ
    box_margin: float = 0.1              # half sizes; theory: polynomials grow by (1 + margin)^4 beyond the part
    least_spread: float = 1e-6           # sizes; theory: a scan without noise has none to divide by
    least_points: int = 60               # theory: twice the 35 monomials, nearly
    reach: float = 0.06                  # sizes; unit: no part is bent farther and still used
    cells: int = 600                     # theory: a mean over pieces is exact for what is linear within one
    looks: tuple[tuple[int, tuple[tuple[int, float, float], ...]], ...] = (
        (2, ((2, 0.025, 0.04), (2, 0.006, 0.025))), (4, ((1, 0.025, 0.04), (1, 0.003, 0.01))))
    # degree, and rounds of: stride of points; cut-off of heights and reach of ends in sizes; theory: coarse to fine
    on_face_sigmas: float = 3.0          # theory: 99.7 % of a normal distribution
    first_on_face: float = 0.01          # sizes, the same in the first round; unit: what a bend leaves undone
    end_weight: float = 4.0              # against heights; unit: these carry what polynomials cannot follow, 2 σ


@dataclass(frozen=True)
class PolishSettings:
    """The last refinement of a pose."""

    gate: float = 0.12                   # sizes; unit: twice the largest deformation
    first_rounds: Rounds = STIFF         # of a deformation that is not known yet
    rigid_gate: float = 0.02             # sizes; theory: what the refinement before leaves, ten times over
    deformed_height: float = 0.002       # sizes that a fifth of the points exceed where a part is deformed; unit
    far_turn: float = 0.07               # rad; theory: the first matches were then off by a face's width
    first_points: int = 500              # theory: σ/√n is a twentieth of the noise
    rough_points: int = 2_500            # of a scan with large noise; theory: σ/√n is a fiftieth of it
    height_points: int = 3_500           # theory: σ/√n below .02 mm for σ up to 1 mm
    end_points: int = 60_000             # theory: five for each step of the rims
    deformed_points: int = 1_000         # theory: some thirty for each monomial
    end_reaches: tuple[float, float] = (0.01, 0.005)  # sizes; theory: what the heights leave in their own plane
    end_weight: float = 0.25             # of an end against a point of equal σ; unit: walls at a slant lie outside
    free_lever: float = 1e-4             # half sizes squared; theory: numerical rank of a free direction
    patch_samples: int = 60              # of the even samples; theory: a sixth of the part, far more than the noise
    on_face_sigmas: float = 3.0          # theory: 99.7 % of a normal distribution
    least_noise: float = 5e-4            # sizes; unit: sampling and rims are no better
    candidate_samples: int = 3           # theory: faces that meet in a corner
    steps: int = 4                       # theory: Gauss–Newton doubles its digits
    settled: float = 1e-5                # sizes; theory: as in the refinement, thrice better


@dataclass(frozen=True)
class EvidenceSettings:
    """What speaks for a pose, and how much it counts in the score."""

    cap: float = 0.008                   # sizes beyond which a point is unexplained; unit: half a sheet
    cap_sigmas: float = 4.0              # the same in σ; theory: a normal distribution ends there
    agreeing_cosine: float = 0.6         # unit: 53°, what noise does to normals
    seen_cosine: float = 0.5             # of a sample and of the points around it; unit: 60°, what noise does
    hiding_noise: float = 0.003          # sizes; unit: more noise than this hides which side of a sheet is seen
    cameras: int = 3                     # unit: scans are put together from few shots
    least_gain: float = 0.02             # of the surface that a camera has to show; theory: half of 64 views' steps
    neighbours: int = 4                  # theory: the nearest may lie on the far side of a sheet
    reach_spacings: float = 3.0          # of the scan; theory: no random gap is wider
    reach: float = 0.025                 # sizes; unit: holes that reflections leave
    rim_spacings: float = 1.5            # of the samples; theory: half a cell's diagonal, twice
    below_table: float = 0.04            # sizes; unit: a bent part may lean through the table's plane
    missing_weight: float = 0.5          # unit: clamps and reflections hide up to a fifth of what ought to be seen
    pierced_weight: float = 2.0          # unit: nothing lies behind a table
    bent_weight: float = 6.0             # per size; unit: bending another part into this one by 4 % costs 0.24


@dataclass(frozen=True)
class VerdictSettings:
    """When poses are one, when they fit alike, and when one is good enough."""

    least_certainty: float = 0.80        # calibrated
    least_coverage: float = 0.12         # unit: a scan of an eighth of a part is a scan of that part
    sure_certainty: float = 0.95         # theory: less than what 20 % of stray points take away
    least_points: int = 50               # theory: eight for each degree of freedom
    score_margin: float = 0.06           # of what the better leaves unexplained; theory: 2 σ of a share of 2,000 points
    same_turn: float = 0.07              # rad; theory: what the refinement converges from to one pose
    same_shift: float = 0.03             # sizes; theory: the same
    settled_turn: float = 0.01           # rad; theory: what refinements on a quarter of the points differ by
    settled_shift: float = 0.005         # sizes; theory: the same
    nearer: float = 0.005                # sizes; unit: less than the thickness of a sheet
    promising: float = 0.1               # of the score; theory: 5 σ of a share of 500 points
    near: float = 0.008                  # sizes within which a normal may be flipped; unit: half a sheet
    clear_explained: float = 0.90        # of the scan, for a quick answer; calibrated: by hand, see the module
    clear_misfit: float = 0.65           # of the other side's, for a quick answer; calibrated: by hand, see the module
    near_sigmas: float = 4.0             # the same in σ; theory: a normal distribution ends there
    flip_reach: float = 0.05             # sizes; unit: the largest deformation
    stray_normals: float = 0.15          # unit: the largest share of normals that have gone astray one by one
    fitness_points: int = 1_000          # theory: the share is known to 1.5 %
    fitness_reach: float = 0.02          # sizes; unit: parts that still do their work
    fitness_sigmas: float = 2.5          # theory: 99 % of a normal distribution


@dataclass(frozen=True)
class SymmetrySettings:
    """Motions that map the part onto itself."""

    moments: float = 0.04                # of the largest; theory: what 24,000 samples leave, ten times over
    angles: int = 72                     # theory: 5°, within which refinement converges
    points: int = 1_200                  # theory: 12 beyond the quantile of 99 %
    half_turn: float = 0.01              # rad; theory: what the refinement leaves
    nearly: float = 0.02                 # sizes; unit: a scan of a deformed part fits as well
    exactly: float = 0.004               # sizes; unit: below a sheet's thickness


@dataclass(frozen=True)
class UnitSettings:
    """Sizes of a scan against the part's, which tell its unit."""

    trusted: tuple[float, float] = (0.3, 4.0)    # the unit given is tried first; unit: partial views, clutter
    possible: tuple[float, float] = (0.12, 10.0)  # theory: the next unit, by 10, fits better beyond
    tried: int = 3                       # theory: units between those bounds


@dataclass(frozen=True)
class RigidSettings:
    """How an alignment is to work; see the module for the three words.

    Attributes
    ----------
    quick, nearby, anywhere, around : efforts. Mode "fine" tries ``quick`` first, then ``nearby``; "global" searches
        ``anywhere``; "local" looks ``around`` the present pose, as every mode does where the best pose is not sure
    samples, rims, search, refine, deformation, polish, evidence, verdict, symmetry, units : what those rooms need
    """

    quick: Effort = QUICK
    nearby: Effort = NEARBY
    anywhere: Effort = ANYWHERE
    around: Effort = AROUND
    samples: SampleSettings = field(default_factory=SampleSettings)
    rims: RimSettings = field(default_factory=RimSettings)
    search: SearchSettings = field(default_factory=SearchSettings)
    refine: RefineSettings = field(default_factory=RefineSettings)
    deformation: DeformationSettings = field(default_factory=DeformationSettings)
    polish: PolishSettings = field(default_factory=PolishSettings)
    evidence: EvidenceSettings = field(default_factory=EvidenceSettings)
    verdict: VerdictSettings = field(default_factory=VerdictSettings)
    symmetry: SymmetrySettings = field(default_factory=SymmetrySettings)
    units: UnitSettings = field(default_factory=UnitSettings)

    def efforts(self, mode: str) -> tuple[Effort, ...]:
        """What a ``mode`` tries, in this order."""
        return {"fine": (self.quick, self.nearby), "local": (self.around,)}.get(mode, (self.anywhere,))
