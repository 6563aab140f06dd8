# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands for weld seams and robot programs."""
