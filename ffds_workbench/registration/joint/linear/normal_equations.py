# SPDX-License-Identifier: LGPL-2.1-or-later
"""The normal equations that rows of all kinds are added to."""
from __future__ import annotations

from dataclasses import dataclass

from ...arrays import Array, Index
from .system import Pattern


@dataclass(frozen=True)
class NormalEquations:
    """A δ = right, filled in place.

    Attributes
    ----------
    pattern : where the blocks stand
    blocks : (3, 3, size) of A on the pattern
    right : (controls, 3)
    """

    pattern: Pattern
    blocks: Array
    right: Array

    def add_products(self, a: int, b: int, products: Array, spans: Index) -> None:
        """Add products (n, 16, 16) of basis functions on spans (n,) to the components ``a``, ``b`` and ``b``, ``a`` of
        x, y and z."""
        values = self.pattern.from_spans(products, spans)
        self.blocks[a, b] += values
        if a != b:
            self.blocks[b, a] += values
