# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark world``: the whole chain on model files that nothing was tuned on."""
from .run import LIMIT, run
from .settings import DEFORMATIONS, ScanSettings

__all__ = ["DEFORMATIONS", "LIMIT", "ScanSettings", "run"]
