# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD runs this at every start, with and without a GUI: nothing is loaded before it is needed."""
import FreeCAD

FreeCAD.__unit_test__ += ["ffds_workbench.objects.selftest"]
