# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams from a pair of models, found and measured. Their files are written by `seams.output`."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import Part

from ..brep.model_files import Model
from ..errors import InputError
from .chains import directed
from .find import joint_seams, named_seams
from .measured import MeasuredSeam, SeamLimits, measure
from .offsets import check_pair
from .output import report
from .settings import SeamSettings
from .trust import read_trust, trust_of
from .weldment import Weldment


@dataclass(frozen=True)
class SeamPlan:
    """Seams of a model, measured.

    Attributes
    ----------
    shape : the as-built model
    seams : in the order of their lowest-numbered edges
    limits : what passes
    notes : sentences on what was left out or not observed
    """

    shape: Part.Shape
    seams: tuple[MeasuredSeam, ...]
    limits: SeamLimits
    notes: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Whether no seam breaks a limit."""
        return not any(seam.exceeded(self.limits) for seam in self.seams)

    def table(self) -> str:
        """One line per seam, as text."""
        return report.table_text(self.seams, self.limits)

    def record(self) -> dict[str, Any]:
        """The report as a dictionary."""
        return report.report_record(self.seams, self.limits, self.notes)


def plan_seams(as_built: Model | Part.Shape | object, edges: Sequence[str] = (), auto: float | None = None,
               nominal: Model | Part.Shape | object | None = None, chain: bool = False,
               bands: str | Path | Mapping[str, Any] | None = None, settings: SeamSettings | None = None,
               limits: SeamLimits | None = None) -> SeamPlan:
    """Find and measure the seams of an as-built model.

    With a nominal model the joints are sought there, where the parts still lie as they were designed.

    Parameters
    ----------
    as_built, nominal : models, shapes or document objects
    bands : the registration's report or its JSON file, for what was observed and how sure it is
    edges : names, "EdgeN"; with ``auto`` only joints along these
    auto : find the joints of parts that lie within this distance (mm) of each other
    settings, limits : of the torch, and of what a seam may be
    chain : add the edges that go on from the named ones along tangency

    Raises
    ------
    InputError : neither edges nor ``auto``; an unknown edge; the nominal model is another part's
    RefusedError : no seam is found, or one is degenerate, too short, branching or without two faces
    """
    if not edges and auto is None:
        raise InputError("No seam was named: give edges, or a tolerance within which to find the joints by themselves.")
    if auto is not None and chain:
        raise InputError("Joints found by themselves are joined along tangency already: leave chain out.")
    settings = settings or SeamSettings()
    trust = None if bands is None else trust_of(bands) if isinstance(bands, Mapping) else read_trust(Path(bands))
    built = Weldment.of(as_built)
    before = None if nominal is None else Weldment.of(nominal)
    if before is not None:
        check_pair(before, built)
    where = before or built
    found = named_seams(where, edges, settings, chain) if auto is None else joint_seams(where, auto, settings, edges)
    seams = tuple(measure(built, directed(built, seam, settings.start, settings.reverse), settings, before, trust)
                  for seam in found.seams)
    doubts = tuple(seam.doubts for seam in seams if seam.doubts)
    return SeamPlan(built.shape, seams, limits or SeamLimits(), found.notes + doubts)
