# SPDX-License-Identifier: LGPL-2.1-or-later
"""The versions of FFDS and of the software that the figures of a report depend on."""
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
