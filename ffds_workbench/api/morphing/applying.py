# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``morph``: a model deformed by a displacement field, with its topology kept."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ...brep import workpiece
from ...brep.folding import refuse_folds
from ...brep.model_files import Model
from ...errors import InputError
from ...fields import VectorField, Morphing, displacements
from ...report import record, table
from ...report.stopwatch import Progress, Stopwatch
from ...registration.arrays import Array
from ..certified import CertifiedModel, certified
from ..inputs import as_model
from .taking import as_field

_LISTED = 200
"""Vectors out of tolerance that the report names, worst first (unit: what one reads)."""


@dataclass(frozen=True)
class MorphedModel(CertifiedModel):
    """A model deformed by a field.

    Attributes
    ----------
    field : of the nominal model
    morphing : what it did
    factor : that it was multiplied with
    tolerance : in mm, how closely vectors had to be followed; None where none was given
    """

    field: VectorField
    morphing: Morphing
    factor: float
    tolerance: float | None

    @property
    def beyond(self) -> Array:
        """Vectors that the field in space misses by more than the tolerance, worst first: (n, 4) of x, y, z and the
        distance."""
        misses = self.morphing.misses
        worst = misses.beyond(np.inf if self.tolerance is None else self.tolerance)
        return np.column_stack([misses.positions[worst], misses.distance[worst]])

    @property
    def report(self) -> dict[str, Any]:
        """The JSON report as a dictionary; waits for the check for Boolean operations."""
        misses, beyond = self.morphing.misses, self.beyond
        names = [f"Face{index + 1}" for index in sorted(self.morphing.displacements)]
        return {"field": {"vectors": len(self.field), "ignored": int(misses.ignored.sum()), "factor": self.factor,
                          "largest": self.morphing.largest, "moved": names, "tolerance": self.tolerance,
                          "misses": record.figures(misses.distance[~misses.ignored]),
                          "out_of_tolerance": {"count": len(beyond), "worst": beyond[:_LISTED].round(5).tolist()}},
                "topology": self.certificate.as_dict(), "timing": self.watch.times()}

    def table(self) -> str:
        """What was done, as text."""
        misses, beyond = self.morphing.misses, self.beyond
        used = misses.distance[~misses.ignored]
        lines = [f"Field        {len(self.field)} vectors, {int(misses.ignored.sum())} ignored; up to "
                 f"{self.morphing.largest:.4g} mm applied with factor {self.factor:g}",
                 f"Followed     to {used.mean():.2e} mm in the mean, {used.max():.2e} mm at worst"]
        if self.tolerance is not None:
            lines.append(f"Tolerance    {len(beyond)} vectors are missed by more than {self.tolerance:g} mm"
                         + (f", the worst at {', '.join(f'{x:.2f}' for x in beyond[0, :3])}" if len(beyond) else ""))
        return "\n".join(lines) + "\n\n" + table.topology_table(self.certificate.as_dict())


def morph(model: Model | Part.Shape | str | Path | Any, field: VectorField | str | Path, factor: float = 1.0,
          tolerance: float | None = None, ignore: float = 0.0, progress: Progress | None = None) -> MorphedModel:
    """Deform a model by a field; the topology stays.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    field : of the model, or the file of one
    factor : that it is multiplied with: −1 for the reverse, 0 for the nominal model
    tolerance : in mm; the vectors that the field in space, before the factor, misses by more are told. The faces
        follow that to a hundredth of a micrometre; the written model is certified by itself
    ignore : share of the vectors that may be left out, those that agree least with the others
    progress : called with what is being done

    Raises
    ------
    InputError : the model or the field cannot be read or do not go together
    RefusedError : a face would fold over, or the result would not be valid
    """
    if tolerance is not None and not tolerance > 0:
        raise InputError(f"A tolerance of {tolerance:g} mm makes no sense: give one above 0.")
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model and the field"):
        nominal, vectors = as_model(model), as_field(field)
        part = workpiece.read(nominal.shape)
    with watch.stage("morph", "Following the field"):
        found = displacements(part, vectors, factor, ignore)
        refuse_folds(part, found.displacements)
    built = certified(nominal, part, found.displacements, watch)
    return MorphedModel(built.model, built.nominal, built.structures, built.checks, watch, vectors, found, factor,
                        tolerance)
