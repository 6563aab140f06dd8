# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the jobs may write: refused before any work is done."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..brep.model_files import Model, model_file
from ..errors import InputError, RefusedError
from ..output import check_writable


def check_outputs(paths: Sequence[str | Path | None], inputs: Sequence[str | Path] = ()) -> None:
    """Refuse destinations that cannot be written, before any work is done.

    Parameters
    ----------
    paths : the files to be written, None for those that are not wanted
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : a folder is not there, two files are one, or one of them is an input
    """
    destinations(paths, inputs)


def check_model_output(path: str | Path, nominal: Model | None = None) -> None:
    """Refuse the name of an as-built model that no exporter knows, or whose format cannot number its edges.

    Parameters
    ----------
    path : of the file to be written
    nominal : the model that it is made from

    Raises
    ------
    InputError : the format is unknown
    RefusedError : it cannot keep the numbers that the ``nominal`` model has
    """
    model_file.check_output(Path(path))
    if nominal is not None:
        model_file.check_numbers(nominal, Path(path))


def step_keeps_numbers(nominal: Model) -> bool:
    """Whether a STEP file can number the edges of an as-built model as the nominal one does."""
    try:
        model_file.check_numbers(nominal, Path("as_built.step"))
    except RefusedError:
        return False
    return True


def destinations(paths: Sequence[str | Path | None], inputs: Sequence[str | Path]) -> dict[int, Path]:
    """The destinations that are wanted, by their position."""
    outputs = {place: Path(path) for place, path in enumerate(paths) if path is not None}
    if len({path.resolve() for path in outputs.values()}) < len(outputs):
        raise InputError("Two outputs have the same name: choose different ones.")
    for path in outputs.values():
        check_writable(path, [Path(item) for item in inputs])
    return outputs
