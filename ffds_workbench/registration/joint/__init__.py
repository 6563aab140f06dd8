# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole part at once: one sparse least-squares problem over the control points of all faces.

Read `solve.register_joint` first; the other modules each own one noun of it.
"""
