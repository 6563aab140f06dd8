# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live preview of a whole part while a control moves: a warm joint solve of few points and coarse lattices."""
from __future__ import annotations

import numpy as np

from ...api.other_part import refuse_other_part
from ...api.tuning import joint_settings
from ...brep.joint_part import joint_part
from ...brep.workpiece import Workpiece
from ...registration.face import covered_share
from ...registration.joint import LiveJoint
from ...registration.request import RegistrationRequest
from ...registration.splines import SplineSurface
from ...scan.cloud import PointCloud
from .face_on_scan import Deviations, FaceOnScan, own_deviations
from .thinning import thinned

Found = list[tuple[FaceOnScan, Deviations, SplineSurface, float]]
"""Face by face: its scan points, its displacement and its coverage."""


class WholePreview:
    """All faces of a part on a scan in its frame (RefusedError where it shows another part)."""

    def __init__(self, part: Workpiece, scan: PointCloud) -> None:
        refuse_other_part(part, scan)
        self._part, self._scan = part, scan
        some = thinned(scan.points)
        self._few = [FaceOnScan(part.geometry(index), some) for index in range(len(part.faces))]
        self._coverage: list[float] = []
        self._live: tuple[tuple[str, ...], LiveJoint] | None = None

    def step(self, request: RegistrationRequest) -> Found:
        """One step of the coarse solve nearer to what the request asks for; the first one solves from the start.

        Raises
        ------
        InputError, RefusedError : as the joint solve does
        """
        wanted = joint_settings(request)
        if self._live is None or self._live[0] != request.freeze:
            part = joint_part(self._part, request.freeze)
            self._live = request.freeze, LiveJoint(part, self._scan.points, wanted, self._scan.normals)
        displacements = self._live[1].step(wanted)
        deviations = own_deviations(self._few, displacements)
        if not self._coverage:
            self._coverage = [covered_share(face.raster, np.bincount(item.cell, minlength=len(face.raster.inside)))
                              for face, item in zip(self._few, deviations, strict=True)]
        return list(zip(self._few, deviations, displacements, self._coverage, strict=True))
