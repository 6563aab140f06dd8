# SPDX-License-Identifier: LGPL-2.1-or-later
"""How near torch and arm come to part and cell, in mm: `balls` of what moves, `surroundings` of what stands.

`moving` puts torch and arm where they are. `triangles` and `solids` measure exactly; `part` takes triangles from
shapes.
"""
from .balls import Balls, along, cylinder, joined_balls, of_links
from .moving import Moving
from .part import triangles_of, triangles_of_file
from .solids import Box, Cylinder, Solid
from .surroundings import MeshDistance, Nearness, Surroundings
from .triangles import Facets, joined, triangles

__all__ = ["Balls", "Box", "Cylinder", "MeshDistance", "Moving", "Nearness", "Solid", "Surroundings", "Facets",
           "along", "cylinder", "joined", "joined_balls", "of_links", "triangles", "triangles_of", "triangles_of_file"]
