# SPDX-License-Identifier: LGPL-2.1-or-later
"""How document objects get their view providers. Objects know no GUI; the GUI registers itself here."""
from __future__ import annotations

import importlib
from typing import Any

import FreeCAD

_dresser: str | None = None


def dress_with(module: str) -> None:
    """Name the module whose ``attach(item, source)`` gives a new object its view; imported when first needed.

    Objects of a document that was made without a GUI get their views when it is opened.
    """
    global _dresser
    _dresser = module
    FreeCAD.addDocumentObserver(_Opened())


class _Opened:
    """Watches documents coming to the front; FreeCAD tells nobody in Python that one was opened."""

    def slotActivateDocument(self, document: Any) -> None:
        """A document comes to the front, a new one as well: dress its objects that have no view yet."""
        for item in document.Objects:
            proxy = getattr(item, "Proxy", None)
            if type(proxy).__module__.startswith(__package__) and isinstance(item.ViewObject.Proxy, (int, type(None))):
                visible = item.Visibility
                dress(item, None)
                item.Visibility = visible


def dress(item: object, source: object) -> None:
    """Give ``item`` its view, in the colours of ``source`` if one is given; nothing where there is no GUI."""
    if _dresser is not None and getattr(item, "ViewObject", None) is not None:
        importlib.import_module(_dresser).attach(item, source)
