# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mathematics: fitting control lattices to scans. numpy, scipy and open3d only; never FreeCAD."""
