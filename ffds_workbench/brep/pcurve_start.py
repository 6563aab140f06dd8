# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lets a pcurve start slightly late, so that readers of the STEP file give the edge the tolerance that it needs.

STEP has no tolerance for a single edge. OCCT's reader takes the largest distance between the edge's curve and its
pcurves at 23 parameters, ends included; between them it can be a little larger, and then the check for Boolean
operations objects. So one pcurve starts late, along itself, by a little more than the largest distance: the shape stays
as it is, and the first of the 23 parameters has the largest distance. The reader lets the edge start where its vertex
is nearest, which is a little early or late itself: that may take as much from the start as it adds to the rest.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..registration.arrays import Array
from .edges import PlacedCurve, Trace
from .occt_text import fit_curve, print_curve

_SAFETY, _LATEST_START = 1.3, 9.5e-5
"""Safety factor on the gap (theory: more than it grows between two samples), and the latest start in mm: an edge that
gapes more than that does so in the nominal part already (theory: below the tolerance of 1e-4 that readers mend)."""
_LEAST_SPAN, _LONGEST_SPAN = 1e-3, 0.2
"""Share of the edge along which the pcurve catches up; more where the edge is short, but no more than this (unit)."""
_SPAN_PER_LATENESS = 6.0
"""Of the way that it catches up along, over the way that it is late by (theory: its speed then changes by a sixth)."""
_PROBE_STEP = 1e-4
"""Of the edge, between two places that tell its speed (theory: far above rounding)."""
_PCURVE_TOLERANCE = 1e-7
"""Of the new pcurve in mm (theory: Open CASCADE's own precision, 1e-7)."""


def delay_pcurve_start(trace: Trace, curve: PlacedCurve, gap: float, vertex: Array) -> Trace | None:
    """The trace starting late by a little more than ``gap`` (mm); None where the edge is too short or gapes too much.

    Parameters
    ----------
    trace : an edge as one of its faces sees it
    curve : the edge's curve
    gap : largest distance in mm of the curve from any of its traces
    vertex : (3,), where the edge starts
    """
    start, soon = trace.at(np.array([0.0, _PROBE_STEP]))
    speed = float(np.linalg.norm(soon - start)) / _PROBE_STEP
    begin = curve.at(np.zeros(1))[0]
    shift = float(np.linalg.norm(vertex - begin))
    lateness = _SAFETY * (gap + shift) + float(np.linalg.norm(start - begin)) + shift
    span = max(_LEAST_SPAN, _SPAN_PER_LATENESS * lateness / max(speed, 1e-12))
    if span > _LONGEST_SPAN or lateness > _LATEST_START:
        return None
    pcurve = trace.pcurve
    length = pcurve.last - pcurve.first
    breaks = np.append(pcurve.curve.breaks(), pcurve.first + span * length)
    new = fit_curve(pcurve.curve, pcurve.first, pcurve.last, breaks, _PCURVE_TOLERANCE)
    new.poles[0] = trace.uv(np.array([lateness / speed]))[0]
    return replace(trace, pcurve=replace(pcurve, curve=new, record=print_curve(new)))
