# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands for scans: import, simulate, bring onto the part."""
