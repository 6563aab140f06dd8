# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``compensate``: the model of the tool that makes the next part come out as the nominal one.

Parts that came out of a tool deviate from the nominal model by a field each. What is common to them is the tool's to
mend; what scatters is not. The next tool is the one that made them plus the factor times their mean deviation: with
factor −1 the displacement-adjustment method of Gan and Wagoner (International Journal of Mechanical Sciences 46, 2004).
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ...brep import workpiece
from ...brep.folding import refuse_folds
from ...brep.model_files import Model
from ...brep.workpiece import Workpiece
from ...errors import InputError, RefusedError
from ...fields.combination import Displacements, PlacesOnFace, at_places, between_models, places_of, weighted_sum
from ...fields.operations import largest_scatter
from ...registration.arrays import Array
from ...registration.request import RegistrationRequest
from ...report import record, table
from ...report.stopwatch import Progress, Stopwatch
from ...scan.cloud import PointCloud
from ..certified import CertifiedModel, certified
from ..inputs import as_cloud, as_model, as_request, as_workpiece, check_place
from ..methods import find_deformation
from ..placing import align_scan

Scans = Sequence[PointCloud | np.ndarray | str | Path]


@dataclass(frozen=True)
class ToolTrial:
    """The parts that came out of one tool.

    Attributes
    ----------
    deviations : displacements of the nominal faces into each part's
    common : per face, (n, 3) their mean at the places of the face, in mm
    scatter : per face, (n,) standard deviation in mm of one part about the mean; 0 of a single part
    """

    deviations: tuple[Displacements, ...]
    common: tuple[Array, ...]
    scatter: tuple[Array, ...]

    @property
    def size(self) -> float:
        """Root mean square of the common deviation in mm."""
        return float(np.sqrt((np.concatenate(self.common) ** 2).sum(axis=1).mean()))


@dataclass(frozen=True)
class CompensatedModel(CertifiedModel):
    """A tool that makes up for what its parts deviate by.

    Attributes
    ----------
    trial : the parts that came out of the tool before it
    earlier : those of the tool before that, where they were given
    factor : of their mean deviation
    applied : per face, (n, 3) displacement of the nominal model into the tool at the places of the face, in mm
    exchanged : whether ``previous_scans`` turned out to be what came out of the previous tool
    """

    trial: ToolTrial
    earlier: ToolTrial | None
    factor: float
    applied: tuple[Array, ...]
    exchanged: bool

    @property
    def report(self) -> dict[str, Any]:
        """The JSON report as a dictionary; waits for the check for Boolean operations."""
        faces = [{"name": f"Face{number}", "common": _sizes(common), "scatter": record.figures(scatter),
                  "applied": _sizes(applied)} for number, (common, scatter, applied) in
                 enumerate(zip(self.trial.common, self.trial.scatter, self.applied, strict=True), 1)]
        return {"compensation": {"parts": len(self.trial.deviations), "factor": self.factor, "faces": faces,
                                 "common": _sizes(np.concatenate(self.trial.common)),
                                 "scatter": record.figures(np.concatenate(self.trial.scatter)),
                                 "applied": _sizes(np.concatenate(self.applied)),
                                 "earlier": None if self.earlier is None else
                                 _sizes(np.concatenate(self.earlier.common))},
                "topology": self.certificate.as_dict(), "timing": self.watch.times()}

    def table(self) -> str:
        """What was found and done, as text."""
        trial = self.trial
        common, applied = (np.linalg.norm(np.concatenate(rows), axis=1) for rows in (trial.common, self.applied))
        scatter = np.sqrt((np.concatenate(trial.scatter) ** 2).mean())
        told = f"scatter {scatter:.3f} mm rms" if len(trial.deviations) > 1 else "one part does not tell the scatter"
        lines = [f"Parts        {len(trial.deviations)}: common deviation {trial.size:.3f} mm rms, {common.max():.3f} "
                 f"mm at most; {told}"]
        if self.earlier is not None:
            lines.append(f"Before       {self.earlier.size:.3f} mm rms")
        if self.exchanged:
            lines.append("Note         the parts of --previous-scan are nearer to the nominal model: they are taken as "
                         "what came out of the previous tool")
        lines.append(f"Tool         up to {applied.max():.3f} mm off the nominal model, with factor {self.factor:g}")
        return "\n".join(lines) + "\n\n" + table.topology_table(self.certificate.as_dict())


