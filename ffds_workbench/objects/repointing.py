# SPDX-License-Identifier: LGPL-2.1-or-later
"""What refers to a nominal part, or to its faces, edges and vertices, is made to refer to the as-built part instead."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..errors import InputError, RefusedError
from .as_built import is_as_built
from .seams import is_seams

_GROUPS = ("App::GroupExtension", "App::LinkBaseExtension")
"""Groups and links, which only hold a part or show it again, keep doing so."""
_KEPT = {"Nominal", "Holders", "ExpressionEngine"}


@dataclass(frozen=True)
class Reference:
    """One property of one object, and what it holds."""

    item: Any
    name: str
    value: Any


def references(as_built: Any) -> list[Reference]:
    """The properties of other objects that name the nominal part of an as-built one, or an element of it.

    Groups, links that show the part again and other as-built parts are left out, and so is what the nominal part
    itself is made from.
    """
    source = as_built.Source
    above = {item.Name for item in (as_built, *as_built.OutListRecursive)}
    found = []
    for user in dict.fromkeys(source.InList):
        if user.Name in above or is_as_built(user) or any(user.hasExtension(name) for name in _GROUPS):
            continue
        for name in user.PropertiesList:
            if name not in _KEPT and "Link" in user.getTypeIdOfProperty(name):
                value = getattr(user, name)
                if _swapped(value, source, as_built) != value:
                    found.append(Reference(user, name, value))
    return found


def repoint(as_built: Any) -> list[Any]:
    """Make them name the as-built part: its elements have the same names. Returns the objects that were changed.

    What cannot be computed on the as-built part, a sketch on a face that is no longer flat for instance, goes on
    referring to the nominal one. Seams that were planned on the nominal part are compared with it from now on.

    Raises
    ------
    InputError : the object is no as-built part, or nothing refers to its nominal part
    RefusedError : the as-built part does not have the nominal one's elements, or nothing can be computed on it
    """
    if not is_as_built(as_built):
        raise InputError(f"{as_built.Label} is no as-built part of this workbench.")
    found = references(as_built)
    if not found:
        raise InputError(f"Nothing refers to {as_built.Source.Label}: there is nothing to re-point.")
    _check_elements(as_built)
    users = list(dict.fromkeys(reference.item for reference in found))
    broken = [user for user in users if not user.isValid()]
    found += [Reference(user, "Nominal", None) for user in users if is_seams(user) and user.Nominal is None]
    for reference in found:
        value = _swapped(reference.value, as_built.Source, as_built)
        setattr(reference.item, reference.name, as_built.Source if reference.value is None else value)
    as_built.Document.recompute()
    failed = [user for user in users if not user.isValid() and user not in broken]
    reasons = ", ".join(dict.fromkeys(user.getStatusString().strip().rstrip(".") for user in failed))
    for reference in found:
        if reference.item in failed:
            setattr(reference.item, reference.name, reference.value)
    if failed:
        as_built.Document.recompute()
    if len(failed) == len(users):
        names = ", ".join(user.Label for user in failed)
        raise RefusedError(f"{names} cannot be computed on {as_built.Label}, and nothing was re-pointed: {reasons}.")
    return [user for user in users if user not in failed]


def _check_elements(as_built: Any) -> None:
    counts = [[len(getattr(item.Shape, kind)) for kind in ("Faces", "Edges", "Vertexes")]
              for item in (as_built, as_built.Source)]
    if counts[0] != counts[1]:
        raise RefusedError(f"{as_built.Label} does not have the faces and edges of {as_built.Source.Label}: recompute "
                           f"it first.")


def _swapped(value: Any, old: Any, new: Any) -> Any:
    """A link, or tuples and lists of them, with one object for another."""
    if isinstance(value, (tuple, list)):
        return type(value)(_swapped(item, old, new) for item in value)
    return new if value is old else value
