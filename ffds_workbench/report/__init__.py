# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation statistics, topology certificate, pictures and the JSON report."""
