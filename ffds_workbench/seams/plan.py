# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams from a pair of models to files: the whole job, top to bottom."""
from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import Part

from ..brep.model_files import Model
from ..errors import InputError
from ..output import check_writable, replacing
from . import report
from .chains import directed
from .clearance import blocked_ways
from .find import joint_seams, named_seams
from .measured import MeasuredSeam, SeamLimits, measure
from .offsets import check_pair
from .programs.krl import krl_texts
from .programs.moves import RobotSettings, SeamMoves, moves, program_name
from .programs.rapid import rapid_text
from .programs.urscript import urscript_text
from .settings import SeamSettings
from .table import csv_text
from .trust import read_trust, trust_of
from .weldment import Weldment

FORMATS = (".csv", ".src", ".mod", ".script", ".fcstd")
_KRL_NAME_LIMIT = 24


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


def check_seam_outputs(outs: Sequence[Path], extra: Sequence[Path | None] = (), inputs: Sequence[Path] = ()) -> None:
    """Refuse tables and programs (``outs``), reports and pictures (``extra``) that cannot be written (InputError)."""
    targets = [target for out in outs for target in _targets(out)] + [path for path in extra if path is not None]
    if len({target.resolve() for target in targets}) < len(targets):
        raise InputError("Two outputs have the same name: choose different ones.")
    for target in targets:
        check_writable(target, inputs)


def _targets(path: Path) -> list[Path]:
    """The files that an output consists of: a KRL program comes with its points."""
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"The output {path} is of an unknown format: use .csv, .src (KUKA), .mod (ABB), .script "
                         "(Universal Robots) or .FCStd.")
    return [path, path.with_suffix(".dat")] if path.suffix.lower() == ".src" else [path]


def write_seams(plan: SeamPlan, outs: Sequence[str | Path], robot: RobotSettings | None = None,
                report_path: str | Path | None = None, picture: str | Path | None = None,
                inputs: Sequence[str | Path] = ()) -> list[str]:
    """Write tables and programs, by their suffixes, and the report and its picture: all of them or none.

    Returns
    -------
    notes : sentences on what the user must know of the programs

    Raises
    ------
    InputError : a format is unknown, a file cannot be written, a tool or base does not suit the robot
    RefusedError : the disk is full
    """
    outs, inputs = list(map(Path, outs)), list(map(Path, inputs))
    report_path, picture = (None if path is None else Path(path) for path in (report_path, picture))
    check_seam_outputs(outs, (report_path, picture), inputs)
    extra = [path for path in (report_path, picture) if path is not None]
    robot = robot or RobotSettings()
    paths = [moves(seam, robot) for seam in plan.seams]
    targets = [target for out in outs for target in _targets(out)] + extra
    with replacing(*targets) as temporary:
        names = dict(zip(targets, temporary, strict=True))
        for out in outs:
            _write_one(out, names, plan, paths, robot)
        if report_path is not None:
            text = json.dumps(plan.record(), indent=1, ensure_ascii=False, allow_nan=False)
            names[report_path].write_text(text + "\n", "utf-8")
        if picture is not None:
            from .picture import draw

            draw(names[picture], plan)
    renamed = [f"The controller calls the program {name}: name {out.name} and its .dat so." for out in outs
               if out.suffix.lower() == ".src" and (name := program_name(out.stem, _KRL_NAME_LIMIT)) != out.stem]
    return blocked_ways(plan.shape, paths) + renamed


def _write_one(out: Path, names: dict[Path, Path], plan: SeamPlan, paths: Sequence[SeamMoves],
               robot: RobotSettings) -> None:
    suffix = out.suffix.lower()
    if suffix == ".fcstd":
        from .programs.trajectory import write_document

        write_document(names[out], paths, robot)
        return
    if suffix == ".csv":
        texts = (csv_text(plan.seams),)
    elif suffix == ".src":
        texts = krl_texts(out.stem, paths, robot)
    else:
        texts = (rapid_text if suffix == ".mod" else urscript_text)(out.stem, paths, robot),
    for target, text in zip(_targets(out), texts, strict=True):
        names[target].write_text(text, "utf-8")
