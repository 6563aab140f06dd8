# SPDX-License-Identifier: LGPL-2.1-or-later
"""The settings of scan preparation, and its result."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ..cloud import PointCloud


@dataclass(frozen=True)
class PartSurface:
    """The part that a scan is cropped to: vertices (n, 3) in mm and the triangles (m, 3) between them."""

    vertices: Array
    triangles: np.ndarray


@dataclass(frozen=True)
class PreparationSettings:
    """The steps, in the order in which they are done; none is done unless it is asked for.

    Attributes
    ----------
    poses : one motion (4, 4) per scan into the common frame, in mm; refined against each other
    box : lowest and highest x, y, z of what is kept, mm
    near : how far from the part a point is kept, mm
    remove_plane, remove_clutter, remove_outliers : the table and what is behind it; things that stand apart; single
        points
    normals : estimate them, towards the sensor
    view : where the sensor was, mm; by default at the origin of each scan's own coordinates
    spacing : edge of the cubes whose points are averaged, mm

    Raises
    ------
    InputError : a length is not positive, or settings contradict each other
    """

    poses: tuple[Array, ...] | None = None
    box: tuple[float, float, float, float, float, float] | None = None
    near: float | None = None
    remove_plane: bool = False
    remove_clutter: bool = False
    remove_outliers: bool = False
    normals: bool = False
    view: tuple[float, float, float] | None = None
    spacing: float | None = None

    def __post_init__(self) -> None:
        for name, length in (("spacing", self.spacing), ("distance from the model", self.near)):
            if length is not None and not 0.0 < length < np.inf:
                raise InputError(f"The {name} is a length above 0 mm, not {length:g}.")
        if self.box is not None and not np.less(self.box[:3], self.box[3:]).all():
            raise InputError("A box is X0,Y0,Z0,X1,Y1,Z1, the lower corner first: each of X0,Y0,Z0 must be below its "
                             "X1,Y1,Z1.")
        if self.view is not None and not self.normals:
            raise InputError("A view point is for normals: ask for them too (--normals).")

    @property
    def any_step(self) -> bool:
        """Whether anything is asked for."""
        return self != PreparationSettings()


@dataclass(frozen=True)
class PreparationStep:
    """One step: its name, how many points there were before it, those after it (n, 3) in the scan's coordinates, and
    what it found, for the report."""

    name: str
    before: int
    points: Array = field(repr=False)
    found: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""

    @property
    def after(self) -> int:
        """How many points the step has left."""
        return len(self.points)

    def as_dict(self) -> dict[str, Any]:
        """As the report has it."""
        return {"name": self.name, "before": self.before, "after": self.after, **self.found,
                **({"note": self.note} if self.note else {})}


@dataclass(frozen=True)
class PreparedScan:
    """A scan that was prepared.

    Attributes
    ----------
    scan : in the coordinates of the scan that was given, or in the poses' common frame
    steps : what was done
    spacing : distance to the nearest other point that nine of ten points keep, before and after, mm
    """

    scan: PointCloud
    steps: tuple[PreparationStep, ...]
    spacing: tuple[float, float]

    def table(self) -> str:
        """The steps as a table."""
        rows = [f"{'step':<12}{'points before':>14}{'after':>12}"]
        rows += [f"{step.name:<12}{step.before:>14,}{step.after:>12,}" + (f"  {step.note}" if step.note else "")
                 for step in self.steps]
        return "\n".join([*rows, f"spacing {self.spacing[0]:.3g} mm → {self.spacing[1]:.3g} mm"])
