# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's GUI runs this at every start: it makes the workbench known and loads nothing else."""
import FreeCADGui as Gui

from ffds_workbench import RESOURCES
from ffds_workbench.objects import boolean_check, views, waiting

views.dress_with("ffds_workbench.gui.view_providers")
waiting.wait_with("ffds_workbench.gui.running")
boolean_check.follow_with("ffds_workbench.gui.following")
Gui.addLanguagePath(str(RESOURCES / "translations"))
Gui.updateLocale()
Gui.addIconPath(str(RESOURCES / "icons"))
Gui.addPreferencePage(str(RESOURCES / "ui" / "preferences.ui"), "FFDS")


class FFDSWorkbench(Gui.Workbench):
    """The workbench. Names of this file cannot be seen from the methods, hence the imports inside them."""

    def __init__(self):
        import FreeCAD

        from ffds_workbench import RESOURCES

        self.__class__.Icon = str(RESOURCES / "icons" / "ffds.svg")
        self.__class__.MenuText = "FFDS"
        self.__class__.ToolTip = FreeCAD.Qt.translate("Workbench", "Deform a CAD model to a scan; its topology stays")

    def Initialize(self):
        """Called once, when the workbench is first opened."""
        from ffds_workbench.gui import commands

        commands.register()
        commands.appear_in(self)

    def Activated(self):
        """Called whenever the workbench has been opened."""
        from ffds_workbench.gui import commands

        commands.make_room()

    def ContextMenu(self, recipient):
        """Called when the context menu of the 3D view or the tree opens."""
        from ffds_workbench.gui import commands

        self.appendContextMenu("FFDS", commands.CONTEXT)

    def GetClassName(self):
        """The kind of workbench FreeCAD makes of this class."""
        return "Gui::PythonWorkbench"


Gui.addWorkbench(FFDSWorkbench())
