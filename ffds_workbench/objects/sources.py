# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nominal parts of a document: which object is meant, its shape where it stands, and its frame."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import FreeCAD
import numpy as np
import Part
from numpy.typing import NDArray

from ..brep.model_files import Model, model_file, outer_placement
from ..errors import InputError
from ..scan.cloud import PointCloud


@dataclass(frozen=True)
class Source:
    """A nominal part as the registration sees it.

    Attributes
    ----------
    item : the document object
    model : its shape in the part's own frame, with its name and colours
    placement : where the part stands in what holds it
    T_document_part : (4, 4), from the part's own frame to the document's
    """

    item: Any
    model: Model
    placement: FreeCAD.Placement
    T_document_part: NDArray[np.float64]

    def to_part(self, scan: PointCloud) -> PointCloud:
        """A scan in the document's coordinates, in the part's own frame."""
        return scan.moved(np.linalg.inv(self.T_document_part))


def standing_for(item: Any) -> Any:
    """The object to deform when ``item`` was selected: a body stands for its tip.

    Raises
    ------
    InputError : the object has no faces, or is a feature inside a body that later ones build on
    """
    if item is None or not hasattr(item, "Shape") and not item.isDerivedFrom("App::Link"):
        raise InputError(f"{getattr(item, 'Label', 'Nothing')} has no shape: select a part or its faces.")
    holder = item.getParentGeoFeatureGroup()
    if holder is None or not holder.isDerivedFrom("PartDesign::Body"):
        return item
    if holder.Tip is not item:
        raise InputError(f"{item.Label} is not the last feature of {holder.Label}: select the body as it is now.")
    return holder


def read_source(item: Any) -> Source:
    """Read a nominal part.

    Raises
    ------
    InputError : there is no valid shape with faces in it
    """
    item = standing_for(item)
    shape = Part.getShape(item).copy()
    placement = shape.Placement
    matrix = np.array(outer_placement(item).multiply(placement).toMatrix().A).reshape(4, 4)
    if abs(abs(np.linalg.det(matrix[:3, :3])) - 1.0) > 1e-6:
        raise InputError(f"{item.Label} is scaled by its placement: make a simple copy of it first.")
    shape.Placement = FreeCAD.Placement()
    model = model_file.from_object(shape)
    return Source(item, Model(model.shape, item.Label, model.decoration), placement, matrix)
