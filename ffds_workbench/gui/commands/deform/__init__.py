# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands that deform a part to a scan, and for what comes of it."""
