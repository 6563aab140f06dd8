# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report as one HTML file that needs nothing beside it: figures, pictures, and the part to turn in the browser."""
from __future__ import annotations

import base64
import html
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ... import RESOURCES
from ..picture import COLOURS
from .content import FACE_HEADS, Content, Rows
from .scene import ColouredPart

VIEWER = RESOURCES / "report" / "viewer.js"
THREE = Path("/usr/share/javascript/three")
"""Where Debian's package libjs-three puts three.js."""
_PARTS = ("three.min.js", "examples/js/controls/OrbitControls.js")
_NO_DATA = -32768
"""What stands in the scene for no deviation: the one whole number of two bytes that no step has."""
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2733; background: #fff; margin: 0 auto; padding: 1.5rem;
       max-width: 1100px }
h1 { font-size: 1.6rem; margin: 0 } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem }
.good { color: #2e7d43 } .doubtful { color: #b3401f } p.verdict { font-size: 1.1rem; margin: .3rem 0 }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }
th, td { border-bottom: 1px solid #dfe3e8; padding: .15rem .7rem; text-align: right }
th:first-child, td:first-child { text-align: left } tr:last-child td { font-weight: 600 }
.pairs td, .pairs tr:last-child td { text-align: left; font-weight: 400 }
#view { position: relative; height: 480px; border: 1px solid #dfe3e8; background: #f4f6f8; touch-action: none }
#view canvas { display: block } #value { position: absolute; left: .7rem; bottom: .5rem; pointer-events: none }
#scale { height: 14px; max-width: 320px } .ends { display: flex; justify-content: space-between; max-width: 320px }
img { width: 100%; border: 1px solid #dfe3e8; margin-bottom: .6rem }
"""


def html_text(said: Content, scene: ColouredPart, pictures: Sequence[bytes]) -> str:
    """The whole file.

    Parameters
    ----------
    said : its words and tables
    scene : the part in its colours; left out, saying so, where three.js is not installed
    pictures : PNG files
    """
    tone = "good" if said.good else "doubtful"
    title = html.escape(said.title)
    images = "".join(f"<img alt=\"The deviation before and after\" src=\"data:image/png;base64,"
                     f"{base64.b64encode(image).decode()}\">" for image in pictures)
    notes = "".join(f"<li>{html.escape(text)}</li>" for text in said.advice)
    parts = [f"<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>"
             f"<style>{_STYLE}</style></head><body><h1>{title}: as built</h1>"
             f"<p class=\"verdict {tone}\">{html.escape(said.sentence)}</p>",
             f"<ul>{notes}</ul>" if notes else "", _viewer(scene),
             f"<h2>Seen from chosen sides</h2>{images}" if images else "",
             f"<h2>Faces: deviation of the scan in mm</h2>{_table(FACE_HEADS, said.faces)}",
             *(f"<h2>{name}</h2>{_pairs(rows)}" for name, rows in (
                 ("Certificate", said.certificate), ("Settings", said.settings), ("Made with", said.made_with))),
             "</body></html>"]
    return "\n".join(part for part in parts if part) + "\n"


def _viewer(scene: ColouredPart) -> str:
    try:
        library = "".join(f"<script>{(THREE / name).read_text('utf-8')}</script>\n" for name in _PARTS)
    except OSError:
        return "<p>The part to turn is left out: three.js is not installed (Debian: libjs-three).</p>"
    limit = f"{scene.limit:g}"
    return (f"<h2>The part to turn</h2><p><label><input type=\"radio\" name=\"state\" value=\"after\" checked> as built"
            f"</label> <label><input type=\"radio\" name=\"state\" value=\"before\"> nominal</label></p>"
            f"<div id=\"view\"><div id=\"value\">Drag to turn, point at the part to read the deviation.</div></div>"
            f"<div id=\"scale\" style=\"background: linear-gradient(to right, {', '.join(COLOURS)})\"></div>"
            f"<div class=\"ends\"><span>−{limit} mm</span><span>0</span><span>+{limit} mm</span></div>\n{library}"
            f"<script type=\"application/json\" id=\"scene\">{_data(scene)}</script>\n"
            f"<script>{VIEWER.read_text('utf-8')}</script>")


def _data(scene: ColouredPart) -> str:
    """The scene as the viewer reads it: numbers as base64, deviations in parts of the scale."""
    middle = 0.5 * (scene.points.min(axis=0) + scene.points.max(axis=0))
    step = 8.0 * scene.limit / 32767
    lines = [np.repeat(line, 2, axis=0)[1:-1] for line in scene.edges if len(line) > 1]
    blocks = {"points": (scene.points - middle).astype("<f4"), "triangles": scene.triangles.astype("<u4"),
              "faceOf": scene.face_of.astype("<u2"),
              "lines": (np.concatenate(lines) - middle if lines else np.zeros((0, 3))).astype("<f4"),
              **{name: _steps(getattr(scene, name), step) for name in ("before", "after")}}
    coded = {name: base64.b64encode(block.tobytes()).decode() for name, block in blocks.items()}
    return json.dumps({**coded, "step": step, "limit": scene.limit, "noData": _NO_DATA, "names": scene.names,
                       "colours": COLOURS}).replace("</", "<\\/")


def _steps(values: np.ndarray, step: float) -> np.ndarray:
    whole = np.clip(np.round(np.nan_to_num(values) / step), -32767, 32767)
    return np.where(np.isfinite(values), whole, _NO_DATA).astype("<i2")


def _table(heads: Sequence[str], rows: Rows) -> str:
    head = "".join(f"<th>{html.escape(text)}</th>" for text in heads)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(text)}</td>" for text in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _pairs(rows: Rows) -> str:
    body = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(value)}</td></tr>" for name, value in rows)
    return f"<table class=\"pairs\"><tbody>{body}</tbody></table>"
