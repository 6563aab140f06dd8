# SPDX-License-Identifier: LGPL-2.1-or-later
"""The methods, dispatched in one place: from a request to the displacements of a part, for results and previews alike.

`find_deformation` is the whole of it. A preview that has to answer at once calls `register_face` on fewer points.
"""
from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cache

from ..brep.continuity import closing_displacements, local_displacements
from ..brep.face_displacement import FaceDisplacement
from ..brep.folding import refuse_folds
from ..brep.joint_part import joint_part
from ..brep.workpiece import Workpiece
from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.face import (FaceRegistration, RobustSettings, far_side, observed_faces, register_ffd,
                                 register_ffds, register_robust)
from ..registration.face_geometry import FaceGeometry
from ..registration.joint import JointFace, JointRegistration, register_joint
from ..registration.request import RegistrationRequest
from ..registration.uv_raster import Raster
from ..report.stopwatch import Stopwatch
from ..scan.cloud import PointCloud
from .other_part import refuse_other_part
from .tuning import joint_settings, robust_settings

_HSU_LATTICE = (10, 10)
_SUSPECT, _CERTAIN = 1.5, 3.0
"""How much nearer the far side of a sheet has to be than the named face to be examined, and to be believed where the
scan shows a single face."""


class OtherSideError(RefusedError):
    """The scan shows the opposite side of the sheet from the one that was named.

    Parameters
    ----------
    named, shown : names of the two faces
    """

    def __init__(self, named: str, shown: str) -> None:
        super().__init__(f"The scan shows {shown}, on the other side, and not {named}: name {shown} instead, or "
                         f"register all faces together, which carries {named} along.")
        self.named, self.shown = named, shown


@dataclass(frozen=True)
class Deformation:
    """What a method found.

    Attributes
    ----------
    displacements : of every face that moves, by index; continuous across the edges
    alone : by index, the registrations of faces each by itself
    joint : the registration of the whole part, where all faces were registered together
    """

    displacements: Mapping[int, FaceDisplacement]
    alone: Mapping[int, FaceRegistration]
    joint: JointRegistration | None = None

    @property
    def faces(self) -> Mapping[int, FaceRegistration | JointFace]:
        """By index, the registration of each face that the scan deformed."""
        if self.joint is None:
            return self.alone
        return {index: face for index, face in enumerate(self.joint.faces) if face.points}


def find_deformation(part: Workpiece, cloud: PointCloud, request: RegistrationRequest,
                     watch: Stopwatch) -> Deformation:
    """The displacements of all faces that move, by the method of the request.

    Raises
    ------
    InputError : the part has no face of a name
    RefusedError : too little of the scan lies on the part, it shows something else, or a face would fold over
    """
    check_names(part, request)
    if request.together:
        with watch.stage("register", "Comparing the scan with the model"):
            refuse_other_part(part, cloud)
    by_method = _all_together if request.together else _each_by_itself
    found = by_method(part, cloud, request, watch)
    refuse_folds(part, found.displacements)
    return found


def check_names(part: Workpiece, request: RegistrationRequest) -> None:
    """Refuse the names of faces that the part does not have (InputError)."""
    for name in (*(request.faces or ()), *request.freeze):
        part.index(name)


def register_face(face: FaceGeometry, points: Array, request: RegistrationRequest,
                  robust: RobustSettings | None = None, raster: Raster | None = None) -> FaceRegistration:
    """Register one face by itself, by the method of the request.

    Parameters
    ----------
    face : the nominal face
    points : (n, 3) in mm, in the frame of the model
    robust, raster : of method "robust", where others than those of the request are wanted, or a raster is at hand

    Raises
    ------
    RefusedError : too little of the scan lies on the face, or the lattice is too fine for it
    """
    size = request.counts
    if request.method == "ffds":
        return register_ffds(face, points, size, request.source_points)
    if request.method == "ffd-hsu":
        return register_ffd(face, points, size or _HSU_LATTICE, request.source_points)
    return register_robust(face, points, size, robust or robust_settings(request), raster)


