# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark world``: what becomes of model files that nobody has tuned anything to."""
from .run import LIMIT, run
from .settings import DEFORMATIONS, ScanSettings

__all__ = ["DEFORMATIONS", "LIMIT", "ScanSettings", "run"]
