# SPDX-License-Identifier: LGPL-2.1-or-later
"""The seams of a part: a document object that follows the part, and the robot programs made from it."""
from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np
import Part
from numpy.typing import NDArray

from .. import api
from ..errors import InputError, RefusedError
from ..seams.output.table import csv_text
from ..seams.plan import SeamPlan
from ..seams.programs.moves import moves
from ..seams.programs.trajectory import add_trajectories as add_moves
from . import views
from .as_built import is_as_built
from .feature import HIDDEN, OUTPUT, READ_ONLY, Feature, Property
from .jobs.seam_job import SeamJob, SeamWishes, make_seam_job
from .waiting import wait_for

Array = NDArray[np.float64]

_PLAIN, _PASSES, _ROBOT = api.SeamSettings(), api.SeamLimits(), api.RobotSettings()
_LIMITS = {"lateral": "App::PropertyLength", "normal": "App::PropertyLength", "longitudinal": "App::PropertyLength",
           "gap": "App::PropertyLength", "opening": "App::PropertyAngle", "rotation": "App::PropertyAngle"}
FIGURES = {"lateral": "lateral", "normal": "normal", "longitudinal": "longitudinal", "gap": "gap",
           "opening": "opening_angle", "rotation": "torch_rotation"}
"""Columns of the table by the names of the limits; lengths in mm, angles in degrees."""


def _limit_property(name: str) -> str:
    return f"Limit{name.capitalize()}"


class Seams(Feature):
    """Finds and measures seams on ``AsBuilt``. Its shape is their lines, in the document's coordinates."""

    PROPERTIES = (
        Property("AsBuilt", "App::PropertyLinkGlobal", "Seams", "The part to weld"),
        Property("Nominal", "App::PropertyLinkGlobal", "Seams", "The part as it was designed, or none"),
        Property("Edges", "App::PropertyLinkSubListGlobal", "Seams",
                 "The edges to weld, joined where they go on along tangency; with a tolerance, the joints on them"),
        Property("Tolerance", "App::PropertyLength", "Seams",
                 "Find the joints of parts that touch within this distance; 0: the seams are the named edges"),
        Property("Chain", "App::PropertyBool", "Seams", "Add the edges that go on from the named ones along tangency"),
        Property("StartHere", "App::PropertyBool", "Seams", "Start nearest to the point Start"),
        Property("Start", "App::PropertyVectorDistance", "Seams",
                 "Where a closed seam starts, or the end to start at, if StartHere is set"),
        Property("Reverse", "App::PropertyBool", "Seams", "Weld in the other direction"),
        Property("Step", "App::PropertyLength", "Stations", "Largest distance of stations", _PLAIN.step),
        Property("Chord", "App::PropertyLength", "Stations",
                 "Largest distance of the seam from the straight line between stations", _PLAIN.chord),
        Property("WorkAngle", "App::PropertyAngle", "Stations", "Lean of the torch about the travel direction"),
        Property("TravelAngle", "App::PropertyAngle", "Stations", "Lean of the torch forwards, or back if negative"),
        *(Property(_limit_property(name), kind, "Limits", f"The largest {name} that passes", getattr(_PASSES, name))
          for name, kind in _LIMITS.items()),
        Property("Tool", "App::PropertyString", "Robot",
                 "Its number (KUKA), its name (ABB), or X,Y,Z,A,B,C in mm and degrees"),
        Property("Base", "App::PropertyString", "Robot", "Where the document's origin stands, given like the tool"),
        Property("Velocity", "App::PropertySpeed", "Robot", "Along the seam", _ROBOT.velocity),
        Property("Approach", "App::PropertyLength", "Robot", "Distance to approach from and retract to",
                 _ROBOT.approach),
        Property("KeepFailing", "App::PropertyBool", "Robot", "Seams beyond their limits are in the programs as well"),
        Property("Programmed", "App::PropertyStringList", "Robot",
                 "The seams that come into the programs, in their order; none: all within their limits", None, OUTPUT),
        Property("Holders", "App::PropertyLinkListGlobal", "Seams", "What moves the parts when it moves", None,
                 READ_ONLY | HIDDEN),
        Property("Verdicts", "App::PropertyStringList", "Result", "Seam by seam: its edges, pass or fail", None,
                 READ_ONLY),
        Property("Notes", "App::PropertyStringList", "Result", "What to know before welding", None, READ_ONLY),
        Property("Table", "App::PropertyString", "Result", "All stations, as CSV", None, READ_ONLY | HIDDEN),
        Property("Report", "App::PropertyString", "Result", "The report as JSON", None, READ_ONLY | HIDDEN),
    )

    def ensure_properties(self, obj: Any) -> None:
        """Add the properties that the object does not have yet; its placement is the part's, and not its own."""
        super().ensure_properties(obj)
        obj.setEditorMode("Placement", READ_ONLY)
        self.onChanged(obj, "Placement")

    def onChanged(self, obj: Any, name: str) -> None:
        """A property changed: seams lie on their part, and cannot be moved off it."""
        if name == "Placement" and not obj.Placement.isIdentity():
            obj.Placement = FreeCAD.Placement()

    def execute(self, obj: Any) -> None:
        """Recompute. What goes wrong makes the object invalid, with the sentence; its last seams stay."""
        plan = wait_for(obj.Label, job_of(obj).run)
        record = plan.record()
        obj.Shape = Part.makeCompound([_line(seam.stations.positions) for seam in plan.seams])
        obj.Verdicts = [": ".join(filter(None, (item["name"], item["verdict"], ", ".join(item["exceeded"]))))
                        for item in record["seams"]]
        obj.Notes = list(plan.notes)
        obj.Report = json.dumps(record)
        obj.Table = csv_text(plan.seams)


