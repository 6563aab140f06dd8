# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of the scripted objects: a declared table of properties that older documents are brought up to."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..compat import Stateless

READ_ONLY, HIDDEN, OUTPUT = 1, 4, 8
"""Property attributes as ``addProperty`` takes them; an output does not touch its object."""


@dataclass(frozen=True)
class Property:
    """One property of an object: FreeCAD's type, the group it is shown in, its tooltip, and what it starts with."""

    name: str
    kind: str
    group: str
    tooltip: str
    value: Any = None
    attributes: int = 0


class Feature(Stateless):
    """Base of the proxies. A proxy holds nothing that has to be saved: everything is in the properties."""

    SCHEMA = 1
    PROPERTIES: tuple[Property, ...] = ()

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        self.ensure_properties(obj)
        obj.SchemaVersion = self.SCHEMA

    def ensure_properties(self, obj: Any) -> None:
        """Add the properties that the object does not have yet."""
        version = Property("SchemaVersion", "App::PropertyInteger", "Base", "Layout of the properties", None, HIDDEN)
        for item in (*self.PROPERTIES, version):
            if item.name not in obj.PropertiesList:
                obj.addProperty(item.kind, item.name, item.group, item.tooltip, item.attributes)
                if item.value is not None:
                    setattr(obj, item.name, item.value)

    def onDocumentRestored(self, obj: Any) -> None:
        """A document was opened: bring its object up to this version."""
        self.ensure_properties(obj)
