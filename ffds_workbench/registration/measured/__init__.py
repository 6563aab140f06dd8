# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part through a few measured points instead of a scan: the rows of the joint solve without correspondences."""
from .measured_points import MeasuredPart, MeasuredRows, register_points

__all__ = ["MeasuredPart", "MeasuredRows", "register_points"]