def is_seams(item: Any) -> bool:
    """Whether a document object holds seams of this workbench."""
    return isinstance(getattr(item, "Proxy", None), Seams)


def make_seams(part: Any, edges: Sequence[str] = (), tolerance: float | None = None, chain: bool = False,
               nominal: Any = None, settings: api.SeamSettings | None = None,
               limits: api.SeamLimits | None = None) -> Any:
    """Seams of a part as an object of its document.

    Parameters
    ----------
    part : the object to weld; an as-built part is compared with its nominal one, and its scan tells how sure it is
    edges, tolerance, chain, settings, limits : as ``edges``, ``auto``, ``chain``, … of `api.plan_seams`
    nominal : the part to compare with, if another is wanted

    Raises
    ------
    InputError, RefusedError : as `api.plan_seams` does; the document is left as it was
    """
    wishes = SeamWishes(tuple(edges), tolerance, chain, settings or _PLAIN, limits or _PASSES)
    wait_for(part.Label, prepare(part, wishes, nominal).run)
    item = part.Document.addObject("Part::FeaturePython", "Seams")
    Seams(item)
    item.Label = f"{part.Label} seams"
    item.AsBuilt, item.Nominal = part, _nominal_of(part, nominal)
    _apply(item, wishes)
    item.recompute()
    item.purgeTouched()
    views.dress(item, part)
    return item


def prepare(part: Any, wishes: SeamWishes, nominal: Any = None) -> SeamJob:
    """What `make_seams` will compute, for any thread (call this on the main one)."""
    return make_seam_job(part, _nominal_of(part, nominal), wishes)


def job_of(obj: Any) -> SeamJob:
    """The planning that a Seams object stands for.

    Raises
    ------
    InputError : its part is lost, an edge is another part's, or a setting makes no sense
    """
    if obj.AsBuilt is None:
        raise InputError(f"{obj.Label} has lost its part: choose one in its properties.")
    return make_seam_job(obj.AsBuilt, obj.Nominal, wishes_of(obj))


def wishes_of(obj: Any) -> SeamWishes:
    """The settings that a Seams object holds (InputError where they make no sense)."""
    for item, _ in obj.Edges:
        if item is not obj.AsBuilt:
            raise InputError(f"An edge of {item.Label} is named, but {obj.Label} is made from {obj.AsBuilt.Label}: "
                             f"choose edges of one part.")
    edges = tuple(name for _, names in obj.Edges for name in names if name)
    settings = api.SeamSettings(
        step=obj.Step.Value, chord=obj.Chord.Value, work_angle=math.radians(obj.WorkAngle.Value),
        travel_angle=math.radians(obj.TravelAngle.Value), start=tuple(obj.Start) if obj.StartHere else None,
        reverse=obj.Reverse, corner=_PLAIN.corner, min_length=_PLAIN.min_length)
    limits = api.SeamLimits(**{name: getattr(obj, _limit_property(name)).Value for name in _LIMITS})
    return SeamWishes(edges, obj.Tolerance.Value or None, obj.Chain, settings, limits)


def stations_of(obj: Any) -> dict[str, Array]:
    """The stations of the last recompute: columns (n,) by name, NaN where empty; ``seam`` counts from 1.

    ``flag``, ``kind`` and ``edge`` are text.
    """
    rows = list(csv.DictReader(io.StringIO(obj.Table)))
    text = ("flag", "kind", "edge")
    return {name: np.array([row[name] if name in text else float(row[name] or "nan") for row in rows])
            for name in (rows[0] if rows else ())}


