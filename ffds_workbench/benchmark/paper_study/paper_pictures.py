# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures 3, 4, 5 and 8 of the paper as pictures: lattices, clouds and surfaces before and after."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from mpl_toolkits.mplot3d import Axes3D
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ...registration.face import displacement_lattice, ffd, ffds
from ...registration.splines import greville
from ..pages import style
from ..simulated.sheet import SIZE, nominal
from .paper_case import PaperCase, lifted
from .paper_methods import METHODS, TITLES, deformed

_EXAGGERATED = 2.5
_ELEVATION, _AZIMUTH, _ZOOM = 26, -58, 1.06
_CORNER, _SEAM = 7.0, (18.0, 16.0, 57.0, 54.0)


def lattices(folder: Path, name: str = "figure_3") -> str:
    """Figure 3: the control points of both methods on the same face."""
    drawing = style.figure(10.5, 4.3)
    face = nominal()
    control = displacement_lattice(face.surface, (5, 5))
    on_face = face.surface.on_grid(greville(control.knots_u), greville(control.knots_v))
    in_space = ffd.enclose(face, (5, 5, 5)).control_points
    for k, title in enumerate(("FFDS: 5 × 5 control points in the face", "FFD-HSU: 5 × 5 × 5 around the face")):
        axes = _axes(drawing, 1, 2, k + 1, title)
        _surface(axes, _grid_of(lambda uv: face.surface(uv)), style.SHEET, 0.75)
        if k == 0:
            _net(axes, on_face, style.COLOURS["ffds"])
        else:
            for layer in range(5):
                _net(axes, in_space[:, :, layer], style.COLOURS["ffd_hsu"], 0.6, 9)
            for line in in_space.reshape(25, 5, 3):
                axes.plot(*line.T, color=style.COLOURS["ffd_hsu"], linewidth=0.6)
        axes.set_zlim(-8, 8)
        axes.set_box_aspect((SIZE[0], SIZE[1], 16 * _EXAGGERATED), zoom=_ZOOM)
    return style.save(drawing, folder, name)


def before_and_after(case: PaperCase, folder: Path, name: str) -> str:
    """Figures 5 and 8: 36 source points, T and 25 control points, before and after."""
    result = METHODS["ffds"](case.target, (5, 5), 36)
    u, v, _ = ffds.equidistant_grid(nominal(), 36)
    source = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    before = nominal().surface.on_grid(greville(result.displacement.knots_u), greville(result.displacement.knots_v))
    drawing = style.figure(11, 4.3)
    shown = case.target[np.random.default_rng(0).permutation(len(case.target))[:6000]]
    for k, title in enumerate(("before (heights × 2.5)", "after (heights × 2.5)")):
        axes = _axes(drawing, 1, 2, k + 1, title)
        axes.scatter(*shown.T, s=1.6, color=style.CLOUD, linewidths=0, label="_")
        moved = k * result.displacement.control_points
        shape: Callable[[Array], Array] = nominal().surface
        if k:
            shape = partial(deformed, result)
        points = shape(source)
        _surface(axes, _grid_of(shape), style.SHEET, 0.35)
        _net(axes, before + moved, style.COLOURS["ffds"])
        axes.scatter(*points.T, s=14, color=style.INK, depthshade=False, label="36 source points")
        axes.plot([], [], "o", color=style.CLOUD, markersize=3, label="T, the target cloud (part of it)")
        axes.plot([], [], "o-", color=style.COLOURS["ffds"], markersize=4, label="25 control points")
    drawing.legend(*axes.get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=3,
                   fontsize=9)
    return style.save(drawing, folder, name)


