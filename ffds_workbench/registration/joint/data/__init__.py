# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scan says: `scan_statistics` (density, noise), `correspondence` (which point belongs to which raster cell),
`cell_heights` (one robust height per cell), `scatter` (how noise and the model's own errors scatter them), `misfit`
(the lattices' errors that are left), `borders` (where the scan ends at an edge) and `scan_lengths` (its noise, spacing
and reach).
"""
from .borders import Borders, EdgeSides, NearEdges, edge_sides, find_borders, find_near_edges
from .cell_heights import CellHeights, median_heights, no_heights, tukey_mean_heights
from .correspondence import Correspondence, Frames, correspond, make_frames, trim_margin
from .misfit import misfit, nearest_spans
from .scan_lengths import find_lengths
from .scan_statistics import ScanStatistics, scan_statistics
from .scatter import Scatter, patch_sums

__all__ = ["Borders", "CellHeights", "Correspondence", "EdgeSides", "Frames", "NearEdges", "ScanStatistics", "Scatter",
           "correspond", "edge_sides", "find_borders", "find_lengths", "find_near_edges", "make_frames",
           "median_heights", "misfit", "nearest_spans", "no_heights", "patch_sums", "scan_statistics", "trim_margin",
           "tukey_mean_heights"]
