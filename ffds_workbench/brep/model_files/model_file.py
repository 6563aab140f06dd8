# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: read into a shape with its name and face colours, and written complete.

Faces are numbered as ``Part.read`` numbers the whole file. From a FreeCAD document one object is taken, where it
stands in the document (its placement and those of the parts that hold it applied).
"""
from __future__ import annotations

import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import FreeCAD
import Part

from ...compat import Colour
from ...errors import InputError, RefusedError
from .. import topology
from ..validity import listed, newly_invalid
from . import document_colours, reader, reading, step_file, step_order
from .read_back import ReadBack, compare
from .reader import DOCUMENT, placed_shape
from .step_colours import Decoration

_STEP = (".step", ".stp")
_OTHER = ("", ": write .brep or .FCStd")
FORMATS = ".step .stp .iges .igs .brep .FCStd"
OUTPUT_FORMATS = (".step", ".stp", ".brep", DOCUMENT)


@dataclass(frozen=True)
class Model:
    """A shape and what belongs to it.

    Attributes
    ----------
    shape : Part.Shape
    label : the name of the product or of the document object
    decoration : names and colours of its faces and solids
    unit : the unit that its file declared, "" for mm; the shape is in mm in any case
    """

    shape: Part.Shape
    label: str
    decoration: Decoration = Decoration()
    unit: str = ""


def read(path: str | Path, label: str | None = None) -> Model:
    """Read a model file.

    Parameters
    ----------
    path : a file of the `FORMATS`
    label : for a FreeCAD document, the label or name of the object to take; needed where it holds several

    Raises
    ------
    InputError : the file is missing, damaged, of an unknown format, or holds no faces; there is no such object
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if path.is_dir():
        raise InputError(f"The model {path} is a folder: name a file.")
    if not path.exists():
        raise InputError(f"The model {path} does not exist.")
    if suffix not in reading.FORMATS:
        raise InputError(f"The model {path} is of an unknown format: use one of {FORMATS}.")
    if path.stat().st_size == 0:
        raise InputError(f"The model {path} is empty.")
    if suffix != DOCUMENT and label is not None:
        raise InputError(f"--object picks an object of a FreeCAD document, and {path} is none.")
    if suffix == DOCUMENT and reader.open_document(path) is not None:
        content = reader.read(path, label)
        return _checked(path, Model(content.shape, content.label, content.decoration))
    shape, about = reading.content(path, label)
    return _checked(path, Model(shape, about["label"], _decoration(about["decoration"]), about["unit"]))


def _decoration(about: Mapping[str, Any]) -> Decoration:
    """A decoration out of JSON, which has lists only."""
    colours = _colours(about["colours"])
    return Decoration(about["product"], tuple(about["solids"]), tuple(about["faces"]), colours)


def _colours(rows: Iterable[Sequence[float]]) -> tuple[Colour, ...]:
    return tuple((red, green, blue, other) for red, green, blue, other in rows)


def _checked(path: Path, model: Model) -> Model:
    if model.shape.isNull():
        raise InputError(f"The model {path} holds no shape: it is damaged or empty.")
    if not model.shape.Faces:
        raise InputError(f"The model {path} has no faces: FFDS deforms the faces of a solid, shell or compound.")
    return model


def from_object(item: Any) -> Model:
    """A shape, or a document object where it stands, as a model.

    Raises
    ------
    InputError : there is no shape with faces in it
    """
    if isinstance(item, Part.Shape):
        return _checked(Path("(shape)"), Model(item, "Shape"))
    if not hasattr(item, "Shape"):
        if item is None:
            raise InputError("There is no part: select one, or choose one in the properties.")
        raise InputError(f"{getattr(item, 'Label', item)} has no shape: select a part.")
    view = getattr(item, "ViewObject", None)
    colours = _colours(getattr(view, "DiffuseColor", ()))
    return _checked(Path(item.Label), Model(placed_shape(item), item.Label, Decoration(colours=colours)))


def check_output(path: Path) -> None:
    """Refuse a model format that cannot be written (InputError)."""
    if path.suffix.lower() not in OUTPUT_FORMATS:
        raise InputError(f"The output {path} is of an unknown format: use .step, .brep or .FCStd.")


def check_numbers(nominal: Model, path: Path) -> None:
    """Refuse a format that cannot number edges as the nominal model does, before any work is done (RefusedError)."""
    faces = step_order.disordered(nominal.shape) if path.suffix.lower() in _STEP else ()
    if faces:
        names = listed([f"Face{face + 1}" for face in faces])
        raise RefusedError(f"A STEP file cannot keep the numbers of this model's edges: they go round {names} in "
                           f"another order than they are numbered. Write .brep or .FCStd, which keep them, or use a "
                           f"STEP file that FreeCAD has exported from it as the nominal model.")


def write(model: Model, path: Path) -> ReadBack:
    """Write a model to a new file, and read it back; wrap it in `output.replacing` to replace an old one.

    The name and the colours go into STEP and FCStd. What the file holds has the same sub-shapes under the same numbers;
    in BREP and FCStd stored in the same way too.

    Raises
    ------
    InputError : the format is unknown
    RefusedError : the file could not be written whole, or does not hold the same shape
    """
    check_output(path)
    suffix = path.suffix.lower()
    if suffix in _STEP:
        back = step_file.write(model.shape, replace(model.decoration, product=model.label), path)
        different = back.differences(topology.read(model.shape))
        if different:
            raise RefusedError(f"A STEP file would {different}: write .brep or .FCStd, which keep them.")
    else:
        back = _write_exactly(model, path)
    worse = newly_invalid(model.shape, back.shape)
    if worse:
        raise RefusedError(f"The {suffix} file does not read back as a valid shape ({listed(worse)})"
                           f"{_OTHER[suffix in _STEP]}.")
    return back


def _write_exactly(model: Model, path: Path) -> ReadBack:
    suffix, written = path.suffix.lower(), topology.read(model.shape)
    if suffix == DOCUMENT:
        _write_document(model, path)
        shape = reader.read(path, None).shape
    else:
        path.write_text(model.shape.exportBrepToString(), "utf-8")
        shape = Part.read(str(path))
    back = compare(suffix, model.shape, written, shape)
    if back.topology != written or back.edges or back.vertices:
        raise RefusedError(f"The {suffix} file does not read back as what was written: is the disk full?")
    return back


def _write_document(model: Model, path: Path) -> None:
    document = FreeCAD.newDocument("FFDS_output", hidden=True, temp=True)
    try:
        item = document.addObject("Part::Feature", "AsBuilt")
        item.Label = model.label
        item.Shape = model.shape
        name, view = item.Name, getattr(item, "ViewObject", None)
        document.recompute()
        if view is not None and model.decoration.colours:
            view.DiffuseColor = list(model.decoration.colours)
        document.saveAs(str(path))
    except (OSError, RuntimeError, FreeCAD.Base.FreeCADError) as error:
        raise RefusedError(f"The document could not be written: {error}.") from error
    finally:
        FreeCAD.closeDocument(document.Name)
    if not zipfile.is_zipfile(path):
        raise RefusedError("The document could not be written whole: is the disk full?")
    if view is None:
        document_colours.add_views(path, {name: model.decoration.colours})
    with zipfile.ZipFile(path) as archive:
        if archive.testzip() is not None:
            raise RefusedError("The document could not be written whole: is the disk full?")
