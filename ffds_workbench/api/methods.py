# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the displacements of a part are found: each face by itself, or all faces together."""
from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from ..brep.closing import closing_displacements
from ..brep.displacement import FaceDisplacement
from ..brep.field import local_displacements
from ..brep.joint_part import joint_part
from ..brep.workpiece import Workpiece
from ..errors import RefusedError
from ..registration.ffd import register_ffd
from ..registration.ffds import register_ffds
from ..registration.joint import JointFace, JointRegistration, SensorProfile, register_joint
from ..registration.observed import observed_faces
from ..registration.result import FaceRegistration
from ..registration.robust import register_robust
from ..report.stopwatch import Stopwatch
from ..scan.cloud import PointCloud
from .tuning import Tuning

Lattice = tuple[int, int] | str

_HSU_LATTICE = (10, 10)


@dataclass(frozen=True)
class Deformation:
    """What a method found.

    Attributes
    ----------
    displacements : of every face that moves, by index; continuous across the edges
    faces : by index, the registration of each face that the scan deformed
    joint : the registration of the whole part, where all faces were registered together
    """

    displacements: Mapping[int, FaceDisplacement]
    faces: Mapping[int, FaceRegistration | JointFace]
    joint: JointRegistration | None = None


def all_together(part: Workpiece, cloud: PointCloud, freeze: Collection[str], isometry: str, watch: Stopwatch,
                 tuning: Tuning, sensor: SensorProfile) -> Deformation:
    """Register the whole part in one solve; faces that the scan does not observe are carried along."""
    with watch.stage("register", "Registering all faces together"):
        found = register_joint(joint_part(part, freeze), cloud.points,
                               replace(tuning.joint(), isometry=isometry, sensor=sensor),
                               lambda stage, share: watch.tell(f"Registering all faces together: {stage}"))
    with watch.stage("rebuild", "Closing the edges"):
        moving = {index: face.displacement for index, face in enumerate(found.faces) if face.name not in freeze}
        displacements = closing_displacements(part, moving)
    return Deformation(displacements, {index: face for index, face in enumerate(found.faces) if face.points}, found)


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
    registrations: dict[int, FaceRegistration] = {}
    refusals: list[RefusedError] = []
    for count, index in enumerate(indices, 1):
        watch.tell(f"Registering {part.faces[index].name} ({count} of {len(indices)})")
        try:
            registrations[index] = _register_face(part, index, cloud, method, lattice, source_points, tuning)
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
        return register_ffds(face, cloud.points, size, source_points)
    if method == "ffd-hsu":
        return register_ffd(face, cloud.points, size or _HSU_LATTICE, source_points)
    return register_robust(face, cloud.points, size, tuning.robust())
