# SPDX-License-Identifier: LGPL-2.1-or-later
"""A page that shows a job step by step: HTML beside the files that the job wrote."""
from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2733; margin: 0 auto; padding: 2rem 1.5rem 4rem;
       max-width: 1100px }
h1 { font-size: 1.7rem; margin: 0 0 .3rem } h2 { font-size: 1.15rem; margin: 2.4rem 0 .5rem }
h2 span { color: #fff; background: #2b6cb0; border-radius: 1em; padding: .05em .6em; margin-right: .5em }
p { color: #6b7785; margin: .2rem 0 .8rem }
pre { background: #f4f6f8; padding: .9rem 1rem; overflow-x: auto; font-size: 12.5px }
img { width: 100%; border: 1px solid #dfe3e8 } a { color: #2b6cb0; margin-right: 1.2em }
"""


@dataclass(frozen=True)
class Step:
    """One step of a job.

    Attributes
    ----------
    title : its heading
    about : a sentence on what it does
    figures : text with a fixed pitch; empty for none
    picture : name of a picture beside the page, or None
    files : names of the files that came of it
    """

    title: str
    about: str
    figures: str = ""
    picture: str | None = None
    files: Sequence[str] = ()


def page(title: str, about: str, steps: Sequence[Step]) -> str:
    """The page's text; it needs nothing but the pictures that it names."""
    parts = [f"<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{html.escape(title)}</title>"
             f"<style>{_STYLE}</style></head><body>\n<h1>{html.escape(title)}</h1>\n<p>{html.escape(about)}</p>"]
    for number, step in enumerate(steps, 1):
        parts.append(f"<h2><span>{number}</span>{html.escape(step.title)}</h2>\n<p>{html.escape(step.about)}</p>")
        if step.figures:
            parts.append(f"<pre>{html.escape(step.figures)}</pre>")
        if step.picture:
            name = html.escape(step.picture, quote=True)
            parts.append(f"<a href=\"{name}\"><img src=\"{name}\" alt=\"{html.escape(step.title, quote=True)}\"></a>")
        if step.files:
            links = (f"<a href=\"{html.escape(name, quote=True)}\">{html.escape(name)}</a>" for name in step.files)
            parts.append(f"<p>{' '.join(links)}</p>")
    return "\n".join([*parts, "</body></html>"]) + "\n"
