# SPDX-License-Identifier: LGPL-2.1-or-later
"""The task panels: what is picked and set, and OK. One panel per file; what they share is in `gui.widgets`."""
