# SPDX-License-Identifier: LGPL-2.1-or-later
"""The as-built seam against the nominal one, station by station.

The topology is the same, so EdgeN is EdgeN; a station is paired with the nominal point at the same place of the edge.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array
from .frames import rotation_between
from .pairing import paired_fractions
from .sampling import Places
from .settings import SeamSettings
from .stations import Stations, stations_at
from .weldment import Weldment


@dataclass(frozen=True)
class Offsets:
    """How the as-built seam differs from the nominal, (n,) each, in the nominal's bisector frame.

    Attributes
    ----------
    lateral : along y = z × x, in mm
    normal : away from the joint, against the approach z, in mm
    longitudinal : along the travel direction, in mm
    opening_change : of the angle between the faces, in rad; positive where they open
    rotation : angle between both bisector frames in rad
    """

    lateral: Array
    normal: Array
    longitudinal: Array
    opening_change: Array
    rotation: Array


def check_pair(nominal: Weldment, as_built: Weldment) -> None:
    """Refuse two models neither of which is the other one deformed (InputError)."""
    a, b = nominal.topology, as_built.topology
    for kind in ("faces", "edges", "vertices"):
        if a.counts[kind] != b.counts[kind]:
            raise InputError(f"The nominal model has {a.counts[kind]} {kind} and the as-built one {b.counts[kind]}: "
                             "name the nominal model from which the as-built one was made.")
    if a.edge_faces != b.edge_faces:
        raise InputError("The nominal and the as-built model are put together differently: name the nominal model from "
                         "which the as-built one was made.")


def nominal_stations(nominal: Weldment, as_built: Weldment, stations: Stations, settings: SeamSettings) -> Stations:
    """The nominal seam at the places that the as-built stations came from."""
    places = stations.places
    fraction = places.fraction.copy()
    for number, stretch in enumerate(stations.seam.stretches):
        here = places.stretch == number
        fraction[here] = paired_fractions(as_built, nominal, stretch.edge, fraction[here])
    return stations_at(nominal, stations.seam, Places(places.stretch, fraction, places.arc_length), settings)


def offsets(nominal: Stations, as_built: Stations) -> Offsets:
    """Compare paired stations."""
    x, y, z = (nominal.bisector[:, :, axis] for axis in range(3))
    moved = as_built.positions - nominal.positions
    lateral, normal, longitudinal = (np.einsum("ij,ij->i", moved, axis) for axis in (y, -z, x))
    return Offsets(lateral, normal, longitudinal, as_built.opening - nominal.opening,
                   rotation_between(nominal.bisector, as_built.bisector))
