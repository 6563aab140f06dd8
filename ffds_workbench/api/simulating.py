# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``simulate``: a scan of a model by the virtual sensor."""
from __future__ import annotations

import Part

from ..brep.files import Model
from ..brep.simulation import Simulation, simulate_shape
from ..scan.sensor import SensorSettings
from .inputs import as_model


def simulate(model: Model | Part.Shape | object, settings: SensorSettings | None = None) -> Simulation:
    """Scan a model with the virtual sensor: ``.scan.points`` (n, 3) in mm, and ``.truth``.

    ``SensorSettings(views=(View((0, 0, 1)),), noise=0.13, seed=1)`` is one shot from above.

    Raises
    ------
    InputError, RefusedError : the model cannot be used, or the views see nothing of it
    """
    return simulate_shape(as_model(model).shape, settings or SensorSettings())
