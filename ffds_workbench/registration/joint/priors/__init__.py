# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is assumed where the scan shows nothing: `stiffness` (bending and stretching of a face), `couplings` (shared
edges, poles, thickness, edge angles, frozen faces), `shared_edges` (the places along them), `sheet_pairs` (the two
skins of a sheet), `contacts` (touching solids), `trust_factors` (how much each prior counts), `constant_rows` (their
rows that are the same at every shape), `free_motions` (of a solid within its own surface).
"""
from .constant_rows import ConstantRows, constant_rows
from .contacts import contact_rows
from .couplings import Couplings, make_couplings, pose_weight
from .free_motions import FreeMotions, find_free_motions
from .shared_edges import SharedEdgePlaces, directions
from .sheet_pairs import find_pairs, parameters
from .stiffness import COMPONENTS, SLIDING, Stiffness, make_stiffness
from .trust_factors import PriorTrust

__all__ = ["COMPONENTS", "SLIDING", "ConstantRows", "Couplings", "FreeMotions", "PriorTrust", "SharedEdgePlaces",
           "Stiffness", "constant_rows", "contact_rows", "directions", "find_free_motions",
           "find_pairs", "make_couplings", "make_stiffness", "parameters", "pose_weight"]
