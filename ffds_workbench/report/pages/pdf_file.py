# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report as a PDF on A4, by matplotlib."""
from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...registration.arrays import Array
from .content import FACE_HEADS, Content, Rows
from .pictures import draw
from .scene import ColouredPart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PAGE = (8.27, 11.69)
_LEFT, _TOP, _BOTTOM = 0.08, 0.95, 0.06
_LINE = 0.0165
"""Height of a line of text, of the page's."""
_ROWS, _WIDE, _SIDES = 50, 98, 3
"""Lines of a table on a page, letters of a line, and pictures on the first page."""
_INK, _GOOD, _DOUBTFUL = "#1d2733", "#2e7d43", "#b3401f"
_COLUMNS = (0.0, 0.15, 0.25, 0.34, 0.44, 0.59, 0.68, 0.82, 0.91)


def write_pdf(path: Path, said: Content, scene: ColouredPart, sides: Sequence[Array]) -> None:
    """Write it: the verdict with pictures from the ``sides``, (3,) each towards the viewer, then the tables."""
    from matplotlib.backends.backend_pdf import PdfPages
    from matplotlib.figure import Figure

    with PdfPages(path) as pages:
        first = Figure(figsize=_PAGE)
        height = _first_words(first, said)
        for number, side in enumerate(sides[:_SIDES]):
            draw(first, scene, side, (_LEFT, height - 0.24 * (number + 1), 0.84, 0.22))
        pages.savefig(first)
        for start in range(0, len(said.faces), _ROWS):
            pages.savefig(_table_page("Faces: deviation of the scan in mm", [FACE_HEADS],
                                      said.faces[start : start + _ROWS], _COLUMNS))
        rows: Rows = []
        for name, pairs in (("Certificate", said.certificate), ("Settings", said.settings),
                            ("Made with", said.made_with)):
            rows += [(name, ""), *_wrapped(pairs), ("", "")]
        for start in range(0, len(rows), _ROWS):
            pages.savefig(_table_page("Certificate, settings, versions", [], rows[start : start + _ROWS], (0.0, 0.36)))


def _first_words(page: Figure, said: Content) -> float:
    """Title, verdict and what to look at; where they end."""
    height = _TOP
    page.text(_LEFT, height, f"{said.title}: as built", fontsize=17, weight="bold", color=_INK)
    height -= 2 * _LINE
    lines = [(line, _GOOD if said.good else _DOUBTFUL) for line in textwrap.wrap(said.sentence, _WIDE - 12)]
    lines += [(("– " if first == 0 else "  ") + line, _INK) for text in said.advice
              for first, line in enumerate(textwrap.wrap(text, _WIDE))]
    for text, colour in lines:
        page.text(_LEFT, height, text, fontsize=9.5, color=colour)
        height -= _LINE
    return height - 0.5 * _LINE


def _wrapped(pairs: Rows) -> Rows:
    return [(name if first == 0 else "", line) for name, value in pairs
            for first, line in enumerate(textwrap.wrap(value, 70) or [""])]


def _table_page(title: str, heads: Sequence[tuple[str, ...]], rows: Rows, columns: Sequence[float]) -> Figure:
    from matplotlib.figure import Figure

    page = Figure(figsize=_PAGE)
    page.text(_LEFT, _TOP, title, fontsize=13, weight="bold", color=_INK)
    for line, row in enumerate([*heads, *rows]):
        bold = line < len(heads) or row[1:] == ("",)
        for place, text in zip(columns, row, strict=True):
            page.text(_LEFT + 0.86 * place, _TOP - (line + 2) * _LINE, text, fontsize=8.5, color=_INK,
                      weight="bold" if bold else "normal")
    return page
