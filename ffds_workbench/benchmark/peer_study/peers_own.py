# SPDX-License-Identifier: LGPL-2.1-or-later
"""This project's methods as competitors of the peers."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...registration.arrays import Array
from ...registration.face import FaceRegistration, register_ffd, register_ffds, register_robust
from ...registration.face_geometry import FaceGeometry

OWN: dict[str, Callable[[FaceGeometry, Array], FaceRegistration]] = {
    "ffds": lambda face, scan: register_ffds(face, scan, (10, 10), 400, overshoot=np.inf),
    "ffds_small": lambda face, scan: register_ffds(face, scan, (5, 5), 36, overshoot=np.inf),
    "ffd_hsu": lambda face, scan: register_ffd(face, scan, (10, 10), 400),
    "robust": lambda face, scan: register_robust(face, scan),
}
