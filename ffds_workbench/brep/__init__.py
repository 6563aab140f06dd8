# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a Part shape into a workpiece and writes the deformed one back with the topology unchanged."""
