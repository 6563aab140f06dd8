# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``inspect``: a plan held against a part, by a scan of it or by the as-built model that was made of one."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ..brep import workpiece
from ..brep.model_files import Model
from ..inspection import Inspection, Plan, inspect_shapes, read_plan, write_inspection
from ..inspection.known_errors import known_errors
from ..inspection.sampling import PartPair
from ..registration.request import RegistrationRequest
from ..report.stopwatch import Progress
from ..scan.cloud import PointCloud
from .destinations import step_keeps_numbers
from .inputs import as_cloud, as_model, as_request
from .outputs import write
from .registering import Result, run


@dataclass(frozen=True)
class InspectedPart:
    """An inspected part.

    Attributes
    ----------
    inspection : values and verdicts
    nominal : the nominal model
    result : the registration that it rests on, where there was a scan
    """

    inspection: Inspection
    nominal: Model
    result: Result | None = None

    def table(self) -> str:
        """As text."""
        return self.inspection.table()


def inspect(model: Model | Part.Shape | str | Path | object, scan: PointCloud | np.ndarray | str | Path,
            plan: Plan | str | Path, progress: Progress = lambda text: None, **settings: Any) -> InspectedPart:
    """Register a scan and hold a plan against what it shows.

    ``api.inspect("part.step", "scan.ply", "plan.json").table()`` says what passes.

    Parameters
    ----------
    model, scan : as for ``register``
    plan : a plan, or its file
    progress : called with what is being done
    settings : as for ``register``

    Raises
    ------
    InputError, RefusedError : as ``register``, and where the plan does not go with the model
    """
    return inspect_scan(as_request(**settings), model, scan, plan, progress)


def inspect_scan(request: RegistrationRequest, model: Model | Part.Shape | str | Path | object,
                 scan: PointCloud | np.ndarray | str | Path, plan: Plan | str | Path,
                 progress: Progress = lambda text: None) -> InspectedPart:
    """Do what `inspect` is asked for. Raises as it does.

    Parameters
    ----------
    request : how the scan is registered
    model, scan, plan, progress : as for `inspect`
    """
    wanted = as_plan(plan)
    result = run(request, model, as_cloud(scan), progress)
    return inspect_result(result, wanted, progress)


def inspect_result(result: Result, plan: Plan, progress: Progress = lambda text: None) -> InspectedPart:
    """Hold a plan against a registration's result.

    Parameters
    ----------
    result : what ``register`` gave
    plan : what is to be inspected
    progress : called with what is being done

    Raises
    ------
    InputError : the plan does not go with the model
    """
    faces = () if result.joint is None else result.joint.faces
    known = known_errors(result.figures, faces)
    return InspectedPart(inspect_shapes(plan, PartPair(result.part, workpiece.read(result.shape), known), progress),
                         result.nominal, result)


def inspect_model(model: Model | Part.Shape | str | Path | object, as_built: Model | Part.Shape | str | Path | object,
                  plan: Plan | str | Path, report: Any = None, progress: Progress = lambda text: None) -> InspectedPart:
    """Hold a plan against an as-built model.

    Parameters
    ----------
    model : the nominal one
    as_built : with the same faces and edges
    plan : a plan, or its file
    report : of the registration that made ``as_built``, as JSON has it; None takes the model as exact
    progress : called with what is being done

    Raises
    ------
    InputError : the models do not go together, or the plan not with them
    """
    wanted, nominal = as_plan(plan), as_model(model)
    pair = PartPair(workpiece.read(nominal.shape), workpiece.read(as_model(as_built).shape), known_errors(report))
    return InspectedPart(inspect_shapes(wanted, pair, progress), nominal)


def write_inspected(found: InspectedPart, folder: Path, inputs: tuple[Path, ...] = ()) -> None:
    """Write an inspection, and the as-built model and report that it rests on, into a folder that exists.

    Parameters
    ----------
    found : the inspection
    folder : where to
    inputs : files that were read and must not be written over

    Raises
    ------
    RefusedError : the disk is full
    """
    more: tuple[str, ...] = ()
    if found.result is not None:
        more = ("as_built.step" if step_keeps_numbers(found.nominal) else "as_built.brep", "report.json")
        write(found.result, folder / more[0], folder / more[1], inputs=inputs)
    write_inspection(found.inspection, folder, f"Inspection of {found.nominal.label}", more)


def as_plan(plan: Plan | str | Path) -> Plan:
    """A plan, or the one in a file (InputError where there is none)."""
    return plan if isinstance(plan, Plan) else read_plan(plan)
