# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of the paper: the rigid pose of a scan on the nominal model. numpy and scipy only; never FreeCAD.

``align(target_of(faces), scan, mode)`` is the whole of it; ``align.py`` reads top to bottom as the algorithm.
"""
from .align import align
from .alignment import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .target import Target, target_of

__all__ = ["AMBIGUOUS", "FAILED", "OK", "Alignment", "CandidatePose", "Target", "align", "target_of"]
