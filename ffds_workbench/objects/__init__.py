# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document objects and what makes them: usable in macros and headless; never FreeCADGui.

The module and class paths of the proxies are stored in users' documents: they are part of the file format.
"""
