# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rigid pose of a scan on the nominal model. numpy and scipy only; never FreeCAD.

``align(target_of(faces), scan, mode)`` is the whole of it; ``align.py`` reads top to bottom as the algorithm, `quick`
is its short way for a clean scan that lies nearby. ``model/`` is the nominal part, ``search/`` proposes poses,
``refine/`` improves one, ``deformation/`` allows the part to have deformed. A `hypothesis` is a refined pose with its
`evidence`; `polish` has the last word on its numbers, `verdict` (with `symmetry`) on whether it is the answer.
"""
from .align import align
from .alignment_result import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .model import Target, target_of
from .point_pairs import pose_of_pairs

__all__ = ["AMBIGUOUS", "FAILED", "OK", "Alignment", "CandidatePose", "Target", "align", "pose_of_pairs", "target_of"]
