# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms as axes in space (`chain`), their families (`families`) and all joints for a pose in closed form (`inverse`)."""
from .chain import Chain, chain_of
from .families import Family, distance_to_singularity, family, posture
from .inverse import BRANCHES, inverse, wrapped

__all__ = ["BRANCHES", "Chain", "Family", "chain_of", "distance_to_singularity", "family", "inverse",
           "posture", "wrapped"]
