# SPDX-License-Identifier: LGPL-2.1-or-later
"""One planning of seams on a part of the document: its inputs, and its result while the inputs stay the same."""
from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import Any

from ... import api
from ...brep.model_files import Model, model_file
from ...errors import InputError
from ...report.stopwatch import Progress
from ...seams.plan import SeamPlan
from ..as_built import is_as_built, report_of
from ..sources import standing_for

_last: dict[str, SeamPlan] = {}


@dataclass(frozen=True)
class SeamWishes:
    """The arguments of `api.plan_seams` besides the models; see there. ``tolerance`` is its ``auto``."""

    edges: tuple[str, ...] = ()
    tolerance: float | None = None
    chain: bool = False
    settings: api.SeamSettings = field(default_factory=api.SeamSettings)
    limits: api.SeamLimits = field(default_factory=api.SeamLimits)


@dataclass(frozen=True)
class SeamJob:
    """Seams in the document's coordinates.

    Attributes
    ----------
    as_built, nominal : the models where they stand; without a nominal one nothing is compared
    bands : the report of the registration, or None
    """

    as_built: Model
    nominal: Model | None
    bands: dict[str, Any] | None
    wishes: SeamWishes

    @property
    def digest(self) -> str:
        """Differs where any input differs."""
        found = hashlib.blake2b()
        for model in (self.as_built, self.nominal):
            found.update(model.shape.exportBrepToString().encode() if model is not None else b"-")
        found.update(json.dumps(self.bands).encode())
        found.update(repr(self.wishes).encode())
        return found.hexdigest()

    def run(self, progress: Progress | None = None) -> SeamPlan:
        """Find and measure the seams, or recall them. Touches no document: any thread may run it.

        Raises
        ------
        InputError, RefusedError : as `api.plan_seams` does
        """
        digest = self.digest
        if digest not in _last:
            if progress is not None:
                progress("Finding and measuring the seams")
            wanted = self.wishes
            plan = api.plan_seams(self.as_built, wanted.edges, wanted.tolerance, self.nominal, wanted.chain, self.bands,
                                  wanted.settings, wanted.limits)
            _last.clear()
            _last[digest] = plan
        return _last[digest]


def make_seam_job(as_built: Any, nominal: Any, wishes: SeamWishes) -> SeamJob:
    """The planning of seams on a document object (main thread only).

    Raises
    ------
    InputError : one of the objects has no shape to use
    """
    as_built = standing_for(as_built)
    report = report_of(as_built) if is_as_built(as_built) else {}
    bands = {name: report[name] for name in ("faces", "edges") if name in report}
    if nominal is as_built:
        raise InputError(f"{as_built.Label} cannot be compared with itself: choose the nominal part, or none.")
    before = None if nominal is None else model_file.from_object(standing_for(nominal))
    return SeamJob(model_file.from_object(as_built), before, bands or None, wishes)
