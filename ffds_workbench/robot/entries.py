# SPDX-License-Identifier: LGPL-2.1-or-later
"""Objects in the JSON files that users write; refused where they cannot be read or say what is unknown."""
from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import InputError


def read_object(path: Path, what: str) -> Mapping[str, Any]:
    """The one object of a JSON file.

    Parameters
    ----------
    what : the file is, as refusals call it: "cell"

    Raises
    ------
    InputError : the file cannot be read, or holds something else
    """
    try:
        found = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"The {what} {path} cannot be read: {error.strerror}.") from error
    except ValueError as error:
        raise InputError(f"The {what} {path} is not JSON: {error}.") from error
    if not isinstance(found, Mapping):
        raise InputError(f"The {what} {path} must be one object.")
    return found


def checked_object(entry: object, known: Sequence[str], what: str) -> Mapping[str, Any]:
    """The entry itself, an object all of whose keys are ``known`` or begin with $ (InputError)."""
    if not isinstance(entry, Mapping):
        raise InputError(f"The {what} must be an object with the keys {', '.join(known)}.")
    unknown = [key for key in entry if key not in known and not key.startswith("$")]
    if unknown:
        raise InputError(f"The {what} has an unknown key '{unknown[0]}': there are {', '.join(known)}.")
    return entry
