# SPDX-License-Identifier: LGPL-2.1-or-later
"""With what a report was made: the versions of FFDS and of all that its figures rest on."""
from __future__ import annotations

import numpy
import Part
import scipy

from .. import __version__
from ..compat import freecad_version


def versions() -> dict[str, str]:
    """The report's ``versions``."""
    return {"ffds": __version__, "freecad": freecad_version(), "occt": Part.OCC_VERSION, "numpy": numpy.__version__,
            "scipy": scipy.__version__}
