# SPDX-License-Identifier: LGPL-2.1-or-later
"""How seams look in the tree and in the 3D view. Written into documents: never rename."""
from __future__ import annotations

from typing import Any

from .. import RESOURCES
from ..compat import Stateless

COLOUR_BY = ("Verdict", "Lateral", "Normal", "Longitudinal", "Gap", "Opening", "Rotation")
_PROPERTIES = (("App::PropertyEnumeration", "ColourBy", "What colours the seams", list(COLOUR_BY)),
               ("App::PropertyBool", "ShowLegend", "Show what the colours mean", True))


def attach(item: Any) -> None:
    """Give new seams their view; its legend takes the place of that of earlier ones."""
    from ..objects.seams import is_seams

    for other in item.Document.Objects:
        if is_seams(other) and other is not item and "ShowLegend" in other.ViewObject.PropertiesList:
            other.ViewObject.ShowLegend = False
    SeamsView(item.ViewObject)


class SeamsView(Stateless):
    """View provider of `Seams`: draws them coloured by their figures or their verdict, with a legend."""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self
        self._ensure_properties(vobj)
        self._draw(vobj)

    def _ensure_properties(self, vobj: Any) -> None:
        for kind, name, tip, value in _PROPERTIES:
            if name not in vobj.PropertiesList:
                vobj.addProperty(kind, name, "FFDS", tip, 0)
                setattr(vobj, name, value)

    def attach(self, vobj: Any) -> None:
        """The view exists: add the node of the coloured lines to it."""
        from pivy import coin

        self._ensure_properties(vobj)
        self._switch = coin.SoSwitch()
        self._switch.whichChild = coin.SO_SWITCH_NONE
        self._lines = coin.SoSeparator()
        self._switch.addChild(self._lines)
        vobj.RootNode.addChild(self._switch)
        self._draw(vobj)

    def onChanged(self, vobj: Any, name: str) -> None:
        """A property of the view changed."""
        if name in ("ColourBy", "ShowLegend", "Visibility") and hasattr(self, "_switch"):
            self._draw(vobj)

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object changed; the table is the last one that a recompute writes."""
        if name == "Table" and hasattr(self, "_switch"):
            self._draw(obj.ViewObject)

    def _draw(self, vobj: Any) -> None:
        from pivy import coin

        from .view3d.seams_drawing import seam_nodes

        shown = (vobj.Visibility and "Table" in vobj.Object.PropertiesList and bool(vobj.Object.Table)
                 and vobj.Object.AsBuilt is not None and "ShowLegend" in vobj.PropertiesList)
        self._lines.removeAllChildren()
        for node in seam_nodes(vobj.Object, vobj.ColourBy, vobj.ShowLegend) if shown else ():
            self._lines.addChild(node)
        self._switch.whichChild = coin.SO_SWITCH_ALL if shown else coin.SO_SWITCH_NONE

    def getIcon(self) -> str:
        """The icon in the tree."""
        return str(RESOURCES / "icons" / "FFDS_FindSeams.svg")

    def setEdit(self, vobj: Any, mode: int) -> bool:
        """Seams lie on their part: there is nothing to drag."""
        return False

    def doubleClicked(self, vobj: Any) -> bool:
        """Open their panel; FreeCAD would begin to drag them."""
        from .panels.seams_panel import open_panel

        open_panel(vobj.Object)
        return True

    def claimChildren(self) -> list:
        """The part stays where it is in the tree."""
        return []
