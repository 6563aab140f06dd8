# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams to files: tables, robot programs, the report and its picture, all of them or none."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...errors import InputError, RefusedError
from ...output import check_writable, replacing
from ...report import record
from ..clearance import blocked_ways
from ..measured import MeasuredSeam
from ..plan import SeamPlan
from ..programs.fanuc import ls_text
from ..programs.kawasaki import as_text
from ..programs.krl import krl_texts
from ..programs.moves import PlannedMoves, RobotSettings, SeamMoves, moves, program_name
from ..programs.rapid import rapid_text
from ..programs.urscript import urscript_text
from ..programs.yaskawa import jbi_text
from .picture import draw
from .table import csv_text

PROGRAMS = (".src", ".mod", ".script", ".ls", ".jbi", ".as", ".fcstd")
FORMATS = (".csv", *PROGRAMS)
_TEXTS = {".mod": rapid_text, ".script": urscript_text, ".ls": ls_text, ".jbi": jbi_text, ".as": as_text}
_KRL_NAME_LIMIT = 24


def check_seam_outputs(outs: Sequence[Path], extra: Sequence[Path | None] = (), inputs: Sequence[Path] = ()) -> None:
    """Refuse files that cannot be written, before any work is done.

    Parameters
    ----------
    outs : tables and programs
    extra : reports and pictures, None for those that are not wanted
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : a format is unknown, a folder is not there, two files are one, or one of them is an input
    """
    targets = [target for out in outs for target in _targets(out)] + [path for path in extra if path is not None]
    if len({target.resolve() for target in targets}) < len(targets):
        raise InputError("Two outputs have the same name: choose different ones.")
    for target in targets:
        check_writable(target, inputs)


def _targets(path: Path) -> list[Path]:
    """The files that an output consists of: a KRL program comes with its points."""
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"The output {path} is of an unknown format: use .csv, .src (KUKA), .mod (ABB), .script "
                         "(Universal Robots), .ls (FANUC), .jbi (Yaskawa), .as (Kawasaki) or .FCStd.")
    return [path, path.with_suffix(".dat")] if path.suffix.lower() == ".src" else [path]


def write_seams(plan: SeamPlan, outs: Sequence[str | Path], robot: RobotSettings | None = None,
                report_path: str | Path | None = None, picture: str | Path | None = None,
                inputs: Sequence[str | Path] = (), planned: PlannedMoves | None = None) -> list[str]:
    """Write tables and programs, by their suffixes, and the report and its picture: all of them or none.

    Programs hold the seams within their limits, and the others where the robot's settings ask for them; tables, the
    report and the picture hold all seams.

    Parameters
    ----------
    plan : the seams
    outs : tables (.csv) and programs (.src, .mod, .script, .ls, .jbi, .as, .FCStd)
    robot : its tool, base and motion; the defaults of `RobotSettings`
    report_path, picture : files: .json, and .png
    inputs : files that were read and must not be written over
    planned : what a robot makes of the seams; its settings count then, and its seams

    Returns
    -------
    notes : sentences on what the user must know of the programs

    Raises
    ------
    InputError : a format is unknown, a file cannot be written, a tool or base does not suit the robot
    RefusedError : a program would hold no seam, or the disk is full
    """
    files = list(map(Path, outs))
    report, drawing = (None if path is None else Path(path) for path in (report_path, picture))
    check_seam_outputs(files, (report, drawing), list(map(Path, inputs)))
    extra = [path for path in (report, drawing) if path is not None]
    robot = planned.settings if planned else robot or RobotSettings()
    paths = list(planned.seams) if planned else [moves(seam, robot) for seam in programmed_seams(plan, robot)]
    if not paths and any(out.suffix.lower() in PROGRAMS for out in files):
        raise RefusedError(planned.refusal if planned else "No seam is within its limits, so no program was written: "
                           "look at the report, set other limits, or keep failing seams (--keep-failing).")
    targets = [target for out in files for target in _targets(out)] + extra
    with replacing(*targets) as temporary:
        names = dict(zip(targets, temporary, strict=True))
        for out in files:
            _write_one(out, names, plan, paths, robot)
        if report is not None:
            record.write({**plan.record(), **({"robot": planned.record} if planned else {})}, names[report])
        if drawing is not None:
            draw(names[drawing], plan)
    renamed = [f"The controller calls the program {name}: name {out.name} and its .dat so." for out in files
               if out.suffix.lower() == ".src" and (name := program_name(out.stem, _KRL_NAME_LIMIT)) != out.stem]
    return program_notes(plan, robot, planned) + renamed


def programmed_seams(plan: SeamPlan, robot: RobotSettings) -> list[MeasuredSeam]:
    """The seams that come into programs.

    Parameters
    ----------
    plan : all seams
    robot : whether failing ones are kept
    """
    return [seam for seam in plan.seams if robot.keep_failing or not seam.exceeded(plan.limits)]


def program_notes(plan: SeamPlan, robot: RobotSettings, planned: PlannedMoves | None = None) -> list[str]:
    """What the user must know of the programs, as sentences; known before they are written.

    Parameters
    ----------
    plan : the seams
    robot : its tool, base and motion
    planned : what a robot makes of the seams
    """
    failing = [f"{seam.name} ({', '.join(exceeded)})" for seam in plan.seams
               if (exceeded := seam.exceeded(plan.limits))]
    notes = []
    if failing and robot.keep_failing:
        notes.append(f"Beyond their limits, but included in the programs: {', '.join(failing)}.")
    elif failing:
        notes.append(f"Beyond their limits, and therefore left out of the programs: {', '.join(failing)}.")
    if planned is not None:
        return [*notes, *planned.notes]
    return notes + blocked_ways(plan.shape, [moves(seam, robot) for seam in programmed_seams(plan, robot)])


def _write_one(out: Path, names: dict[Path, Path], plan: SeamPlan, paths: Sequence[SeamMoves],
               robot: RobotSettings) -> None:
    suffix = out.suffix.lower()
    if suffix == ".fcstd":
        from ..programs.trajectory import write_document

        write_document(names[out], paths, robot)
        return
    if suffix == ".csv":
        texts: tuple[str, ...] = (csv_text(plan.seams),)
    elif suffix == ".src":
        texts = krl_texts(out.stem, paths, robot)
    else:
        texts = (_TEXTS[suffix](out.stem, paths, robot),)
    for target, text in zip(_targets(out), texts, strict=True):
        names[target].write_text(text, "utf-8")
