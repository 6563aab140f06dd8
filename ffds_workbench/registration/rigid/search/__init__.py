# SPDX-License-Identifier: LGPL-2.1-or-later
"""Global search for a pose: `starts`, `candidates` (many poses improved at once) and `proposals` (the best of them, in
stages).
"""
from .proposals import LOCAL_SEARCH, QUICK_SEARCH, THOROUGH_SEARCH, SearchStage, propose
from .starts import starts_around, starts_of, turns_up_to

__all__ = ["LOCAL_SEARCH", "QUICK_SEARCH", "THOROUGH_SEARCH", "SearchStage", "propose", "starts_around",
           "starts_of", "turns_up_to"]
