# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``sensor measure``: the noise of a sensor, from a flat datum or from repeated scans."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..output import replacing
from ..registration.joint import SensorProfile
from ..scan import sensor_profile
from ..scan.cloud import PointCloud
from ..scan.sensor_noise import measure
from .destinations import destinations
from .inputs import as_cloud


def measure_sensor(scans: Sequence[PointCloud | np.ndarray], flat: bool = False, name: str = "measured"
                   ) -> SensorProfile:
    """The noise of a sensor: white, and what neighbouring points share.

    Parameters
    ----------
    scans : one of a flat datum; or several of the same thing from the same place, where nothing moved in between
    flat : several scans are of flat datums too
    name : of the sensor, for reports

    Raises
    ------
    RefusedError : too few points, no plane, or scans that do not show the same thing
    """
    return measure([as_cloud(scan).points for scan in scans], flat, name)


def write_sensor(profile: SensorProfile, out: str | Path, inputs: Sequence[str | Path] = ()) -> None:
    """Write a profile as JSON. Raises as `write` does.

    Parameters
    ----------
    profile : what `measure_sensor` gave
    out : the file, .json
    inputs : files that were read and must not be written over
    """
    outputs = destinations([out], inputs)
    with replacing(*outputs.values()) as temporary:
        sensor_profile.write(profile, temporary[0])
