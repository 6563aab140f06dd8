# SPDX-License-Identifier: LGPL-2.1-or-later
"""An inspection as files: JSON, a table and a page."""
from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from ..output import replacing
from ..report import record
from ..report.page import Step, page
from .inspect import Inspection

FILES = ("inspection.json", "inspection.csv", "index.html")
_COLUMNS = ("name", "characteristic", "of", "datums", "nominal", "value", "least_squares", "band", "lower", "upper",
            "verdict", "advice")


def write_inspection(found: Inspection, folder: Path, title: str, more: Sequence[str] = ()) -> None:
    """Write an inspection into a folder: all files or none.

    Parameters
    ----------
    found : the inspection
    folder : where to; it exists
    title : of the page
    more : names of files beside it that the page is to link to

    Raises
    ------
    RefusedError : the disk is full
    """
    with replacing(*(folder / name for name in FILES)) as (json_file, table, html):
        record.write(found.as_dict(), json_file)
        with table.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(_COLUMNS)
            for item in found.as_dict()["items"]:
                writer.writerow([" ".join(cell) if isinstance(cell := item[name], tuple) else
                                 "" if cell is None else f"{cell:.6g}" if isinstance(cell, float) else cell
                                 for name in _COLUMNS])
        about = "Values with their 95 % bands; pass and fail where the whole interval says so (ISO 14253-1)."
        html.write_text(page(title, about, [Step("Inspection", f"The part: {found.verdict}.", found.table(), None,
                                                 [*FILES[:2], *more])]), "utf-8")
