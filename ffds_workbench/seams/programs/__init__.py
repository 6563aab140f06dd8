# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robot programs along seams: one module per dialect, all from the same moves.

Every pose is the torch frame in the frame of the model; ``base`` is where that frame stands for the robot, and ``tool``
where the torch's frame sits on the flange: its z points out of the nozzle, its x along the travel.
"""
