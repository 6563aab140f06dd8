# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_PrepareScan: crops, cleans and thins the selected scan, or makes one of several."""
from __future__ import annotations

from typing import Any

from ...selection import chosen
from ..command import Command, one_part, one_scan


class PrepareScan(Command):
    """Opens the panel in which the steps are chosen."""

    NAME = "FFDS_PrepareScan"
    MENU = "Prepare scan…"
    TIP = "Crop the scan, take the table, clutter and single points away, thin it; several scans are made one"
    HELP = ("Select a scan, or several of one part, and the part where the scan is to be cropped to it. Each step "
            "shows what it takes away before anything is changed.")
    KEYS = "F, C"
    NEEDS = "Select a scan first."

    def active(self) -> bool:
        """With scans selected, or one in the document."""
        return bool(_scans())

    def run(self) -> None:
        """Open the panel."""
        from ...panels.preparation_panel import open_panel

        open_panel(_scans(), one_part(chosen()))


def _scans() -> list[Any]:
    return chosen().scans or [scan for scan in (one_scan(chosen()),) if scan is not None]
