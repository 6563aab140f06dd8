# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is written of seams: `writing` (all files or none), `table`, `report`, and `picture`."""
