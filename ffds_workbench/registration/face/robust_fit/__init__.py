# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of the method `robust`, in the order in which it takes them.

`face_points` (the scan over a face) → `layers` (the sheets that the scan forms over it, and the stiff start) →
`patches` (which of them belong to the face) → `lattice_size` (how fine a lattice the scan determines) → `raster_fit`
(residuals on the raster and the lattice that they ask for), on `bending` (the energy) and `normal_equations` (banded).
"""
from .face_points import FacePoints, face_points
from .lattice_size import automatic_lattice, coarse_lattice
from .layers import dense_layers, rigid_start
from .patches import main_patches, patches, proven
from .raster_fit import RasterFit
from .robust_settings import RobustSettings

__all__ = ["FacePoints", "RasterFit", "RobustSettings", "automatic_lattice", "coarse_lattice", "dense_layers",
           "face_points", "main_patches", "patches", "proven", "rigid_start"]
