# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ShowDocumentation: the documentation in the browser, or its sources where it was not built."""
from __future__ import annotations

from pathlib import Path

from .... import RESOURCES, ROOT
from ....errors import InputError
from ...qt import QtCore, QtGui
from ..command import Command


class ShowDocumentation(Command):
    """Opens the first page."""

    NAME = "FFDS_ShowDocumentation"
    MENU = "Documentation"
    TIP = "Tutorials, how-tos, what is refused and what to do, and how sure a result is"
    HELP = ("Opens the documentation: the web pages that resources/scripts/docs.sh has built, or the texts that they "
            "are built from.")
    KEYS = "F, F1"

    def active(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """Open it with what the system has for such files."""
        page = first_page()
        if not QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(page))):
            raise InputError(f"Nothing on this system opens {page}: open it by hand.")


def first_page() -> Path:
    """The built page where there is one, else its source."""
    built = ROOT / "out" / "docs" / "index.html"
    return built if built.is_file() else RESOURCES / "docs" / "index.md"
