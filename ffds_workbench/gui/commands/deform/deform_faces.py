# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_DeformFaces: the panel of the deformation, on the selected faces."""
from __future__ import annotations

import FreeCAD

from ...selection import chosen
from ..command import Command


class DeformFaces(Command):
    """Opens the panel; faces and scan may be picked before or after, in any order."""

    NAME = "FFDS_DeformFaces"
    MENU = "Deform faces to scan…"
    TIP = "Deform the selected faces to a scan, with a live preview; the faces around them adapt"
    HELP = ("Select faces of a part and a scan, in any order, before or after opening the panel. The preview "
            "follows the settings. OK adds an as-built part that follows the nominal part and the scan; its "
            "topology is that of the nominal part.")
    KEYS = "F, D"
    NEEDS = "Select faces of one part, a scan, or nothing at all."

    whole = False

    def active(self) -> bool:
        """With a part or a scan selected, or nothing at all; what cannot be used is explained in the panel."""
        if FreeCAD.ActiveDocument is None:
            return False
        selected = chosen()
        return len(selected.parts) <= 1 and (bool(selected.parts or selected.scans) or not selected.others)

    def run(self) -> None:
        """Open the panel; an as-built part is changed, any other gets one beside it."""
        from ....objects.as_built import is_as_built
        from ...panels.deformation_panel import open_panel

        selected = chosen()
        item = selected.parts[0] if selected.parts and is_as_built(selected.parts[0]) else None
        document = (selected.parts or selected.scans or [None])[0]
        open_panel(document.Document if document is not None else FreeCAD.ActiveDocument, item, self.whole)
