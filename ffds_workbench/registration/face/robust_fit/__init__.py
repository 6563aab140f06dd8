# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of the method `robust`, in the order in which it takes them.

`face_points` (the scan over a face) → `layers` (the sheets that the scan forms over it, and the stiff start) →
`patches` (which of them belong to the face) → `lattice_size` (how fine a lattice the scan determines) → `raster_fit`
(residuals on the raster and the lattice that they ask for), on `bending` (the energy) and `normal_equations` (banded).
"""
from .face_points import FacePoints, face_points
from .lattice_size import automatic_lattice, coarse_lattice
from .layers import Layers, dense_layers, rigid_start
from .patches import TrustedLayers, trust_all, trust_main_patches, trust_proven
from .raster_fit import RasterFit
from .robust_settings import LAYERS, MAIN_PATCHES, PROVEN, RobustSettings, RobustStage

__all__ = ["LAYERS", "MAIN_PATCHES", "PROVEN", "FacePoints", "Layers", "RasterFit", "RobustSettings", "RobustStage",
           "TrustedLayers", "automatic_lattice", "coarse_lattice", "dense_layers", "face_points", "rigid_start",
           "trust_all", "trust_main_patches", "trust_proven"]
