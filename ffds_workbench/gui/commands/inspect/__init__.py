# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands that show how well it fits."""
