# SPDX-License-Identifier: LGPL-2.1-or-later
"""The live preview: its numbers without Qt or Coin (`patches` face by face, `whole` for all faces together, from as few
points as `thinning` leaves), when they are computed (`runner`), and how they are drawn (`drawing`).
"""
