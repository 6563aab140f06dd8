# SPDX-License-Identifier: LGPL-2.1-or-later
"""Everything about a part and a scan that stays the same while the joint solve runs."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...errors import RefusedError
from ..arrays import Array, Index
from .data import (EdgeSides, Frames, ScanStatistics, edge_sides, find_lengths, make_frames, scan_statistics,
                   trim_margin)
from .lengths import Lengths
from .linear import Pattern, refuse_too_large
from .priors import (ConstantRows, Couplings, FreeMotions, PriorTrust, Stiffness, constant_rows, contact_rows,
                     find_free_motions, find_pairs, make_couplings, make_stiffness)
from .settings import JointSettings
from .surfaces import (BorderDistance, Jet, JointPart, Lattices, SpanGrid, build_lattices, cell_sides,
                       distance_to_trims, make_span_grid, normals, solid_sizes, span_counts)

_SAMPLE_SIZE = 15000
"""Scan points of the early stages at least; they fill all spans as well (unit: time)."""
_POINTS_PER_CELL = 8.0
"""Points of a cell where the scan is dense (theory: a median of eight is known to 0.44 of the noise)."""
_POINTS_PER_SPAN = 20.0
"""Points of a span at least (theory: sixteen control points act on one)."""
_FEWEST_POINTS = 50
"""Points of a scan at least (unit)."""
_FARTHEST_IN_MARGINS, _FARTHEST_IN_SIDES = 4.0, 1.1
"""Distances from the border are known up to so many margins and sides of cells together (theory: nothing asks for
more; points lie within three quarters of a diagonal from the middle of their cell)."""
_CELLS_PER_SPAN = (3, 10)
"""Cells along a span, at least and at the most (theory: three see what a cubic can follow; unit: memory)."""
_WALL_ISOMETRY = 0.1
"""Isometry of faces that are no skin of a sheet, over the skins' (calibrated: by hand, on the families of ``./ffds
benchmark accuracy``)."""


@dataclass(frozen=True)
class Problem:
    """Constants of one joint solve.

    Attributes
    ----------
    scan, sample : all scan points and a random sample of them, (n, 3) in mm
    sample_normals : (n, 3) those that the scan brings for the sample, zero where it has none; None without any
    statistics : density and noise of the scan
    lattices, cells, stiffness, couplings, pattern : see their modules
    border : how far the cells lie from the border of their face
    area : (spans, k) of the cells in mm²
    constant : rows that are the same at every shape
    sides : where the faces lie at their edges
    lengths : of the solve
    free_motions : of solids within their own surface
    margin : (spans,) distance from the border that the foot points of the scan must keep, in mm; infinite on faces that
        hold none
    body_size : (spans,) size in mm of the solid that a span belongs to
    cell_side : usual length in mm of the sides of the cells
    """

    part: JointPart
    settings: JointSettings
    scan: Array
    sample: Array
    statistics: ScanStatistics
    lattices: Lattices
    cells: SpanGrid
    border: BorderDistance
    area: Array
    stiffness: Stiffness
    couplings: Couplings
    pattern: Pattern
    constant: ConstantRows
    sides: EdgeSides
    margin: Array
    lengths: Lengths
    free_motions: FreeMotions
    body_size: Array
    cell_side: float
    sample_normals: Array | None = None

    def without_points_on(self, faces: Sequence[int]) -> Problem:
        """The same with ``faces`` that hold no scan points: their neighbours carry them along."""
        return replace(self, margin=np.where(np.isin(self.lattices.face_of_span, faces), np.inf, self.margin))

    @property
    def widest_margin(self) -> float:
        """The largest margin of the faces that hold points, in mm."""
        return float(self.margin[np.isfinite(self.margin)].max())

    @property
    def distance(self) -> Array:
        """Distance of the cells from the border of their face in mm, negative outside: (spans, k)."""
        return self.border.distance

    def frames(self, jet: Jet) -> Frames:
        """What matches scan points to the cells of a shape."""
        return make_frames(self.lattices, self.cells, jet, self.margin, self.border)

    @property
    def size(self) -> float:
        """Twice the largest distance of the nominal cells from their middle, in mm."""
        return self.lengths.size

    @property
    def face_of_cell(self) -> Index:
        """Face of every cell by its flat number."""
        return np.repeat(self.lattices.face_of_span, self.cells.inside.shape[1])

    @property
    def sheet_of_span(self) -> Array:
        """Nominal thickness of the sheet whose skin a span belongs to, 0 elsewhere: (spans,) in mm."""
        return self.couplings.pairs.of_face[self.lattices.face_of_span]

    @property
    def skin(self) -> NDArray[np.bool_]:
        """Whether a span belongs to the skin of a sheet."""
        return self.sheet_of_span > 0

    @cached_property
    def skin_of_block(self) -> NDArray[np.bool_]:
        """Whether the rows of the pattern's blocks belong to the skin of a sheet: (size,)."""
        return np.asarray((self.couplings.pairs.of_face > 0)[self.lattices.face_of_control[self.pattern.rows]])

    def isometry_weights(self, trust: PriorTrust) -> tuple[float, float]:
        """Weight of the strain of skins and of walls, which may stretch more, per area over the size squared."""
        settings = self.settings
        weight = trust.isometry / (settings.strain * settings.strain_length) ** 2
        return weight, min(_WALL_ISOMETRY * weight, 1 / (settings.strain_walls * settings.strain_length) ** 2)


