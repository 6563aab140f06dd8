# SPDX-License-Identifier: LGPL-2.1-or-later
"""Global search for a pose: `starts`, `candidates` (many poses improved at once) and `proposals` (the best of them, in
stages).
"""
from .candidates import field_of
from .proposals import LOCAL, QUICK, THOROUGH, Stage, propose
from .starts import starts_around, starts_of, turns_up_to

__all__ = ["LOCAL", "QUICK", "THOROUGH", "Stage", "field_of", "propose", "starts_around", "starts_of", "turns_up_to"]
