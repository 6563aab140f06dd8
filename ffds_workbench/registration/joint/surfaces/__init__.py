# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deformed surfaces of all faces: `lattices` (control points, numbered together), `cells` (the raster over them),
`places` (scattered places on faces) and `close_seams` (lattices made exact where a surface meets itself).
"""
from .cells import Jet, SpanGrid, by_face, distance_to_trims, make_span_grid, normals
from .close_seams import close_seams
from .lattices import FaceLattice, Lattices, build_lattices, cubic
from .places import FacePlaces, concatenate, places_on_faces

__all__ = ["FaceLattice", "FacePlaces", "Jet", "Lattices", "SpanGrid", "build_lattices", "by_face", "close_seams",
           "concatenate", "cubic", "distance_to_trims", "make_span_grid", "normals", "places_on_faces"]