def make_problem(part: JointPart, scan: Array, settings: JointSettings, finer: dict[int, int],
                 scan_normals: Array | None = None) -> Problem:
    """Lattices, rasters and constant rows of a part for a scan; ``finer`` divides the spans of some faces.

    Raises
    ------
    RefusedError : the scan has too few points, every face is frozen, or there is not enough memory.
    """
    if len(part.frozen) == len(part.faces):
        raise RefusedError("Every face is frozen: leave at least one face free to move.")
    if len(scan) < _FEWEST_POINTS:
        raise RefusedError(f"The scan has only {len(scan)} points: at least {_FEWEST_POINTS} are needed.")
    statistics = scan_statistics(scan)
    least = float(np.sqrt(_POINTS_PER_SPAN / statistics.density))
    sizes = solid_sizes(part.faces, part.solids)
    counts = span_counts(part.faces, sizes, settings.spans, settings.turning, least, finer)
    lattices = build_lattices(part.faces, counts)
    body_size = sizes[lattices.face_of_span]
    refuse_too_large(lattices.count, len(lattices.face_of_span) * _CELLS_PER_SPAN[0] ** 2, len(scan))
    pick = sample_of(scan, len(lattices.face_of_span), settings.seed)
    sample = scan[pick]
    stiffness = make_stiffness(part.faces, lattices, body_size)
    per_span = _cells_per_span(stiffness.area.sum(axis=1), statistics)
    refuse_too_large(lattices.count, len(lattices.face_of_span) * per_span**2, len(scan))
    cells = make_span_grid(part.faces, lattices, (np.arange(per_span) + 0.5) / per_span)
    pairs = find_pairs(part.faces, part.solids, lattices, cells, stiffness.places, stiffness.area, stiffness.curvature,
                       sizes, settings.thickness_change)
    lengths = find_lengths(lattices, cells, sample, statistics)
    statistics = replace(statistics, noise=lengths.noise)
    side = cell_sides(lattices, cells)
    border = distance_to_trims(part.faces, lattices, cells, side,
                               _FARTHEST_IN_MARGINS * lengths.border_margin + _FARTHEST_IN_SIDES * side)
    couplings = make_couplings(part, lattices, pairs, contact_rows(part, lattices, cells, sizes), settings, lengths,
                               len(scan) / lengths.start**2)
    others = couplings.matrices()
    pattern = Pattern(lattices, [couplings.scalar, *others.graphs], _positions(lattices, cells))
    area = normals(cells.nominal, cells.outward)[1] * lattices.step.prod(axis=1)[:, None] / per_span**2
    area = np.where(cells.inside, area, 0.0)
    margin = trim_margin(lattices, border.distance, lengths.border_margin)
    sides = edge_sides(couplings.edges, cells, lattices.face_of_span, border.distance > margin[:, None])
    return Problem(part, settings, scan, sample, statistics, lattices, cells, border, area, stiffness, couplings,
                   pattern, constant_rows(pattern, stiffness, couplings.scalar, others), sides, margin, lengths,
                   find_free_motions(part, lattices, cells, area, couplings.scalar), body_size,
                   float(np.median(side[lattices.face_of_span])),
                   None if scan_normals is None else scan_normals[pick])


def sample_of(scan: Array, spans: int, seed: int) -> Index:
    """Numbers of points of a scan at random, enough for a stiff shape of any size and for soft lattices.

    Parameters
    ----------
    scan : (n, 3) in mm
    spans : of all lattices
    seed : of the choice
    """
    enough = max(_SAMPLE_SIZE, int(_POINTS_PER_SPAN * spans))
    return np.random.default_rng(seed).permutation(len(scan))[:enough]


def _cells_per_span(area: Array, statistics: ScanStatistics) -> int:
    """Cells along a span of the size, by area (spans,) in mm², in which most of the surface lies."""
    points = statistics.density * np.average(area, weights=area)
    return int(np.clip(np.sqrt(points / _POINTS_PER_CELL), *_CELLS_PER_SPAN))


def _positions(lattices: Lattices, cells: SpanGrid) -> Array:
    """Roughly where every control point lies: the mean of the spans it acts on, (controls, 3) in mm."""
    middle = np.repeat(cells.nominal.position.mean(axis=1), 16, axis=0)
    controls = lattices.controls.ravel()
    total = np.stack([np.bincount(controls, weights=middle[:, k], minlength=lattices.count) for k in range(3)], axis=1)
    return total / np.bincount(controls, minlength=lattices.count)[:, None]
