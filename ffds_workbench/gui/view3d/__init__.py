# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is drawn in the 3D view without document objects: overlays, their colours, and the seams."""