def faces_to_register(part: Workpiece, cloud: PointCloud, request: RegistrationRequest) -> list[int]:
    """The faces that are registered each by itself: the named ones, or those that the scan observes and that may move.

    Raises
    ------
    RefusedError : the scan observes none
    """
    frozen = _frozen(part, request)
    if request.faces is not None:
        return [part.index(name) for name in request.faces]
    geometries = [part.geometry(index) for index in range(len(part.faces))]
    indices = [index for index in observed_faces(geometries, cloud.points) if index not in frozen]
    if not indices:
        raise RefusedError("The scan observes no face of the model that may move: align the scan with the model, or "
                           "name the faces.")
    return indices


def _all_together(part: Workpiece, cloud: PointCloud, request: RegistrationRequest, watch: Stopwatch) -> Deformation:
    """Register the whole part in one solve; faces that the scan does not observe are carried along."""
    with watch.stage("register", "Registering all faces together"):
        found = register_joint(joint_part(part, request.freeze), cloud.points, joint_settings(request),
                               lambda stage, share: watch.tell(f"Registering all faces together: {stage}"),
                               cloud.normals)
    with watch.stage("rebuild", "Closing the edges"):
        moving = {index: displacement for index, displacement in enumerate(found.displacements)
                  if part.faces[index].name not in request.freeze}
        displacements = closing_displacements(part, moving)
    return Deformation(displacements, {}, found)


def _each_by_itself(part: Workpiece, cloud: PointCloud, request: RegistrationRequest, watch: Stopwatch) -> Deformation:
    """Register the wanted faces, or every observed one, each by itself; the faces around them adapt."""
    with watch.stage("register", "Finding the faces that the scan observes"):
        registrations = _register_faces(part, cloud, request, watch)
    with watch.stage("rebuild", "Carrying the faces around along"):
        moving = {index: item.displacement for index, item in registrations.items()}
        return Deformation(local_displacements(part, moving, _frozen(part, request)), registrations)


def _register_faces(part: Workpiece, cloud: PointCloud, request: RegistrationRequest,
                    watch: Stopwatch) -> dict[int, FaceRegistration]:
    """Register each face by itself. A face that was not asked for by name and lacks data is left as it is."""
    indices = faces_to_register(part, cloud, request)
    whole = cache(lambda: _whole(part, cloud, request))
    registrations: dict[int, FaceRegistration] = {}
    refusals: list[RefusedError] = []
    for count, index in enumerate(indices, 1):
        watch.tell(f"Registering {part.faces[index].name} ({count} of {len(indices)})")
        try:
            found = register_face(part.geometry(index), cloud.points, request)
            _refuse_far_side(part, index, found, whole)
            registrations[index] = found
        except RefusedError as refusal:
            if request.faces is not None:
                raise
            refusals.append(refusal)
    if not registrations:
        raise refusals[0]
    return registrations


def _frozen(part: Workpiece, request: RegistrationRequest) -> Collection[int]:
    return [part.index(name) for name in request.freeze]


def _whole(part: Workpiece, cloud: PointCloud, request: RegistrationRequest) -> JointRegistration | None:
    """All faces together, or None where that gives no answer."""
    try:
        return register_joint(joint_part(part, ()), cloud.points, joint_settings(request), scan_normals=cloud.normals)
    except RefusedError:
        return None


def _refuse_far_side(part: Workpiece, index: int, found: FaceRegistration,
                     whole: Callable[[], JointRegistration | None]) -> None:
    """Refuse a face that was deformed onto the far side of its sheet, if that is what the scan as a whole shows.

    Where that is undecided, the user who named the face is believed.
    """
    other, nearer = far_side(part.geometry(index), found, (face.geometry for face in part.faces))
    together = whole() if nearer >= _SUSPECT else None
    if together is None or together.unsure:
        return
    name = part.faces[index].name
    seen = {face.name: face.coverage for face in together.faces if face.points}
    tells = len(seen) > 1 or nearer > _CERTAIN
    if tells and seen.get(name, 0.0) < seen.get(other, 0.0):
        raise OtherSideError(name, other)
