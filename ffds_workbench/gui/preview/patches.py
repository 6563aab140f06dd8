# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers behind the live preview: what OK will do, without the rebuild. Free of Qt and Coin.

While a control moves, few points give a coarse answer at once; when it rests, `find_deformation` gives that of OK. The
deviation after is read to first order along the normal of the nominal face; the as-built part's own is exact.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import Part
from numpy.typing import NDArray

from ...api.methods import Deformation, check_names, faces_to_register, find_deformation, register_face
from ...api.tuning import robust_settings
from ...brep import workpiece
from ...errors import RefusedError
from ...objects.lattices import Lattice, draw_lattice
from ...registration.arrays import Array
from ...registration.face import RobustSettings
from ...registration.request import RegistrationRequest
from ...registration.splines import DEGREE, SplineSurface
from ...report.stopwatch import Progress, Stopwatch
from ...scan.cloud import PointCloud
from ..translating import tr
from .face_on_scan import Deviations, Displacement, FaceOnScan, RebuiltDisplacement, own_deviations
from .thinning import FITTED_POINTS, every_nth
from .whole import WholePreview

_COARSE_STAGES = (0, 2, 4, -1)
"""Stages of the robust fit that a coarse answer needs: the first, two between and the last."""


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
    registered : whether the scan deformed it; else it adapts to faces that the scan deformed
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
    registered: bool = True


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
        self._faces: dict[int, FaceOnScan] = {}
        self._sizes: dict[tuple[str, int], tuple[int, int]] = {}
        self._whole: WholePreview | None = None

    def patches(self, request: RegistrationRequest, coarse: bool, progress: Progress) -> list[Patch]:
        """What the request makes of the part: as OK will make it, or coarsely and fast.

        Any thread may call it, one at a time; ``progress`` may raise to end it. Coarsely, an automatic lattice stays as
        it was first found.

        Raises
        ------
        InputError, RefusedError : as the registration does
        """
        if not coarse:
            found = find_deformation(self._part, self._scan, request, Stopwatch(progress))
            self._remember(request, {index: item.displacement for index, item in found.alone.items()})
            return self._final(found)
        check_names(self._part, request)
        if not request.together:
            return self._coarse_faces(request)
        if self._whole is None:
            self._whole = WholePreview(self._part, self._scan)
        return [_patch(face, deviations, displacement, displacement, coverage, False)
                for face, deviations, displacement, coverage in self._whole.step(request)]

    def _final(self, found: Deformation) -> list[Patch]:
        """The patches of all faces that move, as the rebuild will move them."""
        registered = dict(enumerate(found.joint.faces)) if found.joint is not None else found.alone
        moved: dict[int, Displacement] = {index: item.displacement for index, item in registered.items()}
        for index, displacement in found.displacements.items():
            moved[index] = RebuiltDisplacement(self._part.geometry(index).surface, displacement)
        faces = {index: self._face(index) for index in moved}
        if found.joint is not None:
            deviations = own_deviations(list(faces.values()), list(moved.values()))
        else:
            deviations = [face.deviations(moved[index]).near() for index, face in faces.items()]
        return [_patch(faces[index], own, moved[index], registered[index].displacement, registered[index].coverage,
                       found.joint is None) if index in registered else _neighbour(faces[index], moved[index])
                for index, own in zip(faces, deviations, strict=True)]

    def _remember(self, request: RegistrationRequest, displacements: Mapping[int, SplineSurface]) -> None:
        """Keep the lattices that were chosen from the data."""
        if request.lattice == "auto" and request.method != "ffd-hsu":
            self._sizes |= {(request.method, index): _size(found) for index, found in displacements.items()}

    def _face(self, index: int) -> FaceOnScan:
        if index not in self._faces:
            self._faces[index] = FaceOnScan(self._part.geometry(index), self._scan.points)
        return self._faces[index]

    def _coarse_faces(self, request: RegistrationRequest) -> list[Patch]:
        """Each face by itself, on few points; one that was not asked for by name and lacks data is left out."""
        patches: list[Patch] = []
        refusals: list[RefusedError] = []
        for index in faces_to_register(self._part, self._scan, request):
            try:
                patches.append(self._coarse_face(index, request))
            except RefusedError as refusal:
                if request.faces is not None:
                    raise
                refusals.append(refusal)
        if not patches:
            raise refusals[0]
        return patches

    def _coarse_face(self, index: int, request: RegistrationRequest) -> Patch:
        face = self._face(index)
        near = face.places.index
        if not len(near):
            raise RefusedError(tr("The scan does not lie on {name}: check its unit and its alignment, or choose "
                                  "another face.").format(name=face.geometry.name))
        known = self._sizes.get((request.method, index)) if request.lattice == "auto" else None
        request = request if known is None else replace(request, lattice=known)
        every = every_nth(len(near))
        found = register_face(face.geometry, self._scan.points[near[::every]], request,
                              _coarse(robust_settings(request)), face.raster)
        self._remember(request, {index: found.displacement})
        return _patch(face, face.deviations(found.displacement, every).near(), found.displacement, found.displacement,
                      found.coverage, True)


def figures(patches: Sequence[Patch]) -> tuple[float, float, float, float, float]:
    """(mean before, p95 before, mean after, p95 after, coverage) of |deviation| over all patches, in mm."""
    shown = [patch for patch in patches if patch.registered]
    before, after = (np.abs(np.concatenate([getattr(patch, state) for patch in shown]))
                     for state in ("before", "after"))
    coverage = float(np.mean([patch.coverage for patch in shown]))
    if not len(after):
        return 0.0, 0.0, 0.0, 0.0, coverage
    return (float(before.mean()), float(np.percentile(before, 95)), float(after.mean()),
            float(np.percentile(after, 95)), coverage)


def _patch(face: FaceOnScan, deviations: Deviations, displacement: Displacement, registered: SplineSurface,
           coverage: float, with_lattice: bool) -> Patch:
    """A face that the scan deformed: by ``displacement``, which closes the ``registered`` one along the edges."""
    lattice = draw_lattice(face.geometry.surface, registered) if with_lattice else None
    return Patch(face.geometry.name, lattice, face.deformed(displacement), face.triangles, face.outline(displacement),
                 face.at_corners(deviations), deviations.before, deviations.after, coverage, _size(registered))


def _neighbour(face: FaceOnScan, displacement: Displacement) -> Patch:
    """A face that adapts to those around it."""
    points = face.deformed(displacement)
    return Patch(face.geometry.name, None, points, face.triangles, face.outline(displacement),
                 np.full(len(points), np.nan), np.zeros(0), np.zeros(0), 0.0, (0, 0), False)


def _coarse(settings: RobustSettings) -> RobustSettings:
    return replace(settings, sample=FITTED_POINTS, schedule=tuple(settings.schedule[k] for k in _COARSE_STAGES))


def _size(displacement: SplineSurface) -> tuple[int, int]:
    rows, columns = displacement.control_points.shape[:2]
    return rows - DEGREE * displacement.periodic_u, columns - DEGREE * displacement.periodic_v
