# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deviation of a scan from a nominal model and from the as-built one made of it."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import Part

from ..brep.rebuilt_faces import built_geometry
from ..brep.workpiece import Workpiece
from ..registration.arrays import Array
from ..registration.face_geometry import FaceGeometry
from .deviation import FaceDeviation, measure, reach_of


def compare(nominal: Workpiece, built: Part.Shape, indices: Sequence[int], points: Array
            ) -> tuple[tuple[FaceDeviation, ...], tuple[FaceDeviation, ...]]:
    """Deviations from the nominal and from the as-built faces, each of the points that are nearest to them.

    A point may be nearest to one skin of a sheet before and to the other one after: as every shape has its own nearest
    points, neither looks better than `measure` finds it by itself. Faces around the wanted ones compete for points too,
    so that no face gets those of its neighbour.

    Parameters
    ----------
    nominal, built : before and after
    indices : the faces that are asked for, 0-based
    points : the scan, (n, 3) in mm

    Returns
    -------
    before, after : one entry per face that is asked for
    """
    reach, after = reach_of(nominal.shape.BoundBox.DiagonalLength), built.Faces
    return (_measured(nominal.shape.Faces, nominal.geometry, indices, points, reach),
            _measured(after, lambda index: built_geometry(nominal, index, after[index]), indices, points, reach))


def _measured(faces: Sequence[Part.Face], geometry: Callable[[int], FaceGeometry], indices: Sequence[int],
              points: Array, reach: float) -> tuple[FaceDeviation, ...]:
    """Deviations of the points (n, 3) nearest to the faces ``indices`` of a shape."""
    low, high = _boxes([faces[index] for index in indices], reach)
    near = np.flatnonzero(((points >= low.min(axis=0)) & (points <= high.max(axis=0))).all(axis=1))
    around = _faces_near(faces, indices, reach)
    found = dict(zip(around, measure([geometry(index) for index in around], points[near], reach), strict=True))
    return tuple(replace(found[index], points=near[found[index].points]) for index in indices)


def _faces_near(faces: Sequence[Part.Face], indices: Sequence[int], reach: float) -> list[int]:
    """Faces whose boxes come within ``reach`` of those of the faces ``indices``, these included."""
    low, high = _boxes(faces, reach)
    chosen = np.asarray(indices)
    meet = (low[:, None] <= high[chosen]) & (high[:, None] >= low[chosen])
    return np.flatnonzero(meet.all(axis=2).any(axis=1)).tolist()


def _boxes(faces: Sequence[Part.Face], margin: float) -> tuple[Array, Array]:
    """Lowest and highest coordinates of each face, widened by ``margin``; (n, 3) each."""
    boxes = [face.BoundBox for face in faces]
    return (np.array([(box.XMin, box.YMin, box.ZMin) for box in boxes]) - margin,
            np.array([(box.XMax, box.YMax, box.ZMax) for box in boxes]) + margin)
