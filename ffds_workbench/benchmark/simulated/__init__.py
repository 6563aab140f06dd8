# SPDX-License-Identifier: LGPL-2.1-or-later
"""Data with known truth: families of parts, deformations in closed form, the synthetic sheet; shapes to rebuild, and
files to damage.
"""
