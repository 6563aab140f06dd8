# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mathematics: fitting control lattices to scans. numpy and scipy only; never FreeCAD.

``face/`` registers one face at a time, ``joint/`` the whole part at once, ``measured/`` a part through a few points
instead of a scan. ``rigid/`` finds the pose of the scan, ``datums/`` its pose by datum faces; ``space/`` interpolates
a displacement in space. Here in the open is what they share: `splines`, `face_geometry` and `trims` (a face as
arrays), `uv_raster` and `footpoints` (scan points over a face), `projection` (exact closest points), `motions` (rigid
motions), `robust_weights`, and ``scan_points/`` (the points of a scan, their normals and where they end).
"""
