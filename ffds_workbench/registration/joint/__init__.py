# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole part at once: one sparse least-squares problem over the control points of all faces.

Read `solve.register_joint` first; the other modules each own one noun of it.
"""
from .live import LiveJoint
from .part import JointPart, SharedEdge
from .result import EdgeRegistration, JointFace, JointRegistration, SolidMotion
from .sensor import SensorProfile
from .settings import JointSettings
from .solve import register_joint

__all__ = ["EdgeRegistration", "JointFace", "JointPart", "JointRegistration", "JointSettings", "LiveJoint",
           "SensorProfile", "SharedEdge", "SolidMotion", "register_joint"]
