# SPDX-License-Identifier: LGPL-2.1-or-later
"""The kinds of files that are damaged, and the one at a place of each kind's endless series."""
from __future__ import annotations

import tempfile
import zlib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np

from ... import ROOT
from . import mutations, seeds

BAD = ROOT.parent / "shared" / "data" / "bad"
"""Damaged files beside the project, where there are any: further seeds."""
MODELS = (".step", ".iges", ".brep", ".FCStd")


def in_process() -> list[str]:
    """Kinds that are read by the worker itself: scans, then taught paths."""
    return [f"scan {name}" for name in seeds.scans()] + [f"path {name}" for name in seeds.paths()]


def by_command() -> list[str]:
    """Kinds that are given to the command line: models."""
    return [f"model {suffix}" for suffix in MODELS]


def suffix(kind: str) -> str:
    """Of a file of this kind."""
    return "." + kind.rpartition(".")[2]


@cache
def contents(kind: str) -> Sequence[bytes]:
    """The sound files of a kind, and those beside the project that are of its format."""
    family, _, name = kind.partition(" ")
    own = {"scan": seeds.scans, "path": seeds.paths, "model": _models}[family]()[name]
    found = sorted(BAD.glob("*")) if BAD.is_dir() and family != "path" else []
    return [*own, *(path.read_bytes() for path in found if path.suffix.lower() == suffix(kind).lower())]


def damaged(kind: str, index: int, seed: int) -> bytes:
    """The ``index``-th damaged file of a kind, always the same."""
    random = np.random.default_rng([seed, zlib.crc32(kind.encode()), index])
    own = contents(kind)
    return mutations.mutated(own[index % len(own)], _others(kind), random)


@cache
def _others(kind: str) -> Sequence[bytes]:
    """The files that pieces may come from."""
    own = contents(kind)
    return own if kind.startswith("model") else [*own, *(item for group in seeds.scans().values() for item in group)]


def _models() -> Mapping[str, list[bytes]]:
    """By suffix, a plate with a bore and a rounded edge."""
    import FreeCAD
    import Part

    from ...brep.model_files import Model, model_file

    plate = seeds.plate()
    rounded = plate.makeFillet(3.0, [plate.Edges[0]])
    shape = rounded.cut(Part.makeCylinder(8.0, 20.0, FreeCAD.Vector(50.0, 50.0, -10.0)))
    with tempfile.TemporaryDirectory() as folder:
        files = {suffix: Path(folder) / f"plate{suffix}" for suffix in MODELS}
        for suffix, path in files.items():
            if suffix == ".iges":
                shape.exportIges(str(path))
            elif suffix == ".step":
                shape.exportStep(str(path))  # which numbers it anew
            else:
                model_file.write(Model(shape, "Plate"), path)
        return {suffix: [path.read_bytes()] for suffix, path in files.items()}
