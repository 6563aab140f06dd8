# SPDX-License-Identifier: LGPL-2.1-or-later
"""Weld seams on the as-built model: where they run, how the torch stands, how wide the gap is, and the robot's program.

From the top: `find` says which edges are seams, `stations` samples them, `offsets` compares with the nominal model,
`table` and `programs` write what the robot needs, and `carry` transfers a taught path from the nominal to
the as-built model.
"""
