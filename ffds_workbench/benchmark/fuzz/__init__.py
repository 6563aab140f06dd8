# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark fuzz``: damaged files of every supported kind are read or refused in one sentence."""
from .run import run

__all__ = ["run"]
