# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a scan shows another part than the model, or lies elsewhere: decided before a solve diverges for minutes."""
from __future__ import annotations

from collections import deque

import numpy as np
import Part
from scipy.spatial import cKDTree

from ..brep.topology import points_on_edge
from ..brep.workpiece import Workpiece
from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.motions import apply
from ..registration.rigid import AMBIGUOUS, FAILED, align
from ..registration.uv_raster import make_raster
from ..scan.cloud import PointCloud
from .placing import target_of_shape

_LARGEST_DEFORMATION = 0.05
"""Of the part's size (a physical assumption): what a part is deformed by is less than a twentieth of its size."""
_UNEXPLAINED_SHARE = 0.25
"""Share of the scan beyond that from which the alignment is asked (theory: where three quarters lie on the part, the
solve holds; what else is in the scan is clutter)."""
_SAMPLE, _CELLS, _PLACES_ON_EDGE = 4000, 256, 33
"""Scan points that are looked at, and places on each face and along each edge: a twentieth of its size apart or
nearer."""
_known: deque[tuple[Part.Shape, Array, str]] = deque(maxlen=4)


def refuse_other_part(part: Workpiece, cloud: PointCloud) -> None:
    """Refuse a scan of which much lies far from the part, if no pose nearby explains it.

    Raises
    ------
    RefusedError : the scan is one of another part, or has to be aligned first
    """
    sample = cloud.points[np.random.default_rng(0).permutation(len(cloud.points))[:_SAMPLE]]
    if _unexplained(_on_edges(part), sample)[0] <= _UNEXPLAINED_SHARE:
        return  # as is usual where there are many faces: no need to look at all of them
    places = on_faces(part)
    share, far = _unexplained(places, sample)
    if share <= _UNEXPLAINED_SHARE:
        return
    for shape, points, sentence in _known:
        if shape.isEqual(part.shape) and np.array_equal(points, sample):
            break
    else:
        sentence = far_scan_refusal(part, cloud, places, far)
        _known.append((part.shape, sample, sentence))
    if sentence:
        raise RefusedError(sentence)


def _on_edges(part: Workpiece) -> Array:
    """Places (n, 3) along the edges of a part."""
    fractions = np.linspace(0.0, 1.0, _PLACES_ON_EDGE)
    return np.concatenate([points_on_edge(edge, fractions) for edge in part.edges])


def _unexplained(places: Array, points: Array) -> tuple[float, float]:
    """Share of points (n, 3) that lie farther from places on a part than its deformation explains, and that in mm."""
    far = _LARGEST_DEFORMATION * float(np.linalg.norm(np.ptp(places, axis=0)))
    distance, _ = cKDTree(places).query(points, distance_upper_bound=far)
    return float(np.isinf(distance).mean()), far


def on_faces(part: Workpiece) -> Array:
    """Places (n, 3) all over the faces of a part."""
    rasters = [make_raster(part.geometry(index), _CELLS) for index in range(len(part.faces))]
    return np.concatenate([raster.position[raster.inside] for raster in rasters])


def far_scan_refusal(part: Workpiece, cloud: PointCloud, places: Array, far: float) -> str:
    """Why the scan cannot be used as it lies, farther than ``far`` mm off ``places`` (n, 3) all over the part's faces;
    empty where it can."""
    found = align(target_of_shape(part.shape), cloud.points, "fine")
    if found.verdict == FAILED:
        return (f"The scan does not show this part where it lies: {found.reason}; choose another scan, or align it "
                f"with the model.")
    aligned = apply(found.T_model_scan, cloud.points)
    off = np.linalg.norm(aligned - cloud.points, axis=1)
    if found.verdict == AMBIGUOUS:  # a body of revolution fits however it is turned: how far off its surface?
        tree = cKDTree(places)
        off = tree.query(cloud.points[tree.query(aligned)[0] < far])[0]
    usual = float(np.median(off))
    return f"The scan lies {usual:.3g} mm off the part: align it with the model first." if usual > far else ""
