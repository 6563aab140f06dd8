# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a Part shape into a workpiece and writes the deformed one back with the topology unchanged.

`workpiece` (with `face_parameters`, `surface_fit`, `topology`) reads, `rebuild` (with `edge_geometry`, `edges`,
`folding`, `pcurve_start`) writes, from a `face_displacement` per face. ``continuity/`` keeps neighbours joined,
``occt_text/`` is Open CASCADE's text format, ``model_files/`` reads and writes STEP, BREP and FreeCAD documents.
`joint_part` hands a workpiece to the joint solve, `rebuilt_faces` and `simulated_scan` serve tests, reports and
benchmarks.
"""
