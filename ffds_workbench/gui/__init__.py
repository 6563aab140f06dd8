# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in FreeCAD's window: commands, panels and views. The only place for FreeCADGui, Qt and Coin."""
