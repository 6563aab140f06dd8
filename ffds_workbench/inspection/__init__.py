# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometrical and dimensional characteristics of an as-built model against a plan, with the band of each.

`plan` is what is to be inspected, `features` are the faces and edges as points with what is known of their errors.
`zones` and `fits` are the mathematics, `datums` puts the part onto its datums, `frames` moves it. `blocks`,
`characteristics` and `dimensions` make values of these, `inspect` the verdicts, and `output` the tables and the page.
"""
from __future__ import annotations

from typing import Any

_HOMES = {"plan": ("Plan", "read_plan"), "inspect": ("Inspection", "inspect_shapes"), "output": ("write_inspection",)}
__all__ = ["Inspection", "Plan", "inspect_shapes", "read_plan", "write_inspection"]


def __getattr__(name: str) -> Any:
    """What is loaded when it is first asked for (PEP 562)."""
    from importlib import import_module

    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
