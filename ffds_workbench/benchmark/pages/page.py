# SPDX-License-Identifier: LGPL-2.1-or-later
"""A benchmark's results as one self-contained HTML page and as Markdown."""
from __future__ import annotations

import base64
import html
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Table:
    """A table: the caption, the heads, and rows of cells, numbers already formatted."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        """The table with its caption as Markdown."""
        lines = [f"**{self.caption}**", "", "| " + " | ".join(self.head) + " |",
                 "|" + "---|" * len(self.head)]
        return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in self.rows])

    def html(self) -> str:
        """The table with its caption as HTML."""
        head = "".join(f"<th>{html.escape(cell)}</th>" for cell in self.head)
        rows = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in self.rows)
        caption = html.escape(self.caption)
        return (f"<div class='scroll'><table><caption>{caption}</caption><thead><tr>{head}</tr></thead>"
                f"<tbody>{rows}</tbody></table></div>")


@dataclass(frozen=True)
class Picture:
    """A picture: the PNG file, beside the page, and what it shows."""

    file: str
    caption: str


@dataclass(frozen=True)
class Section:
    """A section of the page: title, paragraphs, pictures, tables."""

    title: str
    text: Sequence[str] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()


def write(folder: Path, name: str, title: str, sections: Sequence[Section], data: dict[str, Any]) -> str:
    """Write NAME.json, NAME.md and NAME.html into the folder; returns the tables as Markdown.

    The HTML page holds its pictures in itself.
    """
    (folder / f"{name}.json").write_text(json.dumps(data, indent=1) + "\n")
    parts = [f"# {title}"]
    for section in sections:
        parts += [f"## {section.title}", *section.text]
        parts += [f"![{picture.caption}]({picture.file})" for picture in section.pictures]
        parts += [table.markdown() for table in section.tables]
    (folder / f"{name}.md").write_text("\n\n".join(parts) + "\n")
    body = "".join(_section(folder, section) for section in sections)
    (folder / f"{name}.html").write_text(_PAGE.replace("{title}", html.escape(title)).replace("{body}", body))
    return "\n\n".join(table.markdown() for section in sections for table in section.tables)


def _section(folder: Path, section: Section) -> str:
    parts = [f"<section><h2>{html.escape(section.title)}</h2>"]
    parts += [f"<p>{html.escape(text)}</p>" for text in section.text]
    for picture in section.pictures:
        data = base64.b64encode((folder / picture.file).read_bytes()).decode()
        parts.append(f"<figure><img alt='' src='data:image/png;base64,{data}'>"
                     f"<figcaption>{html.escape(picture.caption)}</figcaption></figure>")
    parts += [table.html() for table in section.tables]
    return "".join(parts) + "</section>"


_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title><style>
body { font: 16px/1.5 system-ui, sans-serif; color: #1b1f24; background: #fff; max-width: 68rem; margin: 2rem auto;
  padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-bottom: 1px solid #d5dae0; }
figure { margin: 1.2rem 0; } img { max-width: 100%; } figcaption { color: #57606a; font-size: .9rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; margin: 1rem 0; font-size: .88rem;
  font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .4rem; }
th, td { border-bottom: 1px solid #d5dae0; padding: .25rem .7rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; } thead th { background: #f3f5f7; }
</style></head><body><h1>{title}</h1>{body}</body></html>
"""
