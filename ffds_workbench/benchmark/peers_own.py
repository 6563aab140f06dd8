# SPDX-License-Identifier: LGPL-2.1-or-later
"""This project's methods as competitors of the peers."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..registration.face import FaceGeometry
from ..registration.ffd import register_ffd
from ..registration.ffds import register_ffds
from ..registration.result import FaceRegistration
from ..registration.robust import register_robust
from ..registration.splines import Array

OWN: dict[str, Callable[[FaceGeometry, Array], FaceRegistration]] = {
    "ffds": lambda face, scan: register_ffds(face, scan, (10, 10), 400, overshoot=np.inf),
    "ffds_small": lambda face, scan: register_ffds(face, scan, (5, 5), 36, overshoot=np.inf),
    "ffd_hsu": lambda face, scan: register_ffd(face, scan, (10, 10), 400),
    "robust": lambda face, scan: register_robust(face, scan),
}
