# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's figures, made anew: its two cases, the methods, the numbers, plots and pictures, and a real scan."""
