# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark fuzz``: damaged files of every kind that is read are taken or refused in one sentence."""
from .run import run

__all__ = ["run"]
