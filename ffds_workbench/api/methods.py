# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the displacements of a part are found: each face by itself, or all faces together."""
from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

from ..brep.continuity import closing_displacements, local_displacements
from ..brep.face_displacement import FaceDisplacement
from ..brep.joint_part import joint_part
from ..brep.workpiece import Workpiece
from ..errors import RefusedError
from ..registration.face import FaceRegistration, far_side, observed_faces, register_ffd, register_ffds, register_robust
from ..registration.joint import JointFace, JointRegistration, SensorProfile, register_joint
from ..report.stopwatch import Stopwatch
from ..scan.cloud import PointCloud
from .tuning import Tuning

Lattice = tuple[int, int] | str

_HSU_LATTICE = (10, 10)
_SUSPECT, _CERTAIN = 1.5, 3.0
"""How much nearer the far side of a sheet has to be than the named face: to be looked into, and to be believed where
the scan shows a single face."""


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


def all_together(part: Workpiece, cloud: PointCloud, freeze: Collection[str], isometry: str, watch: Stopwatch,
                 tuning: Tuning, sensor: SensorProfile) -> Deformation:
    """Register the whole part in one solve; faces that the scan does not observe are carried along."""
    with watch.stage("register", "Registering all faces together"):
        found = register_joint(joint_part(part, freeze), cloud.points,
                               replace(tuning.joint(), isometry=isometry, sensor=sensor),
                               lambda stage, share: watch.tell(f"Registering all faces together: {stage}"),
                               cloud.normals)
    with watch.stage("rebuild", "Closing the edges"):
        moving = {index: displacement for index, displacement in enumerate(found.displacements)
                  if part.faces[index].name not in freeze}
        displacements = closing_displacements(part, moving)
    return Deformation(displacements, {}, found)


def each_by_itself(part: Workpiece, cloud: PointCloud, wanted: Sequence[int] | None, frozen: Collection[int],
                   method: str, lattice: Lattice, source_points: int, watch: Stopwatch, tuning: Tuning) -> Deformation:
    """Register the wanted faces, or every observed one, each by itself; the faces around them adapt."""
    with watch.stage("register", "Finding the faces that the scan observes"):
        registrations = _register_faces(part, cloud, wanted, frozen, method, lattice, source_points, watch,
                                        tuning)
    with watch.stage("rebuild", "Carrying the faces around along"):
        moving = {index: item.displacement for index, item in registrations.items()}
        return Deformation(local_displacements(part, moving, frozen), registrations)


def _register_faces(part: Workpiece, cloud: PointCloud, wanted: Sequence[int] | None, frozen: Collection[int],
                    method: str, lattice: Lattice, source_points: int, watch: Stopwatch,
                    tuning: Tuning) -> dict[int, FaceRegistration]:
    """Register each face by itself. A face that was not asked for by name and lacks data is left as it is."""
    if wanted is None:
        geometries = [part.geometry(index) for index in range(len(part.faces))]
        indices = [index for index in observed_faces(geometries, cloud.points) if index not in frozen]
    else:
        indices = list(wanted)
    whole = cache(lambda: _whole(part, cloud, tuning))
    registrations: dict[int, FaceRegistration] = {}
    refusals: list[RefusedError] = []
    for count, index in enumerate(indices, 1):
        watch.tell(f"Registering {part.faces[index].name} ({count} of {len(indices)})")
        try:
            found = _register_face(part, index, cloud, method, lattice, source_points, tuning)
            _refuse_far_side(part, index, found, whole)
            registrations[index] = found
        except RefusedError as refusal:
            if wanted is not None:
                raise
            refusals.append(refusal)
    if not registrations:
        if refusals:
            raise refusals[0]
        raise RefusedError("The scan observes no face of the model that may move: align the scan with the model, or "
                           "name the faces.")
    return registrations


def _register_face(part: Workpiece, index: int, cloud: PointCloud, method: str, lattice: Lattice,
                   source_points: int, tuning: Tuning) -> FaceRegistration:
    face = part.geometry(index)
    size = None if lattice == "auto" else lattice
    if method == "ffds":
        found = register_ffds(face, cloud.points, size, source_points)
    elif method == "ffd-hsu":
        found = register_ffd(face, cloud.points, size or _HSU_LATTICE, source_points)
    else:
        found = register_robust(face, cloud.points, size, tuning.robust())
    return found


def _whole(part: Workpiece, cloud: PointCloud, tuning: Tuning) -> JointRegistration | None:
    """All faces together, or None where that gives no answer."""
    try:
        return register_joint(joint_part(part, ()), cloud.points, tuning.joint(), scan_normals=cloud.normals)
    except RefusedError:
        return None


def _refuse_far_side(part: Workpiece, index: int, found: FaceRegistration,
                     whole: Callable[[], JointRegistration | None]) -> None:
    """Refuse a face that was deformed onto the far side of its sheet, if that is what the scan as a whole shows.

    Where it does not tell, the word of the user who named the face counts.
    """
    other, nearer = far_side(part.geometry(index), found, (face.geometry for face in part.faces))
    together = whole() if nearer >= _SUSPECT else None
    if together is None or together.unsure:
        return
    name = part.faces[index].name
    seen = {face.name: face.coverage for face in together.faces if face.points}
    tells = len(seen) > 1 or nearer > _CERTAIN
    if tells and seen.get(name, 0.0) < seen.get(other, 0.0):
        raise RefusedError(f"The scan shows {other}, on the other side, and not {name}: name {other} instead, or "
                           f"register all faces together, which carries {name} along.")
