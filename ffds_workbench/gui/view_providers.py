# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the as-built part looks in the tree and in the 3D view. Written into documents: never rename."""
from __future__ import annotations

from typing import Any

from .. import RESOURCES
from ..compat import Stateless
from ..objects.scans import is_scan
from ..objects.seams import is_seams
from . import seams_view

SCAN, SCAN_POINT = (0.15, 0.45, 0.75), 2.0
"""Colour and size (pixels) of the points of a scan."""


def attach(item: Any, source: Any) -> None:
    """Give a new object its view: an as-built part in its nominal part's colours, seams in those of their figures, a
    scan in a colour that parts do not have."""
    if is_scan(item):
        item.ViewObject.ShapeColor, item.ViewObject.PointSize = SCAN, SCAN_POINT
        return
    if is_seams(item):
        seams_view.attach(item)
        return
    AsBuiltView(item.ViewObject)
    if source is None:
        return
    theirs, ours = source.getLinkedObject().ViewObject, item.ViewObject  # a link's own view has other modes
    for name in ("ShapeColor", "LineColor", "PointColor", "LineWidth", "Transparency", "DisplayMode", "DiffuseColor"):
        if hasattr(theirs, name) and getattr(theirs, name) != getattr(ours, name):
            setattr(ours, name, getattr(theirs, name))


class AsBuiltView(Stateless):
    """View provider of `AsBuilt`: opens its panel, and draws its control lattices where ``ShowLattice`` is set."""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self
        self._ensure_properties(vobj)

    def _ensure_properties(self, vobj: Any) -> None:
        if "ShowLattice" not in vobj.PropertiesList:
            vobj.addProperty("App::PropertyBool", "ShowLattice", "FFDS", "Draw the control lattices", 0)

    def attach(self, vobj: Any) -> None:
        """The view exists: add the node of the lattices to it."""
        from pivy import coin

        self._ensure_properties(vobj)
        self._switch = coin.SoSwitch()
        self._switch.whichChild = coin.SO_SWITCH_NONE
        style = coin.SoPickStyle()
        style.style = coin.SoPickStyle.UNPICKABLE
        self._lattices = coin.SoSeparator()
        self._lattices.addChild(style)
        self._lattices.addChild(coin.SoGroup())
        self._switch.addChild(self._lattices)
        vobj.RootNode.addChild(self._switch)
        self._draw(vobj)

    def onChanged(self, vobj: Any, name: str) -> None:
        """A property of the view changed."""
        if name in ("ShowLattice", "Visibility") and hasattr(self, "_switch"):
            self._draw(vobj)

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object changed; the lattice after is the last one that a recompute writes."""
        if name == "LatticeAsBuilt" and hasattr(self, "_switch"):
            self._draw(obj.ViewObject)

    def _draw(self, vobj: Any) -> None:
        from pivy import coin

        from ..objects.as_built import lattices_of
        from .view3d.overlay import lattice_nodes

        shown = vobj.ShowLattice and vobj.Visibility and bool(vobj.Object.LatticeSizes)
        group = self._lattices.getChild(1)
        group.removeAllChildren()
        for node in lattice_nodes(lattices_of(vobj.Object)) if shown else ():
            group.addChild(node)
        self._switch.whichChild = coin.SO_SWITCH_ALL if shown else coin.SO_SWITCH_NONE

    def getIcon(self) -> str:
        """The icon in the tree."""
        return str(RESOURCES / "icons" / "ffds.svg")

    def claimChildren(self) -> list:
        """Nothing moves below it in the tree: nominal part and scan stay where they are."""
        return []

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the panel with its settings."""
        from .panels.deformation_panel import open_panel

        open_panel(vobj.Object.Document, item=vobj.Object)
        return True