def compensate(model: Model | Part.Shape | str | Path | Any, scans: Scans, factor: float = -1.0,
               previous: Model | Part.Shape | str | Path | Any | None = None, previous_scans: Scans = (),
               progress: Progress | None = None, **settings: Any) -> CompensatedModel:
    """The tool that makes the next part come out as the nominal model; the topology stays.

    Parameters
    ----------
    model : the nominal model: a `Model`, a file, a shape or a document object
    scans : one of each part, in mm and on the nominal model unless ``align`` is asked for
    factor : of their mean deviation; −1 turns it round
    previous : the tool that the parts came out of; None if it was the nominal model
    previous_scans : of the parts of one more trial. Of the two trials, the one that is nearer to the nominal model is
        taken as what came out of the previous tool
    progress : called with what is being done
    settings : ``freeze``, ``isometry``, ``stiffness``, ``gate``, ``sensor`` and ``align``, as for `register`

    Raises
    ------
    InputError : a file cannot be read, or settings make no sense
    RefusedError : a part cannot be registered, or the tool would fold over or not be valid
    """
    if not np.isfinite(factor) or not scans:
        raise InputError("A compensation needs one scan or more, and a factor that is a number.")
    if previous_scans and previous is None:
        raise InputError("Scans of a previous trial need the tool that made it: name it with --previous.")
    request = as_request(None, **settings)
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the models"):
        nominal = as_model(model)
        part = as_workpiece(nominal.shape)
        tool = {} if previous is None else between_models(part, workpiece.read(as_model(previous).shape))
        places = places_of(part)
    trial = _trial(nominal, part, places, scans, request, watch)
    earlier = _trial(nominal, part, places, previous_scans, request, watch) if previous_scans else None
    exchanged = earlier is not None and earlier.size < trial.size
    if exchanged and earlier is not None:
        trial, earlier = earlier, trial
    share = factor / len(trial.deviations)
    moved = weighted_sum([(1.0, tool), *((share, one) for one in trial.deviations)])
    try:
        refuse_folds(part, moved)
    except RefusedError as fold:
        raise RefusedError(f"The tool cannot be made: {fold}") from fold
    built = certified(nominal, part, moved, watch)
    return CompensatedModel(built.model, nominal, built.structures, built.checks, watch, trial, earlier, factor,
                            tuple(at_places(moved, places)), exchanged)


def _trial(nominal: Model, part: Workpiece, places: list[PlacesOnFace], scans: Scans, request: RegistrationRequest,
           watch: Stopwatch) -> ToolTrial:
    """Register the parts of a trial, each by itself."""
    deviations = []
    for number, scan in enumerate(scans, 1):
        cloud = as_cloud(scan)
        if request.align != "none":
            cloud = align_scan(nominal, cloud, request.align).scan
        check_place(cloud, nominal)
        watch.tell(f"Registering part {number} of {len(scans)}")
        deviations.append(find_deformation(part, cloud, request, watch).displacements)
    values = [at_places(one, places) for one in deviations]
    common = tuple(np.mean(rows, axis=0) for rows in zip(*values, strict=True))
    return ToolTrial(tuple(deviations), common, tuple(map(_scatter, zip(*values, strict=True))))


def _scatter(values: Sequence[Array]) -> Array:
    """Standard deviation of vectors (n, 3) of several parts, along the direction in which it is largest: (n,)."""
    if len(values) == 1:
        return np.zeros(len(values[0]))
    return largest_scatter(np.array(values))


def _sizes(vectors: Array) -> dict[str, float] | None:
    """Figures of the lengths of vectors (n, 3)."""
    return record.figures(np.linalg.norm(vectors, axis=1))
