# SPDX-License-Identifier: LGPL-2.1-or-later
"""What maps of the deviation share, in the window and on paper: faces as coloured meshes, and which points count."""