def seam(case: PaperCase, folder: Path, name: str = "figure_4") -> str:
    """Figures 4 and 7: a weld seam contour on the face, nominal, true and found, and how far what is found is off."""
    path = seam_contour()
    before, true = nominal().surface(path), lifted(path)
    found = {method: deformed(METHODS[method](case.target, (10, 10), 400), path) for method in ("ffds", "robust")}
    drawing = style.figure(11, 4.6)
    axes = _axes(drawing, 1, 2, 1, "weld seam contour of a tube on the sheet (heights × 2.5)")
    _surface(axes, _grid_of(nominal().surface), "#e9edf1", 0.5)
    _surface(axes, _grid_of(lifted), style.SHEET, 0.6)
    axes.plot(*before.T, "--", color=style.SOFT, label="nominal")
    axes.plot(*true.T, color=style.INK, linewidth=2.5, label="deformed, true")
    axes.plot(*found["robust"].T, color=style.COLOURS["robust"], linewidth=1.2, label="found")
    axes.legend(fontsize=8.5, loc="upper left")
    plot = drawing.add_subplot(1, 2, 2)
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(before, axis=0), axis=1))])
    tree = cKDTree(lifted(seam_contour(20_000)))
    plot.semilogy(arc, np.linalg.norm(true - before, axis=1), "--", color=style.SOFT, label="nominal")
    for method, points in found.items():
        plot.semilogy(arc, np.maximum(tree.query(points)[0], 1e-5), color=style.COLOURS[method], label=TITLES[method])
    plot.set(xlabel="along the seam in mm", ylabel="distance from the true seam in mm",
             title=f"N = 10, {case.name} case", ylim=(1e-4, 20))
    plot.legend(fontsize=8.5)
    return style.save(drawing, folder, name)


def seam_contour(count: int = 400) -> Array:
    """(u, v) along a rectangle with rounded corners, (count, 2), closed."""
    x0, y0, x1, y1 = _SEAM
    centres = np.array([(x1, y0), (x1, y1), (x0, y1), (x0, y0)])
    inward = _CORNER * np.array([(-1, 1), (-1, -1), (1, -1), (1, 1)])
    arcs = []
    for k, (centre, shift) in enumerate(zip(centres, inward, strict=True)):
        angle = np.linspace(-np.pi / 2, 0, 30) + k * np.pi / 2
        arcs.append(centre + shift + _CORNER * np.column_stack([np.cos(angle), np.sin(angle)]))
    corners = np.concatenate([*arcs, arcs[0][:1]])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    at = np.linspace(0, length[-1], count)
    return np.column_stack([np.interp(at, length, corners[:, 0]), np.interp(at, length, corners[:, 1])])


def _axes(drawing: style.Figure, rows: int, columns: int, place: int, title: str) -> Axes3D:
    axes = drawing.add_subplot(rows, columns, place, projection="3d", computed_zorder=False)
    axes.view_init(_ELEVATION, _AZIMUTH)
    axes.set_title(title, fontsize=10.5)
    axes.set(xlabel="x in mm", ylabel="y in mm", zlim=(-1, 8))
    axes.set_box_aspect((SIZE[0], SIZE[1], 9 * _EXAGGERATED), zoom=_ZOOM)
    axes.set_zticks([0, 4, 8])
    return axes


def _grid_of(surface: Callable[[Array], Array]) -> Array:
    u, v = np.linspace(0, SIZE[0], 41), np.linspace(0, SIZE[1], 41)
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    return surface(uv.reshape(-1, 2)).reshape(41, 41, 3)


def _surface(axes: Axes3D, points: Array, colour: str, alpha: float) -> None:
    axes.plot_surface(*np.moveaxis(points, 2, 0), color=colour, alpha=alpha, linewidth=0, antialiased=True, rstride=1,
                      cstride=1, shade=False)


def _net(axes: Axes3D, points: Array, colour: str, width: float = 1.0, size: float = 16) -> None:
    for line in (*points, *points.swapaxes(0, 1)):
        axes.plot(*line.T, color=colour, linewidth=width)
    axes.scatter(*points.reshape(-1, 3).T, s=size, color=colour, depthshade=False)
