# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole part at once: one sparse least-squares problem over the control points of all faces.

Read `solve.register_joint` first. `problem` holds what stays the same while it runs, `settings` the weights;
``iteration/`` holds the state and one Gauss-Newton step. ``surfaces/`` are the deformed faces, ``data/`` what the scan
says, ``priors/`` and ``body_field/`` what is assumed, ``linear/`` the sparse system, ``uncertainty/`` the bands.
``skins/`` decides which side of a sheet a point shows, `prior_trust` how much the priors count, `lattice_refinement`
where lattices get finer, `outcome` whether the result is accepted; `live` is the solve of previews.
"""
from .joint_result import EdgeRegistration, JointFace, JointRegistration, SolidMotion
from .live import LiveJoint
from .settings import JointSettings, SensorProfile
from .solve import register_joint
from .surfaces import JointPart, SharedEdge

__all__ = ["EdgeRegistration", "JointFace", "JointPart", "JointRegistration", "JointSettings", "LiveJoint",
           "SensorProfile", "SharedEdge", "SolidMotion", "register_joint"]
