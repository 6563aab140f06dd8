# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose of a scan by datums: `features` are what datum faces are, `own_points` those of the scan that show them,
`datum_pose` meets them in their order, `reference_points` many points each along its own direction.
"""
from .datum_pose import DatumFit, DatumPose, align_on_datums
from .features import CylinderFeature, DatumFeature, PlaneFeature, SphereFeature
from .own_points import points_of_faces
from .reference_points import ReferencePoint, align_on_points

__all__ = ["CylinderFeature", "DatumFeature", "DatumFit", "DatumPose", "PlaneFeature", "ReferencePoint",
           "SphereFeature", "align_on_datums", "align_on_points", "points_of_faces"]
