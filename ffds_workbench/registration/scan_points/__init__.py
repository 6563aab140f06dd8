# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all of registration shares about the points of a scan: a `scan_sketch` (a few thousand even points with
normals), `scan_normals`, `normal_sides` (which side of its surface a point shows), the `table_plane` beside the part,
`scan_ends` (where a scan ends at an edge) and how many threads a search takes (`parallel`).
"""
from .normal_sides import orient_normals
from .parallel import workers
from .scan_ends import end_of_scan, outermost_points, weight_of_end
from .scan_normals import faces_alike, plane_normals, scan_normals
from .scan_sketch import Sketch, sketch_of, thin
from .table_plane import TablePlane, table_of_sketch

__all__ = ["Sketch", "TablePlane", "end_of_scan", "faces_alike", "orient_normals", "outermost_points", "plane_normals",
           "scan_normals", "sketch_of", "table_of_sketch", "thin", "weight_of_end", "workers"]
