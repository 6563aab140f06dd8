# SPDX-License-Identifier: LGPL-2.1-or-later
"""A model that was made from a nominal one, and the certificate of what it kept."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import Part

from ..brep.face_displacement import FaceDisplacement
from ..brep.model_files import Model
from ..brep.rebuild import rebuild
from ..brep.workpiece import Workpiece
from ..report.boolean_check import BooleanChecks
from ..report.certificate import Certificate, Structure, condition, enforce, structure
from ..report.stopwatch import Stopwatch

BOOLEAN_CHECK_SECONDS = 10.0
"""Processor time that the check of a shape for Boolean operations, which runs beside the other work, may take before
the certificate goes without it: it can take minutes. Only what asks for the certificate waits for it, not the model
(unit: what one waits for a report)."""
REBUILD_TOLERANCE = 1e-5
"""Largest distance in mm of a rebuilt face from the nominal surface plus its displacement (unit: far below the noise of
scanners; looser than `rebuild` is by itself, and faster)."""


@dataclass(frozen=True)
class CertifiedModel:
    """A deformed model whose topology is certified.

    Attributes
    ----------
    model : the deformed shape with the nominal's name and colours
    nominal : what it was made from
    structures : what the deformed shape had to keep, of the nominal and of itself
    checks : for Boolean operations, of the nominal and of the deformed shape
    watch : how long what took
    """

    model: Model
    nominal: Model
    structures: tuple[Structure, Structure]
    checks: BooleanChecks
    watch: Stopwatch

    @property
    def shape(self) -> Part.Shape:
        """The deformed shape."""
        return self.model.shape

    @cached_property
    def unchecked(self) -> Certificate:
        """Topology before and after, without the check for Boolean operations: waits for nothing."""
        before, after = (condition(shape, known=known) for shape, known in
                         zip((self.nominal.shape, self.shape), self.structures, strict=True))
        return Certificate(before, after)

    @cached_property
    def certificate(self) -> Certificate:
        """Topology before and after; waits for the check for Boolean operations."""
        before, after = self.unchecked.before, self.unchecked.after
        errors = self.checks.errors()
        return Certificate(replace(before, boolean_check=errors[0]), replace(after, boolean_check=errors[1]))


def certified(nominal: Model, part: Workpiece, displacements: Mapping[int, FaceDisplacement], watch: Stopwatch
              ) -> CertifiedModel:
    """The nominal model with its faces displaced, once its topology is found to be kept.

    Parameters
    ----------
    nominal : the model
    part : its faces
    displacements : by index, of every face that moves
    watch : that times the stages

    Raises
    ------
    RefusedError : the result would not be valid, or would have lost something
    """
    with watch.stage("rebuild", "Rebuilding the model"):
        shape = rebuild(part, displacements, REBUILD_TOLERANCE)
    checks = BooleanChecks(BOOLEAN_CHECK_SECONDS)
    checks.begin(nominal.shape, keep=True)
    checks.begin(shape)
    with watch.stage("certify", "Checking the topology"):
        structures = structure(nominal.shape), structure(shape)
        enforce(*structures)
    return CertifiedModel(replace(nominal, shape=shape), nominal, structures, checks, watch)
