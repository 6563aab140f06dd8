# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers behind the live preview: faces registered fast, without a rebuild. Free of Qt and Coin.

The deviation after is read to first order along the normal of the nominal face; the as-built part's own is exact.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import Part
from numpy.typing import NDArray

from ...api.tuning import Tuning
from ...brep import workpiece
from ...errors import RefusedError
from ...objects.job import Settings
from ...objects.lattices import Lattice, draw_lattice
from ...registration.face import (FaceRegistration, RobustSettings, observed_faces, register_ffd, register_ffds,
                                  register_robust)
from ...registration.splines import DEGREE, SplineSurface
from ...report.stopwatch import Progress
from ...scan.cloud import PointCloud
from ..translating import tr
from .face_on_scan import Array, Deviations, FaceOnScan
from .whole import WholePreview

COARSE = 3000
"""Scan points per face that are looked at while a control is being moved."""
_COARSE_SAMPLE, _COARSE_STIFF, _COARSE_SOFT = 4000, ((1e4, 5.0), (1e3, 2.0)), ((30.0, 1.2),)
_PAPER_LATTICE = (10, 10)


@dataclass(frozen=True)
class Patch:
    """One previewed face.

    Attributes
    ----------
    name : "Face6"
    lattice : its control lattice before and after; None for a whole part, whose lattices would hide it
    points, triangles : the deformed face, (n, 3) in mm and (m, 3)
    outline : its trims, closed polylines, each (k, 3) in mm
    values : (n,) mean deviation of the scan there in mm, NaN without data
    before, after : (k,) deviations of its scan points in mm
    coverage : share of the face that the scan observes
    size : (N_i, N_j), control points in u and v; repeated ones of a closed direction do not count
    """

    name: str
    lattice: Lattice | None
    points: Array
    triangles: NDArray[np.intp]
    outline: list[Array]
    values: Array
    before: Array
    after: Array
    coverage: float
    size: tuple[int, int]


class Preview:
    """The faces of one part and one scan, made ready to be registered again and again.

    Parameters
    ----------
    shape : the nominal part in its own frame
    scan : in the same frame
    """

    def __init__(self, shape: Part.Shape, scan: PointCloud) -> None:
        self._part = workpiece.read(shape)
        self._scan = scan
        self._faces: dict[str, FaceOnScan] = {}
        self._sizes: dict[str, tuple[int, int]] = {}
        self._whole: WholePreview | None = None

    def patches(self, settings: Settings, coarse: bool, progress: Progress) -> list[Patch]:
        """Register what the settings name: on all points, or coarsely and fast. Any thread may call it, one at a time.

        Coarsely, an automatic lattice stays as it was first found.

        Raises
        ------
        InputError, RefusedError : as the registration does
        """
        if settings.faces is None and settings.method == "robust":
            return self._whole_patches(settings, coarse, progress)
        names = settings.faces if settings.faces is not None else self._observed(settings)
        return [self._face_patch(name, settings, coarse) for name in names]

    def _whole_patches(self, settings: Settings, coarse: bool, progress: Progress) -> list[Patch]:
        if self._whole is None:
            self._whole = WholePreview(self._part, self._scan)
        found = self._whole.step(settings) if coarse else self._whole.solve(settings, progress)
        return [_patch(face, deviations, displacement, coverage, False)
                for face, deviations, displacement, coverage in found]

    def _observed(self, settings: Settings) -> list[str]:
        geometries = [self._part.geometry(index) for index in range(len(self._part.faces))]
        names = [geometries[index].name for index in observed_faces(geometries, self._scan.points)]
        return [name for name in names if name not in settings.freeze]

    def _face_patch(self, name: str, settings: Settings, coarse: bool) -> Patch:
        if name not in self._faces:
            self._faces[name] = FaceOnScan(self._part.geometry(self._part.index(name)), self._scan.points)
        face = self._faces[name]
        index = face.places.index
        if not len(index):
            raise RefusedError(tr("The scan does not lie on {name}: check its unit and its alignment, or choose "
                                  "another face.").format(name=name))
        every = max(1, -(-len(index) // COARSE)) if coarse else 1
        if coarse and settings.lattice == "auto" and name in self._sizes:
            settings = replace(settings, lattice=self._sizes[name])
        found = _register(face, self._scan.points[index[::every]], settings, coarse)
        if coarse and settings.lattice == "auto":
            self._sizes[name] = _size(found.displacement)
        return _patch(face, face.deviations(found.displacement, every).near(), found.displacement, found.coverage, True)


def figures(patches: Sequence[Patch]) -> tuple[float, float, float, float, float]:
    """(mean before, p95 before, mean after, p95 after, coverage) of |deviation| over all patches, in mm."""
    before, after = (np.abs(np.concatenate([getattr(patch, state) for patch in patches]))
                     for state in ("before", "after"))
    coverage = float(np.mean([patch.coverage for patch in patches]))
    if not len(after):
        return 0.0, 0.0, 0.0, 0.0, coverage
    return (float(before.mean()), float(np.percentile(before, 95)), float(after.mean()),
            float(np.percentile(after, 95)), coverage)


def _patch(face: FaceOnScan, deviations: Deviations, displacement: SplineSurface, coverage: float,
           with_lattice: bool) -> Patch:
    lattice = draw_lattice(face.geometry.surface, displacement) if with_lattice else None
    return Patch(face.geometry.name, lattice, face.deformed(displacement), face.triangles, face.outline(displacement),
                 face.at_corners(deviations), deviations.before, deviations.after, coverage, _size(displacement))


def _register(face: FaceOnScan, points: Array, settings: Settings, coarse: bool) -> FaceRegistration:
    if settings.method == "robust":
        lattice = None if settings.lattice == "auto" else settings.lattice
        robust = Tuning(settings.stiffness, settings.gate).robust()
        if not coarse:
            return register_robust(face.geometry, points, lattice, robust)
        return register_robust(face.geometry, points, lattice, _coarse(robust), face.raster)
    published = register_ffds if settings.method == "ffds" else register_ffd
    lattice = _PAPER_LATTICE if settings.lattice == "auto" else settings.lattice
    return published(face.geometry, points, lattice, settings.source_points)


def _coarse(settings: RobustSettings) -> RobustSettings:
    return replace(settings, sample=_COARSE_SAMPLE, stiff=_COARSE_STIFF, soft=_COARSE_SOFT, final=settings.final[-1:])


def _size(displacement: SplineSurface) -> tuple[int, int]:
    rows, columns = displacement.control_points.shape[:2]
    return rows - DEGREE * displacement.periodic_u, columns - DEGREE * displacement.periodic_v
