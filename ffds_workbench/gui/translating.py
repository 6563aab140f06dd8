# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts in the user's language. What is marked here is collected by ``resources/scripts/translations.py``."""
from __future__ import annotations

import FreeCAD

from .. import RESOURCES

TRANSLATIONS = RESOURCES / "translations"


def tr(text: str) -> str:
    """A text of the panels and dialogs; put values in afterwards, by ``.format``."""
    return FreeCAD.Qt.translate("FFDS", text)
