# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part and its deformed surfaces: `part` (faces, edges, solids), `lattices` (control points, numbered together),
`span_counts` (how many of them), `cells` (the raster over them), `border_distance` (theirs), `places` (scattered
places on faces) and `seam_closing` (lattices made exact where a surface meets itself).
"""
from .border_distance import BorderDistance, distance_to_trims
from .cells import Jet, SpanGrid, by_face, cell_sides, covered_shares, make_span_grid, normals
from .lattices import FaceLattice, Lattices, build_lattices
from .part import JointPart, SharedEdge
from .places import FacePlaces, concatenate, places_on_faces
from .seam_closing import close_seams
from .span_counts import solid_sizes, span_counts

__all__ = ["BorderDistance", "FaceLattice", "FacePlaces", "Jet", "JointPart", "Lattices", "SharedEdge", "SpanGrid",
           "build_lattices", "by_face", "cell_sides", "close_seams", "concatenate", "covered_shares",
           "distance_to_trims", "make_span_grid", "normals", "places_on_faces", "solid_sizes", "span_counts"]
