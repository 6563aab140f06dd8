# SPDX-License-Identifier: LGPL-2.1-or-later
"""The files about seams: `writing` (all files or none), `table`, `report`, and `picture`."""
