# SPDX-License-Identifier: LGPL-2.1-or-later
"""What morphing and compensating leave behind: files that appear whole or not at all."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...output import replacing
from ...report import record
from ...report.file_certificate import FileCertificate
from ..destinations import check_model_output, destinations
from ..outputs import write_certified
from .applying import MorphedModel
from .compensating import CompensatedModel


def write_deformed(result: MorphedModel | CompensatedModel, out: str | Path, report: str | Path | None = None,
                   inputs: Sequence[str | Path] = ()) -> FileCertificate:
    """Write a deformed model, read back and certified, and after it its report.

    Parameters
    ----------
    result : what `morph` or `compensate` gave
    out, report : files: .step, .brep or .FCStd, and .json
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : a destination cannot be written or is one of ``inputs``
    RefusedError : the disk is full, or the file would not hold the same model
    """
    check_model_output(out)
    outputs = destinations((out, report), inputs)
    certificate = write_certified(result, outputs[0])
    if report is not None:
        with replacing(outputs[1]) as temporary:
            found = result.report
            record.write(found | {"topology": found["topology"] | {"written": certificate.as_dict()}}, temporary[0])
    return certificate
