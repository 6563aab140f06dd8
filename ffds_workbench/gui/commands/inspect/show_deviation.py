# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ShowDeviation: the deviation map of the selected part and its scan."""
from __future__ import annotations

from ..command import Command, part_and_scan


class ShowDeviation(Command):
    """Colours over the scan or the part, with a legend, a histogram and the value under the cursor."""

    NAME = "FFDS_ShowDeviation"
    MENU = "Show deviation"
    TIP = "Colour the scan or the part by its deviation, before and after, with a legend and a histogram"
    HELP = ("Colours the scan or the part by the distance between them, nominal and as built. The panel has the "
            "range, the tolerance, the histogram and the value under the cursor.")
    KEYS = "F, V"
    NEEDS = "Select one part first, and the scan where the document holds several."

    def active(self) -> bool:
        """With one part, and one scan selected or known."""
        return None not in part_and_scan()

    def run(self) -> None:
        """Open the panel."""
        from ...panels.deviation_panel import open_panel

        open_panel(*part_and_scan())
