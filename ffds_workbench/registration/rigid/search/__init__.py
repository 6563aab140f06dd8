# SPDX-License-Identifier: LGPL-2.1-or-later
"""Global search for a pose: `starts`, `candidates` (many poses improved at once) and `proposals` (the best of them, in
stages).
"""
from .proposals import propose
from .starts import starts_of

__all__ = ["propose", "starts_of"]
