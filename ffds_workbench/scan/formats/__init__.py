# SPDX-License-Identifier: LGPL-2.1-or-later
"""One module per file format of scans: PLY, PCD, E57, STL and text; `rows` (binary rows) and `lzf` (PCD's compression).
"""
