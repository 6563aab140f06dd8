# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the accuracy benchmark measures (cases, the synthetic sheet) and what it requires, line by line."""
