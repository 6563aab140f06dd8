# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live preview: its numbers without Qt or Coin, when they are computed, and how they are drawn."""
