# SPDX-License-Identifier: LGPL-2.1-or-later
"""What arms there are: `known` by name, `urdf` from files; `arm` is what is known of one."""
from .arm import Arm, Capsule
from .known import known_arms, read_arm

__all__ = ["Arm", "Capsule", "known_arms", "read_arm"]
