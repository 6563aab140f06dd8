# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in FreeCAD's window. The only place for FreeCADGui, Qt and Coin.

``commands/`` has one module per command, ``panels/`` the task panels, ``preview/`` the live preview, and ``view3d/``
what is drawn over the 3D view. `view_providers` and `seams_view` stay here: documents name their classes.
"""
