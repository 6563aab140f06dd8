# SPDX-License-Identifier: LGPL-2.1-or-later
"""Neighbouring faces stay joined: `agreement` on their shared edges, `edge_closing` after a solve over all faces, and
the `local_field` in space that carries the neighbours of edited faces along (with `cutoff`, `radial_basis`,
`edge_samples`, `held_edges`).
"""
from .edge_closing import closing_displacements
from .edge_samples import side_lengths
from .local_field import local_displacements

__all__ = ["closing_displacements", "local_displacements", "side_lengths"]
