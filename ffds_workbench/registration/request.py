# SPDX-License-Identifier: LGPL-2.1-or-later
"""The settings of a registration, besides the model and the scan. Loads no mathematics: the command line starts fast.

The command line, `api.register`, the document object and the live preview all pass on the same request, and it is
checked here, once. What depends on the model, such as whether it has a Face9, is checked where the two meet.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..errors import InputError

if TYPE_CHECKING:
    from .joint import SensorProfile

METHODS = ("robust", "ffds", "ffd-hsu")
ISOMETRY = ("auto", "on", "off")
ALIGNMENTS = ("fine", "global")
ALIGN = ("none", *ALIGNMENTS)
LEAST_CONTROL_POINTS = 4
"""In each direction (theory: a cubic has four)."""
LEAST_SOURCE_POINTS = 16
"""On a face (theory: as many as the control points of the smallest lattice)."""
STIFFEST = 1e4
"""Stiffness may be up to this, or down to its inverse (unit: beyond it nothing changes)."""

Lattice = tuple[int, int] | str


@dataclass(frozen=True)
class RegistrationRequest:
    """How a part is to be deformed to a scan.

    Attributes
    ----------
    faces : names like "Face6", numbered as FreeCAD numbers the shape, each registered by itself; None for the whole
        part: all faces together with "robust", every face that the scan observes by itself with the other methods
    method : "robust", "ffds" for the published algorithm, or "ffd-hsu" for a lattice in space around each face
    lattice : (N_i, N_j) control points per face, or "auto"; "ffd-hsu" then takes 10 × 10
    freeze : names of faces that must not move
    source_points : of methods "ffds" and "ffd-hsu", on each face
    isometry : of a whole sheet part: "on" holds it inextensible, "off" does not, "auto" decides from the strain found
    stiffness : of "robust": multiplies the bending energy; above 1 the displacement is smoother, below 1 it follows the
        scan more closely
    gate : of "robust": scan points farther than this from the as-built surface are outliers, in mm, though never nearer
        than the noise asks for; None for the default
    sensor : of the whole part: separates correlated noise from shape, so that bands are honest. None: white noise
    align : the scan is brought onto the model first: "none", "fine" from where it lies, "global" from anywhere

    Raises
    ------
    InputError : a setting is unknown or makes no sense, or does not go with another one
    """

    faces: tuple[str, ...] | None = None
    method: str = "robust"
    lattice: Lattice = "auto"
    freeze: tuple[str, ...] = ()
    source_points: int = 400
    isometry: str = "auto"
    stiffness: float = 1.0
    gate: float | None = None
    sensor: SensorProfile | None = None
    align: str = "none"

    @property
    def counts(self) -> tuple[int, int] | None:
        """(N_i, N_j) control points per face, None where the method is to find them."""
        return None if isinstance(self.lattice, str) else self.lattice

    @property
    def together(self) -> bool:
        """Whether all faces are registered in one solve, and not each by itself."""
        return self.faces is None and self.method == "robust"

    def __post_init__(self) -> None:
        _check_choices(self)
        _check_numbers(self)
        _check_faces(self)
        _check_combination(self)


def _check_choices(request: RegistrationRequest) -> None:
    if request.method not in METHODS:
        raise InputError(f"The method '{request.method}' is unknown: use one of {', '.join(METHODS)}.")
    if request.isometry not in ISOMETRY:
        raise InputError(f"The isometry '{request.isometry}' is unknown: use one of {', '.join(ISOMETRY)}.")
    if request.align not in ALIGN:
        raise InputError(f"The alignment '{request.align}' is unknown: use one of {', '.join(ALIGN)}.")


def _check_numbers(request: RegistrationRequest) -> None:
    lattice, stiffness, gate = request.lattice, request.stiffness, request.gate
    if lattice != "auto" and (isinstance(lattice, str) or len(lattice) != 2 or min(lattice) < LEAST_CONTROL_POINTS):
        raise InputError(f"The lattice {lattice} is unknown or too small: a cubic lattice has 4 or more control points "
                         f"in each direction, for instance 10x10.")
    if request.source_points < LEAST_SOURCE_POINTS:
        raise InputError(f"{request.source_points} source points are too few: {LEAST_SOURCE_POINTS} are the least.")
    if not 1 / STIFFEST <= stiffness <= STIFFEST:
        raise InputError(f"The stiffness {stiffness:g} makes no sense: 1 is the default, use {1 / STIFFEST:g} to "
                         f"{STIFFEST:g}.")
    if gate is not None and not (math.isfinite(gate) and gate > 0):
        raise InputError(f"Outliers beyond {gate:g} mm make no sense: give a distance above 0.")


def _check_faces(request: RegistrationRequest) -> None:
    if request.faces is not None and not request.faces:
        raise InputError("No face was named.")
    both = [name for name in request.faces or () if name in request.freeze]
    if both:
        raise InputError(f"{both[0]} is to be deformed and to be frozen: choose one.")


def _check_combination(request: RegistrationRequest) -> None:
    method, together = request.method, request.together
    if method != "robust" and (request.stiffness, request.gate) != (1.0, None):
        raise InputError(f"Stiffness and outliers are settings of method robust, not of {method}: leave them out.")
    if together and request.lattice != "auto":
        raise InputError("All faces together take their lattices from the data: name a face to choose its lattice.")
    if not together and request.isometry != "auto":
        raise InputError("Isometry couples all faces of a sheet: it needs method robust without named faces.")
    if not together and request.sensor is not None:
        raise InputError("A sensor profile is for the whole part: it needs method robust without named faces.")
