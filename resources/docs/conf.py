# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sphinx's settings for these pages; ``resources/scripts/docs.sh`` builds them."""
from __future__ import annotations

import sys
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from ffds_workbench import __version__
from ffds_workbench.cli.main import command_line

project, author, release = "FFDS", "The FFDS authors", __version__
extensions = ["myst_parser"]
exclude_patterns: list[str] = []
html_theme = "alabaster"
html_theme_options = {"description": "As-built CAD models from scans", "page_width": "1100px", "show_powered_by": False}
html_copy_source = False
myst_heading_anchors = 3


class CommandHelp(Directive):
    """What ``./ffds COMMAND --help`` says, so that the pages say the same."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """The help as a literal block."""
        commands = next(action.choices for action in command_line()._actions if action.dest == "command")
        text = commands[self.arguments[0]].format_help()
        return [nodes.literal_block(text, text, language="text")]


def setup(app) -> None:
    """Called by Sphinx."""
    app.add_directive("command-help", CommandHelp)