def export_program(item: Any, path: str, keep_failing: bool = False) -> list[str]:
    """Write seams as a program (.src with .dat, .mod, .script), a table (.csv), a document with trajectories (.FCStd),
    a report (.json) or a picture (.png): whole or not at all. Returns what the user must know of it, as sentences.

    Seams beyond their limits are in no program, unless the object keeps them or ``keep_failing`` asks for them.

    Raises
    ------
    InputError, RefusedError : as `api.write_seams` does
    """
    plan, suffix = _chosen_plan(item), Path(path).suffix.lower()
    extra = {".json": "report_path", ".png": "picture"}
    if suffix in extra:
        return api.write_seams(plan, [], **{extra[suffix]: path})
    robot = robot_of(item)
    return api.write_seams(plan, [path], replace(robot, keep_failing=robot.keep_failing or keep_failing))


def add_trajectories(item: Any) -> list[Any]:
    """FreeCAD's own robot trajectories of the seams within their limits, one object each, in their document.

    Raises
    ------
    RefusedError : there is none
    """
    plan, robot = _chosen_plan(item), robot_of(item)
    seams = api.programmed_seams(plan, robot)
    if not seams:
        raise RefusedError(f"No seam of {item.Label} is within its limits: look at its report, or set KeepFailing.")
    added = add_moves(item.Document, [moves(seam, robot) for seam in seams], robot)
    for trajectory in added:
        trajectory.purgeTouched()
    return added


def choose_seams(item: Any, names: Sequence[str], keep_failing: bool = False) -> None:
    """Say which seams come into the programs, in which order; those beyond their limits only with ``keep_failing``.

    Raises
    ------
    InputError : the object has no seam of a name
    """
    unknown = [name for name in names if name not in keys_of(item)]
    if unknown:
        raise InputError(f"{item.Label} has no seam {unknown[0]}: its panel lists those it has.")
    touched = "Touched" in item.State
    item.Programmed, item.KeepFailing = list(names), keep_failing
    if not touched:  # the seams themselves stay as they are
        item.purgeTouched()


def keys_of(item: Any) -> list[str]:
    """The names of the seams, numbered where several have the same."""
    names = [seam["name"] for seam in json.loads(item.Report)["seams"]]
    return [name if names.count(name) == 1 else f"{name} ({names[:k].count(name) + 1})" for k, name in enumerate(names)]


def chosen_names(item: Any) -> list[str]:
    """The seams that come into the programs, in their order: the chosen ones, or all within their limits."""
    keys, seams = keys_of(item), json.loads(item.Report)["seams"]
    chosen = [name for name in item.Programmed if name in keys]
    return chosen or [key for key, seam in zip(keys, seams, strict=True) if item.KeepFailing or not seam["exceeded"]]


def chosen_plan(item: Any, plan: SeamPlan) -> SeamPlan:
    """The plan with the chosen seams alone, in their order; as it is where none were chosen."""
    keys = keys_of(item)
    chosen = [name for name in item.Programmed if name in keys]
    return replace(plan, seams=tuple(plan.seams[keys.index(name)] for name in chosen)) if chosen else plan


def robot_of(item: Any) -> api.RobotSettings:
    """The robot's settings that a Seams object holds (InputError where they make no sense)."""
    tool, base = (api.read_frame_choice(text.strip()) if text.strip() else None for text in (item.Tool, item.Base))
    return api.RobotSettings(tool, base, item.Velocity.Value, item.Approach.Value, item.KeepFailing)


def _plan(item: Any) -> SeamPlan:
    if not is_seams(item):
        raise InputError(f"{item.Label} holds no seams: find the seams of a part first.")
    return wait_for(item.Label, job_of(item).run)


def _chosen_plan(item: Any) -> SeamPlan:
    return chosen_plan(item, _plan(item))


def _nominal_of(part: Any, nominal: Any) -> Any:
    return part.Source if nominal is None and is_as_built(part) else nominal


def _apply(obj: Any, wishes: SeamWishes) -> None:
    settings = wishes.settings
    obj.Edges = [(obj.AsBuilt, wishes.edges)] if wishes.edges else []
    obj.Holders = list(dict.fromkeys([*_holders(obj.AsBuilt), *_holders(obj.Nominal)]))
    obj.Tolerance, obj.Chain, obj.Reverse = wishes.tolerance or 0.0, wishes.chain, settings.reverse
    obj.StartHere = settings.start is not None
    obj.Start = FreeCAD.Vector(*(settings.start or (0.0, 0.0, 0.0)))
    obj.Step, obj.Chord = settings.step, settings.chord
    obj.WorkAngle, obj.TravelAngle = math.degrees(settings.work_angle), math.degrees(settings.travel_angle)
    for name in _LIMITS:
        setattr(obj, _limit_property(name), getattr(wishes.limits, name))


def _holders(part: Any) -> Iterator[Any]:
    """The groups that a part lies in: seams stand in the document's coordinates and follow them too."""
    while part is not None and (part := part.getParentGeoFeatureGroup()) is not None:
        yield part


def _line(points: Array) -> Part.Wire:
    return Part.makePolygon([FreeCAD.Vector(*point) for point in points.tolist()])
