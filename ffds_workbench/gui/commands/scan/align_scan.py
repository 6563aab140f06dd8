# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_AlignScan: brings the selected scan onto the selected part."""
from __future__ import annotations

from ...running import call, in_background, name_of, tell
from ...translating import said, tr
from ..command import Command, part_and_scan

_SURE = 0.5
"""Confidence below which the user is asked to look."""


class AlignScan(Command):
    """Moves the scan as a rigid body, from anywhere."""

    NAME = "FFDS_AlignScan"
    MENU = "Align scan with part"
    TIP = "Move the selected scan onto the selected part, from wherever it lies"
    HELP = ("Finds the rigid motion that brings the scan onto the part, from wherever it lies, and says how sure "
            "that is. Select the part and the scan.")
    KEYS = "F, A"
    NEEDS = "Select one part and one scan first."

    def active(self) -> bool:
        """With one part, and one scan selected or known."""
        return None not in part_and_scan()

    def run(self) -> None:
        """Find the pose in the background, then move the scan in one undo step."""
        from ....objects.jobs import alignment_job
        from ....registration.rigid import AMBIGUOUS

        part, scan = part_and_scan()
        found = in_background(tr("Aligning the scan"), alignment_job.prepare(part, scan, "global"))
        call(scan.Document, "Align scan", f"align_scan({name_of(part)}, {name_of(scan)}, mode='global')")
        pose = found.alignment
        if pose.verdict == AMBIGUOUS:
            tell(tr("The scan fits the part equally well in {count} poses, and nothing shows which one is right. "
                    "Look at the scan, or undo and align it by three points.").format(count=len(pose.poses)))
        elif pose.confidence < _SURE:
            tell(tr("The alignment is not sure: {reason}. Look at the scan, or undo and align it by three points."
                    ).format(reason=said(pose.text)))
