# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rigid pose of a scan on the nominal model. numpy and scipy only; never FreeCAD.

``align(target_of(faces), scan, mode)`` is the whole of it; ``align.py`` reads top to bottom as the algorithm, whose
quick and thorough ways are `settings` (how far it looks: `search_settings`). ``model/`` is the nominal part,
``search/`` proposes poses, ``refine/`` improves one, ``deformation/`` allows the part to have deformed. A `hypothesis`
is a refined pose with its `evidence`; `polish` refines it for the last time, and `verdict` (with `symmetry`) decides
whether it is the answer.
"""
from .align import align
from .alignment_result import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .model import Target, target_of
from .point_pairs import pose_of_pairs
from .settings import RigidSettings, SampleSettings, VerdictSettings

__all__ = ["AMBIGUOUS", "FAILED", "OK", "Alignment", "CandidatePose", "RigidSettings", "SampleSettings", "Target",
           "VerdictSettings", "align", "pose_of_pairs", "target_of"]
