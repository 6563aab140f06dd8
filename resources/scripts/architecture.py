#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws resources/docs/architecture.png from the imports of the package: its rooms floor by floor, and what they use.

    resources/scripts/architecture.py [OUT.png]

A room is a package; an arrow points from the room that imports to the one that is imported; its width tells how many
files do. Where a room is also reached through another one, only the longer way is drawn.
"""
from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "ffds_workbench"
DIVIDED = "registration"
"""The package whose own packages are rooms of the picture as well; what lies beside them is its ground floor."""
INK, SOFT, FILL = "#1b1f24", "#8a939c", "#e6eef5"


def room_of(parts: tuple[str, ...]) -> str | None:
    """The room that a module of the package, given by its dotted parts, belongs to; None for small shared things."""
    inner = "/".join(parts[:2])
    return (inner if parts[0] == DIVIDED and (PACKAGE / inner).is_dir()
            else parts[0] if (PACKAGE / parts[0]).is_dir() else None)


def imports(path: Path) -> Iterator[tuple[str, ...]]:
    """Modules of the package that a file imports when it runs, as dotted parts below the package."""
    here = path.relative_to(PACKAGE).with_suffix("").parts
    tree = ast.parse(path.read_text("utf-8"))
    for_types = {id(node) for test in ast.walk(tree) if isinstance(test, ast.If)
                 and "TYPE_CHECKING" in ast.dump(test.test) for node in test.body}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level and id(node) not in for_types:
            base = here[: len(here) - node.level]
            module = (*base, *(node.module or "").split(".")) if node.module else base
            yield from ((*module, alias.name) for alias in node.names)


def arrows() -> tuple[Counter[str], Counter[tuple[str, str]]]:
    """Files in every room, and files of one room that import from another."""
    files: Counter[str] = Counter()
    used: Counter[tuple[str, str]] = Counter()
    for path in sorted(PACKAGE.rglob("*.py")):
        room = room_of(path.relative_to(PACKAGE).with_suffix("").parts)
        if room is None:
            continue
        files[room] += 1
        used.update({(room, other) for parts in imports(path) if (other := room_of(parts)) not in (None, room)})
    return files, used


def direct(used: Counter[tuple[str, str]]) -> Counter[tuple[str, str]]:
    """The arrows whose end cannot be reached by a longer way (the transitive reduction of the graph)."""
    below: dict[str, set[str]] = {}
    for user, other in used:
        below.setdefault(user, set()).add(other)

    def reached(room: str) -> set[str]:
        return {room}.union(*(reached(other) for other in below.get(room, ())))

    return Counter({(user, other): count for (user, other), count in used.items()
                    if not any(other in reached(step) for step in below[user] - {other})})


def floors(rooms: Iterable[str], used: Iterable[tuple[str, str]]) -> list[list[str]]:
    """The rooms from the ground up: each stands right above the highest of those that it uses."""
    below: dict[str, set[str]] = {}
    for user, other in used:
        below.setdefault(user, set()).add(other)

    def floor(room: str) -> int:
        return 1 + max((floor(other) for other in below.get(room, ())), default=-1)

    heights = {room: floor(room) for room in sorted(rooms)}
    return [[room for room in heights if heights[room] == height] for height in range(max(heights.values()) + 1)]


def draw(out: Path) -> None:
    """Write the picture."""
    files, used = arrows()
    building = floors(files, used)
    figure = Figure(figsize=(8.5, 0.85 * len(building)))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, 10), ylim=(-0.2, len(building) * 1.2))
    axes.axis("off")
    place = {}
    for floor, names in enumerate(building):
        for k, name in enumerate(names):
            x, y = 10 * (k + 0.5) / len(names), 1.2 * floor + 0.5
            place[name] = x, y, floor
            axes.add_patch(FancyBboxPatch((x - 1.25, y - 0.3), 2.5, 0.6, boxstyle="round,pad=0.03", fc=FILL, ec=INK,
                                          lw=0.8, zorder=3))
            axes.text(x, y + 0.07, name, ha="center", va="center", fontsize=10, color=INK, zorder=4)
            axes.text(x, y - 0.16, f"{files[name]} files", ha="center", va="center", fontsize=7, color=SOFT, zorder=4)
    for (user, other), count in sorted(direct(used).items()):
        (x, y, floor), (u, v, below) = place[user], place[other]
        bend = 0.0 if floor - below == 1 else 0.14 * (1 if x <= 5 else -1)
        axes.add_patch(FancyArrowPatch((x, y - 0.3), (u, v + 0.33), arrowstyle="-|>", mutation_scale=9, color=SOFT,
                                       lw=0.4 + 0.12 * count**0.7, connectionstyle=f"arc3,rad={bend}", zorder=1,
                                       alpha=0.8))
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "resources/docs/architecture.png")
