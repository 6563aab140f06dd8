# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sphinx's settings for these pages; ``resources/scripts/docs.sh`` builds them."""
from __future__ import annotations

import re
import sys
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from ffds_workbench import __version__, find_freecad
from ffds_workbench.cli.main import command_line

find_freecad.activate()

project, author, release = "FFDS", "The FFDS authors", __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
autodoc_typehints = "none"
napoleon_google_docstring = False
exclude_patterns: list[str] = []
html_theme = "alabaster"
html_theme_options = {"description": "As-built CAD models from scans", "page_width": "1220px", "show_powered_by": False}
html_copy_source = False
html_static_path, html_css_files = ["_static"], ["ffds.css"]
myst_heading_anchors = 3


class CommandHelp(Directive):
    """What ``./ffds COMMAND --help`` says, so that the pages say the same."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """The help as a literal block."""
        commands = next(action.choices for action in command_line()._actions if action.dest == "command")
        text = commands[self.arguments[0]].format_help()
        return [nodes.literal_block(text, text, language="text")]


def descriptions(app, what, name, item, options, lines: list[str]) -> None:
    """FFDS's docstrings say what a parameter is where NumPy's name its type: ``points : (n, 3) in mm``."""
    section = ""
    for number, line in enumerate(lines):
        if number + 1 < len(lines) and lines[number + 1].startswith("---"):
            section = line
        entry = re.match(r"([\w*][\w*, ]*) : (.+)$", line)
        if entry and section in ("Parameters", "Attributes", "Raises", "Returns"):
            lines[number] = f"{entry[1]}\n    {entry[2]}"
    lines[:] = "\n".join(lines).splitlines()


def setup(app) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", descriptions, priority=400)  # before napoleon
    app.add_directive("command-help", CommandHelp)
