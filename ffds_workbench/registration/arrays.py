# SPDX-License-Identifier: LGPL-2.1-or-later
"""The array types of the registration, as annotations: real numbers, and indices or counts."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]
