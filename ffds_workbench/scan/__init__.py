# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans: reading, units, cleaning. Never FreeCADGui."""
