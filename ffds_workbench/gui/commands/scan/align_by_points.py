# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_AlignByPoints: brings the selected scan onto the selected part from three picked pairs of points."""
from __future__ import annotations

from ..command import Command, part_and_scan


class AlignByPoints(Command):
    """Opens the panel in which the points are picked."""

    NAME = "FFDS_AlignByPoints"
    MENU = "Align scan by three points…"
    TIP = "Pick three points on the scan and the same three on the part; the alignment goes on from there"
    HELP = ("Where a scan is not aligned by itself: pick three points on the scan and the same three, in the same "
            "order, on the part.")
    KEYS = "F, 3"
    NEEDS = "Select one part and one scan first."

    def active(self) -> bool:
        """With one part, and one scan selected or known."""
        return None not in part_and_scan()

    def run(self) -> None:
        """Open the panel."""
        from ...panels.point_pairs_panel import open_panel

        open_panel(*part_and_scan())
