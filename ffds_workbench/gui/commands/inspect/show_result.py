# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ShowResult: the result page of the selected as-built part."""
from __future__ import annotations

from ...selection import chosen
from ..command import Command, one_as_built


class ShowResult(Command):
    """Opens the page that OK opens as well."""

    NAME = "FFDS_ShowResult"
    MENU = "Show result"
    TIP = "The verdict on the selected as-built part, face by face, with what to look at"
    HELP = ("Says in a sentence how well the selected as-built part fits its scan, with a table of its faces: before, "
            "after, band, what each rests on. A click on a row shows the face.")
    KEYS = "F, U"
    NEEDS = "Select one as-built part first."

    def active(self) -> bool:
        """With one as-built part selected."""
        return one_as_built(chosen()) is not None

    def run(self) -> None:
        """Open the page."""
        from ...panels.result_panel import open_page

        open_page(one_as_built(chosen()))
