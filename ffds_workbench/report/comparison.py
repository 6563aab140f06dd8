# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deviation of the same scan points from a nominal model and from the as-built one made of it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import Part

from ..brep.rebuilt_faces import built_geometry
from ..brep.workpiece import Workpiece
from ..registration.arrays import Array
from .deviation import FaceDeviation, measure, measure_again, reach_of


def compare(nominal: Workpiece, built: Part.Shape, indices: Sequence[int], points: Array
            ) -> tuple[tuple[FaceDeviation, ...], tuple[FaceDeviation, ...]]:
    """Deviations before and after of the points that lie on the as-built faces; the same points in both.

    Faces around the registered ones take part in the contest for points, so that none is blamed for its neighbour's.

    Parameters
    ----------
    nominal, built : before and after
    indices : the registered faces, 0-based
    points : the scan, (n, 3) in mm

    Returns
    -------
    before, after : one entry per registered face
    """
    reach = reach_of(built.BoundBox.DiagonalLength)
    faces = built.Faces
    low, high = _boxes([faces[index] for index in indices], reach)
    near = np.flatnonzero(((points >= low.min(axis=0)) & (points <= high.max(axis=0))).all(axis=1))
    around = _faces_near(faces, indices, reach)
    after = measure([built_geometry(nominal, index, faces[index]) for index in around], points[near], reach)
    measured = {index: replace(item, points=near[item.points]) for index, item in zip(around, after, strict=True)}
    pairs = []
    for index in indices:
        item = measured[index]
        first = measure_again(nominal.geometry(index), points, item, 3.0 * reach)
        same = np.isin(item.points, first.points)
        pairs.append((first, replace(item, points=item.points[same], deviations=item.deviations[same],
                                     normals=item.normals[same])))
    return tuple(first for first, _ in pairs), tuple(second for _, second in pairs)


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
