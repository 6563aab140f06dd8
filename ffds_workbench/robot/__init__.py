# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs that a robot can run: arms and their kinematics, cells, clearances, and paths along the seams.

From the bottom: `kinematics` turns joints into poses and back, `arms` reads what arms there are, `cells` what stands
around them, `clearance` measures how near they come to it, `planning` finds the way. `process` and `searches` say how
to weld and what to touch before, `job` plans all seams of a part, and `programs` is what comes of it.
"""
