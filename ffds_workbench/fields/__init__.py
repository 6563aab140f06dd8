# SPDX-License-Identifier: LGPL-2.1-or-later
"""The displacement of a part as an object: read, written, combined, applied.

`field` is the object, `operations` what is done with it, `csv_file` its file. `model_pair`, `meshes` and `fe_results`
make fields of two models, two meshes and the results of finite elements; `morphing` makes displacements of a part's
faces out of one. Fields through few measured points need the part's stiffness and stand in `registration`.
"""
from .csv_file import read_field, write_field
from .field import VectorField
from .morphing import Morphing, displacements
from .operations import FieldMean, difference, limited, masked, mean, scaled, smoothed, total, transformed

__all__ = ["FieldMean", "Morphing", "VectorField", "difference", "displacements", "limited", "masked", "mean",
           "read_field", "scaled", "smoothed", "total", "transformed", "write_field"]
