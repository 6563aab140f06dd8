# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units of length that scans come in."""

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "m": 1000.0}
"""How many mm each unit is."""

NAMES = {"mm": "millimetres", "cm": "centimetres", "in": "inches", "m": "metres"}
