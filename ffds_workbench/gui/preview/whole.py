# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live preview of a whole part: a warm joint solve while a control moves, the real one when it rests."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...api.tuning import Tuning
from ...brep.joint_part import joint_part
from ...brep.workpiece import Workpiece
from ...objects.job import Settings
from ...registration.face import covered_share
from ...registration.joint import JointSettings, LiveJoint, register_joint
from ...registration.splines import SplineSurface
from ...report.stopwatch import Progress
from ...scan.cloud import PointCloud
from .face_on_scan import Array, Deviations, FaceOnScan, farthest_of

_LOOKED_AT = 8000
"""Scan points whose deviations are shown while a control is being moved."""

Found = list[tuple[FaceOnScan, Deviations, SplineSurface, float]]
"""Face by face: its scan points, its displacement and its coverage."""


class WholePreview:
    """All faces of a part on a scan in its frame."""

    def __init__(self, part: Workpiece, scan: PointCloud) -> None:
        self._part, self._scan = part, scan
        some = np.random.default_rng(0).permutation(len(scan.points))[:_LOOKED_AT]
        self._few = self._on(scan.points[some])
        self._all: list[FaceOnScan] = []
        self._coverage: list[float] = []
        self._live: tuple[tuple[str, ...], LiveJoint] | None = None

    def step(self, settings: Settings) -> Found:
        """One step of the coarse solve nearer to what the settings ask for; the first one solves from the start.

        Raises
        ------
        InputError, RefusedError : as the joint solve does
        """
        wanted = joint_settings(settings)
        if self._live is None or self._live[0] != settings.freeze:
            part = joint_part(self._part, settings.freeze)
            self._live = settings.freeze, LiveJoint(part, self._scan.points, wanted, self._scan.normals)
        displacements = self._live[1].step(wanted)
        deviations = _own(self._few, displacements)
        if not self._coverage:
            self._coverage = [covered_share(face.raster, np.bincount(item.cell, minlength=len(face.raster.inside)))
                              for face, item in zip(self._few, deviations, strict=True)]
        return list(zip(self._few, deviations, displacements, self._coverage, strict=True))

    def solve(self, settings: Settings, progress: Progress) -> Found:
        """The registration that OK will do; ``progress`` may raise to end it."""
        found = register_joint(joint_part(self._part, settings.freeze), self._scan.points,
                               joint_settings(settings), lambda stage, share: progress(stage), self._scan.normals)
        if not self._all:
            self._all = self._on(self._scan.points)
        displacements = [face.displacement for face in found.faces]
        self._coverage = [face.coverage for face in found.faces]
        return list(zip(self._all, _own(self._all, displacements), displacements, self._coverage, strict=True))

    def _on(self, points: Array) -> list[FaceOnScan]:
        return [FaceOnScan(self._part.geometry(index), points) for index in range(len(self._part.faces))]


def joint_settings(settings: Settings) -> JointSettings:
    """The settings of the joint solve that OK will use."""
    return replace(Tuning(settings.stiffness, settings.gate).joint(), isometry=settings.isometry)


def _own(faces: Sequence[FaceOnScan], displacements: Sequence[SplineSurface]) -> list[Deviations]:
    """The deviations of each face, every scan point with the face that it is nearest to after the deformation."""
    found = [face.deviations(displacement) for face, displacement in zip(faces, displacements, strict=True)]
    nearest = np.full(1 + max((int(item.index.max()) for item in found if len(item.index)), default=0), np.inf)
    for item in found:
        nearest[item.index] = np.minimum(nearest[item.index], np.abs(item.after))
    owned = [item.part(np.abs(item.after) <= nearest[item.index]) for item in found]
    farthest = farthest_of(np.concatenate([item.after for item in owned]))
    return [item.part(np.abs(item.after) < farthest) for item in owned]
