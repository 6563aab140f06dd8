# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_FirstSteps: a page that walks through the example, with a button for each step."""
from __future__ import annotations

from ..command import Command


class FirstSteps(Command):
    """Opens the page beside FreeCAD's window; it stays while one works."""

    NAME = "FFDS_FirstSteps"
    MENU = "First steps"
    TIP = "A page that walks through the example: from the part and its scan to the as-built model"
    HELP = ("Walks through the example in six steps, from the part and its scan to the as-built model and its "
            "deviation. Each step has a button that does it.")
    KEYS = "F, H"

    def active(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """Show the page."""
        from ...first_steps_page import show_page

        show_page()
