# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``simulate``: a scan of a model by the virtual sensor, and its files."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import Part

from ..brep.model_files import Model
from ..brep.simulated_scan import Simulation, simulate_shape
from ..output import replacing
from ..scan.sensor import SensorSettings
from ..scan.sensor.files import write_ply
from .destinations import destinations
from .inputs import as_model


def simulate(model: Model | Part.Shape | object, settings: SensorSettings | None = None) -> Simulation:
    """Scan a model with the virtual sensor: ``.scan.points`` (n, 3) in mm, and ``.truth``.

    ``SensorSettings(views=(View((0, 0, 1)),), noise=0.13, seed=1)`` is one shot from above.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    settings : of the sensor and its views; by default from all sides

    Raises
    ------
    InputError, RefusedError : the model cannot be used, or the views see nothing of it
    """
    return simulate_shape(as_model(model).shape, settings or SensorSettings())


def write_simulation(simulation: Simulation, out: str | Path, truth: str | Path | None = None,
                     inputs: Sequence[str | Path] = ()) -> None:
    """Write a simulated scan and its truth: both or none. Raises as `write` does.

    Parameters
    ----------
    simulation : what `simulate` gave
    out, truth : files, .ply and .npz
    inputs : files that were read and must not be written over
    """
    outputs = destinations((out, truth), inputs)
    with replacing(*outputs.values()) as temporary:
        write_ply(temporary[0], simulation.scan.points)
        if truth is not None:
            simulation.truth.write(temporary[1])
