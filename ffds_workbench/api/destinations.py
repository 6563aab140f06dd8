# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the jobs may write: refused before any work is done."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..brep.model_files import model_file
from ..errors import InputError
from ..output import check_writable


def check_outputs(paths: Sequence[str | Path | None], inputs: Sequence[str | Path] = ()) -> None:
    """Refuse destinations that cannot be written, before any work is done (InputError)."""
    destinations(paths, inputs)


def check_model_output(path: str | Path) -> None:
    """Refuse the name of an as-built model that no exporter knows (InputError)."""
    model_file.check_output(Path(path))


def destinations(paths: Sequence[str | Path | None], inputs: Sequence[str | Path]) -> dict[int, Path]:
    """The destinations that are asked for, by their place."""
    outputs = {place: Path(path) for place, path in enumerate(paths) if path is not None}
    if len({path.resolve() for path in outputs.values()}) < len(outputs):
        raise InputError("Two outputs have the same name: choose different ones.")
    for path in outputs.values():
        check_writable(path, [Path(item) for item in inputs])
    return outputs
