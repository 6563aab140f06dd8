# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user set on the preferences page, typed. The page itself is ``resources/ui/preferences.ui``."""
from __future__ import annotations

from dataclasses import dataclass

import FreeCAD

from .. import RESOURCES
from ..registration.request import ISOMETRY, METHODS

PAGE = RESOURCES / "ui" / "preferences.ui"
_GROUP = "User parameter:BaseApp/Preferences/Mod/FFDS"


@dataclass(frozen=True)
class Preferences:
    """Where a new panel starts from.

    Attributes
    ----------
    preview : show the deformed faces while settings change
    lattice : draw the control lattices in the preview
    method, isometry, stiffness : as in the `RegistrationRequest` of a new as-built part
    gate : distance in mm beyond which scan points are outliers; 0 for the default
    tolerance : band of the deviation map in mm that is shown in one green; 0 for none
    """

    preview: bool = True
    lattice: bool = True
    method: str = "robust"
    isometry: str = "auto"
    stiffness: float = 1.0
    gate: float = 0.0
    tolerance: float = 0.0


def preferences() -> Preferences:
    """As they are now."""
    group, plain = FreeCAD.ParamGet(_GROUP), Preferences()
    return Preferences(
        group.GetBool("Preview", plain.preview), group.GetBool("Lattice", plain.lattice),
        _entry(METHODS, group.GetInt("Method", 0)), _entry(ISOMETRY, group.GetInt("Isometry", 0)),
        group.GetFloat("Stiffness", plain.stiffness), group.GetFloat("Gate", plain.gate),
        group.GetFloat("Tolerance", plain.tolerance))


def _entry(names: tuple[str, ...], index: int) -> str:
    """The entry of a list that the page stores by its number."""
    return names[index] if 0 <= index < len(names) else names[0]
