# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_DeformWorkpiece: the panel of the deformation, on the whole part."""
from __future__ import annotations

from .deform_faces import DeformFaces


class DeformWorkpiece(DeformFaces):
    """Opens the panel set to the whole part."""

    NAME = "FFDS_DeformWorkpiece"
    MENU = "Deform whole part to scan…"
    TIP = "Deform all faces of a part to a scan together; faces that the scan does not see are carried along"
    HELP = ("All faces of the part are fitted to the scan together. Faces that the scan does not see are carried "
            "along by those that it sees; frozen faces stay. OK adds an as-built part.")
    KEYS = "F, W"

    whole = True
