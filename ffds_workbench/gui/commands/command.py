# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of the commands: resources, when they are active, and refusals as one sentence."""
from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ... import RESOURCES
from .. import giving_way
from ..qt import QtGui
from ..running import telling
from ..selection import Chosen, chosen, scans_of
from ..translating import tr


class Command(ABC):
    """A command; subclasses set the names and define `active` and `run`. ``NEEDS`` says what is missing where it is
    grey."""

    NAME = MENU = TIP = HELP = KEYS = ""
    NEEDS = "Open a document first."

    def __init__(self) -> None:
        self._why = ""

    def GetResources(self) -> dict[str, str]:
        """What FreeCAD shows of the command."""
        return {"MenuText": self.MENU, "ToolTip": self.TIP, "Accel": self.KEYS, "WhatsThis": self.HELP,
                "StatusTip": self.TIP, "Pixmap": str(RESOURCES / "icons" / f"{self.NAME}.svg")}

    def IsActive(self) -> bool:
        """Whether the command can be used now; asked often."""
        busy = Gui.Control.activeDialog() and not giving_way.is_open()
        live = not busy and self.active()
        self._explain("" if live else tr("Finish or close the open task first.") if busy else tr(self.NEEDS))
        return live

    def _explain(self, why: str) -> None:
        """Say in the tooltip why the command is grey, "" where it is not."""
        if why == self._why:
            return
        for action in Gui.getMainWindow().findChildren(QtGui.QAction, self.NAME):
            shown = action.toolTip()
            action.setToolTip(shown.removesuffix(_grey(self._why)) + _grey(why))
        self._why = why

    def Activated(self, index: int = 0) -> None:
        """The user chose the command."""
        giving_way.close()
        with telling():
            self.run()

    def active(self) -> bool:
        """Whether selection and document allow it."""
        return FreeCAD.ActiveDocument is not None

    @abstractmethod
    def run(self) -> None:
        """Do it."""


def _grey(why: str) -> str:
    return f"<p><b>{why}</b></p>" if why else ""


def one_part(selected: Chosen) -> Any:
    """The selected part where it is the only one, else None."""
    return selected.parts[0] if len(selected.parts) == 1 else None


def one_as_built(selected: Chosen) -> Any:
    """The selected part where it is the only one and an as-built one, else None; loads nothing, being asked often."""
    part = one_part(selected)
    return part if part is not None and "LatticeSizes" in part.PropertiesList else None


def one_scan(selected: Chosen) -> Any:
    """The selected scan, or the document's only one; else None."""
    if selected.scans:
        return selected.scans[0] if len(selected.scans) == 1 else None
    known = scans_of(FreeCAD.ActiveDocument) if FreeCAD.ActiveDocument is not None else []
    return known[0] if len(known) == 1 else None


def part_and_scan() -> tuple[Any, Any]:
    """The part and the scan that the selection means; None for what it leaves open."""
    selected = chosen()
    part, scan = one_part(selected), one_scan(selected)
    if part is not None and not selected.scans and getattr(part, "Scan", None) is not None:
        scan = part.Scan
    return part, scan
