# SPDX-License-Identifier: LGPL-2.1-or-later
"""Open CASCADE's BREP text: `records` (the syntax), `instances` (sub-shapes per place), `curves` and `pcurves` (their
mathematics), `curve_fit`, `turned` (geometry run the other way), and `rewriting` (new geometry into old text).
"""
from .curve_fit import crossings, fit_curve
from .curves import Curve, Line, Spline, print_curve, read_curve
from .instances import Instances, Locations, product, walk
from .pcurves import Pcurve, PcurveReader, UsedEdge
from .records import BrepText, Curve3d, EdgeCurves, VertexPoint, dump, parse
from .rewriting import NewEdge, NewFace, NewVertex, Rewriter

__all__ = ["BrepText", "Curve", "Curve3d", "EdgeCurves", "Instances", "Line", "Locations", "NewEdge", "NewFace",
           "NewVertex", "Pcurve", "PcurveReader", "Rewriter", "Spline", "UsedEdge", "VertexPoint", "crossings", "dump",
           "fit_curve", "parse", "print_curve", "product", "read_curve", "walk"]
