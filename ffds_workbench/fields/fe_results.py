# SPDX-License-Identifier: LGPL-2.1-or-later
"""Displacements of the nodes of finite-element results: CalculiX and VTK by FreeCAD's readers, universal files here.

FreeCAD reads universal files (.unv) for their mesh alone, so the two records that are needed are read here: the nodes
(2411, 781) and results at nodes (55, 2414).
"""
from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np

from ..errors import InputError
from ..registration.arrays import Array
from .field import VectorField

FORMATS = ".frd .vtu .vtk .unv"
_NAMES = re.compile(rb'(<DataArray[^>]*\bName=")(displacements?|disp|u|displacementvectors)(")', re.IGNORECASE)
_VTK_NAMES = re.compile(rb"^(VECTORS\s+)(displacements?|disp|u|displacementvectors)(\s)", re.IGNORECASE | re.MULTILINE)
_DISPLACEMENT_RESULT = 8
"""Type of a universal file's result that is a displacement (unit: of the SDRC I-DEAS format)."""

Steps = list[tuple[Array, Array]]
"""Positions and displacements (n, 3) of every step."""


def read_result(path: Path, step: int | None = None) -> VectorField:
    """The displacements of a result file.

    Parameters
    ----------
    path : .frd, .vtu, .vtk or .unv, in mm
    step : of those that have displacements, from 1; None for the last

    Raises
    ------
    InputError : the file cannot be read, has no displacements, or not that step
    """
    readers = {".frd": _frd, ".vtu": _vtk, ".vtk": _vtk, ".unv": _unv}
    if path.suffix.lower() not in readers:
        raise InputError(f"The result {path} is of an unknown format: use one of {FORMATS}, or two .stl meshes.")
    if not path.is_file():
        raise InputError(f"The result {path} does not exist.")
    try:
        steps = readers[path.suffix.lower()](path)
    except (ValueError, IndexError, KeyError, RuntimeError, OSError) as error:
        raise InputError(f"The result {path} is damaged: {error}.") from None
    if not steps:
        raise InputError(f"The result {path} has no displacements of nodes: let them be written.")
    if step is not None and not 1 <= step <= len(steps):
        raise InputError(f"The result {path} has no step {step}: those with displacements are 1 to {len(steps)}.")
    return VectorField(*steps[-1 if step is None else step - 1])


def field_of_result_object(result: Any) -> VectorField:
    """The displacements of a mechanical result of FreeCAD's FEM workbench (InputError if it has none)."""
    vectors, mesh = getattr(result, "DisplacementVectors", None), getattr(result, "Mesh", None)
    if not vectors or mesh is None:
        raise InputError(f"{getattr(result, 'Label', result)} has no displacements: choose a mechanical result.")
    nodes = mesh.FemMesh.Nodes
    numbers = list(getattr(result, "NodeNumbers", ())) or sorted(nodes)
    return VectorField(_array([nodes[number] for number in numbers]), _array(vectors))


def _array(vectors: Sequence[Any]) -> Array:
    return np.array([tuple(vector) for vector in vectors], dtype=float).reshape(-1, 3)


def _frd(path: Path) -> Steps:
    from feminout.importCcxFrdResults import read_frd_result

    found = read_frd_result(str(path))
    nodes = found["Nodes"]
    steps = []
    for result in found["Results"]:
        moved = result.get("disp", {})
        numbers = [number for number in moved if number in nodes]
        if numbers:
            steps.append((_array([nodes[number] for number in numbers]), _array([moved[number] for number in numbers])))
    return steps


def _vtk(path: Path) -> Steps:
    """By FreeCAD's reader, which knows displacements by one name only: others are given that."""
    import Fem
    import ObjectsFem

    data = path.read_bytes()
    names = _NAMES if path.suffix.lower() == ".vtu" else _VTK_NAMES
    document = FreeCAD.newDocument("FfdsResult", "FfdsResult", True, True)
    try:
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder) / f"result{path.suffix.lower()}"
            copy.write_bytes(names.sub(rb"\1Displacement\3", data))
            result = ObjectsFem.makeResultMechanical(document, "Result")
            Fem.readResult(str(copy), result.Name)
        meshes = [item for item in document.Objects if item.isDerivedFrom("Fem::FemMeshObject")]
        if not meshes or not result.DisplacementVectors:
            return []
        nodes = meshes[0].FemMesh.Nodes
        return [(_array([nodes[number] for number in sorted(nodes)]), _array(result.DisplacementVectors))]
    finally:
        FreeCAD.closeDocument(document.Name)


def _unv(path: Path) -> Steps:
    nodes: dict[int, list[float]] = {}
    results: list[dict[int, list[float]]] = []
    for kind, lines in _datasets(path):
        if kind in (781, 2411):
            for head, place in zip(lines[0::2], lines[1::2], strict=False):
                nodes[int(head.split()[0])] = [_number(text) for text in place.split()[:3]]
        elif kind == 2414 and lines[2].split()[0] == "1" and lines[8].split()[3] == str(_DISPLACEMENT_RESULT):
            results.append(_nodal(lines[13:]))
        elif kind == 55 and lines[5].split()[3] == str(_DISPLACEMENT_RESULT):
            results.append(_nodal(lines[8:]))
    steps = []
    for moved in results:
        numbers = [number for number in moved if number in nodes]
        if numbers:
            steps.append((np.array([nodes[number] for number in numbers]), np.array([moved[n] for n in numbers])))
    return steps


def _nodal(lines: list[str]) -> dict[int, list[float]]:
    return {int(head.split()[0]): [_number(text) for text in values.split()[:3]]
            for head, values in zip(lines[0::2], lines[1::2], strict=False)}


def _number(text: str) -> float:
    """A number as Fortran writes it, too."""
    return float(text.replace("D", "E").replace("d", "e"))


def _datasets(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Kind and lines of each dataset, between lines that hold −1 alone."""
    lines = path.read_text("latin-1").splitlines()
    marks = [number for number, line in enumerate(lines) if line.strip() == "-1"]
    for start, end in zip(marks[0::2], marks[1::2], strict=False):
        yield int(lines[start + 1].split()[0]), lines[start + 2 : end]
