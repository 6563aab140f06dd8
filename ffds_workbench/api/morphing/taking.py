# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``field``: a displacement field from two models, two meshes or the result of finite elements."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import Part

from ...brep import workpiece
from ...brep.model_files import Model
from ...fields import VectorField, read_field, write_field
from ...fields.fe_results import field_of_result_object, read_result
from ...fields.meshes import field_between_meshes
from ...fields.model_pair import field_between
from ..destinations import destinations
from ..inputs import as_model


def field_of_models(nominal: Model | Part.Shape | str | Path | Any, as_built: Model | Part.Shape | str | Path | Any
                    ) -> VectorField:
    """The field that moves a nominal model into another one of the same topology.

    Parameters
    ----------
    nominal, as_built : a `Model`, a file, a shape or a document object each

    Raises
    ------
    InputError : a model cannot be read, or their faces do not correspond
    """
    return field_between(workpiece.read(as_model(nominal).shape), workpiece.read(as_model(as_built).shape))


def field_of_meshes(nominal: str | Path, displaced: str | Path | None = None, step: int | None = None) -> VectorField:
    """The field of a mesh: from two files with the same numbering, or from one result of finite elements.

    Parameters
    ----------
    nominal : an .stl file, or a result: .frd, .vtu, .vtk or .unv
    displaced : the other .stl file; None for a result
    step : of a result that has several, from 1; None for the last

    Raises
    ------
    InputError : a file cannot be read, the meshes do not correspond, or a result has no displacements
    """
    if displaced is None:
        return read_result(Path(nominal), step)
    return field_between_meshes(Path(nominal), Path(displaced))


def field_of_result(result: Any) -> VectorField:
    """The field of a mechanical result of FreeCAD's FEM workbench, a document object (InputError if it has none)."""
    return field_of_result_object(result)


def as_field(field: VectorField | str | Path) -> VectorField:
    """A field, or the file of one."""
    return field if isinstance(field, VectorField) else read_field(field)


def save_field(field: VectorField, path: str | Path, inputs: tuple[str | Path, ...] = ()) -> None:
    """Write a field as FIELD.csv.

    Parameters
    ----------
    field : the field
    path : of the file
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : the destination cannot be written
    RefusedError : the disk is full
    """
    destinations((path,), inputs)
    write_field(field, path)
