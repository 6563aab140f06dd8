# SPDX-License-Identifier: LGPL-2.1-or-later
"""One face at a time: the registration methods that fit a face's displacement lattice to a scan.

`ffds` (the published method), `ffd` (deformation of the space around the face, to compare with) and `robust` (all scan
points, stiff first and soft later; its steps are in ``robust_fit/``). `control_lattice` holds the displacement field of
them all, `face_result` what they return, `neighbours` the closest scan points. `observed_faces` says which faces a scan
shows, `scan_coverage` how much of one, `far_side` whether a face was pulled onto the wrong skin of its sheet.
"""
from .control_lattice import ControlLattice, displacement_lattice
from .face_result import FaceRegistration
from .far_side import far_side
from .ffd import register_ffd
from .ffds import equidistant_grid, register_ffds, solve_lattice
from .neighbours import nearest_neighbours
from .observed_faces import observed_faces
from .robust import register_robust
from .robust_fit import LAYERS, MAIN_PATCHES, PROVEN, RobustSettings, RobustStage
from .scan_coverage import covered_share

__all__ = ["LAYERS", "MAIN_PATCHES", "PROVEN", "ControlLattice", "FaceRegistration", "RobustSettings", "RobustStage",
           "covered_share", "displacement_lattice", "equidistant_grid", "far_side", "nearest_neighbours",
           "observed_faces", "register_ffd", "register_ffds", "register_robust", "solve_lattice"]
