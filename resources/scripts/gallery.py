# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the pictures of ``resources/docs/gallery.md`` anew by running its commands, without arguments.

Needs ImageMagick, which makes them 1000 pixels wide, of 128 colours.
"""
from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "resources" / "docs" / "gallery.md"


def main() -> None:
    """Run the commands in a folder with the example, and keep the pictures."""
    pictures = PAGE.parent / "gallery"
    pictures.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(shutil.copytree(ROOT / "resources" / "examples", Path(name) / "examples"))
        for block in re.findall(r"^```sh\n(.*?)^```", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL):
            for line in block.splitlines():
                subprocess.run([str(ROOT / "ffds"), *shlex.split(line)[1:]], cwd=folder, check=True)
        for picture in folder.glob("*.png"):
            subprocess.run(["convert", str(picture), "-resize", "1000x>", "-colors", "128",
                            f"PNG8:{pictures / picture.name}"], check=True)


if __name__ == "__main__":
    main()
