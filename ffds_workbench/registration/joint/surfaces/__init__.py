# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deformed surfaces of all faces: `lattices` (control points, numbered together), `cells` (the raster over them),
`places` (scattered places on faces) and `close_seams` (lattices made exact where a surface meets itself).
"""
from .cells import Jet, Places, by_face, distance_to_trims, make_places, normals
from .close_seams import exact_ends
from .lattices import FaceLattice, Lattices, build_lattices, cubic
from .places import Samples, concatenate, sample

__all__ = ["FaceLattice", "Jet", "Lattices", "Places", "Samples", "build_lattices", "by_face", "concatenate", "cubic",
           "distance_to_trims", "exact_ends", "make_places", "normals", "sample"]
