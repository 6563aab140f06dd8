# SPDX-License-Identifier: LGPL-2.1-or-later
"""Samples the faces of a part evenly by area, and finds out which of the samples a camera outside can see."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ...motions import even_directions
from ...trims import inside_polylines
from ..settings import RigidSettings
from .part_samples import SurfaceSamples, Target
from .rims import rims_of

_OUTSIDE = 2e-3
"""Sample spacings that tell the two sides of touching faces apart (theory: far less than one)."""


def target_of(faces: Sequence[FaceGeometry], settings: RigidSettings | None = None) -> Target:
    """Sample the faces of a part.

    Parameters
    ----------
    faces : the faces that the scan may show; faces that nothing outside can see (contacts inside an assembly) drop out
    settings : how scans are to be aligned with it; None for the defaults

    Raises
    ------
    ValueError
        There is no face with an area.
    """
    settings = settings or RigidSettings()
    given = settings.samples
    areas = [_AreaGrid.of(face, given.area_cells) for face in faces]
    total = sum(area.inside for area in areas)
    if not total > 0:
        raise ValueError("the faces have no area")
    spacing = np.sqrt(total / given.samples)
    pieces = [_sample_face(face, k, area, spacing / given.largest_turn, spacing)
              for k, (face, area) in enumerate(zip(faces, areas, strict=True))]
    all_samples = SurfaceSamples(*(np.concatenate([getattr(piece, name) for piece in pieces])
                                   for name in ("points", "normals", "tangents", "curvature", "area", "face")))
    views = even_directions(given.views)
    generator = np.random.default_rng(0)
    share = all_samples.area / all_samples.area.sum()
    rough = generator.choice(len(share), size=min(len(share), 3 * given.even_samples), replace=False, p=share)
    seen = _visibility(all_samples[rough], all_samples.points, views, np.sqrt(total / len(rough)), given.grazing_cosine)
    exposed_rough = (seen & (views @ all_samples.normals[rough].T > given.face_on_cosine)).any(axis=0)
    outside = all_samples.points + _OUTSIDE * spacing * all_samples.normals
    exposed = exposed_rough[cKDTree(outside[rough]).query(outside)[1]]
    kept = np.flatnonzero(exposed_rough & exposed[rough])[:given.even_samples]
    samples_seen = all_samples[exposed]
    rims = rims_of(faces, samples_seen.points, samples_seen.normals, spacing, settings.rims)
    return Target(samples_seen, all_samples, all_samples[rough[kept]], views, seen[:, kept], rims, settings)


@dataclass(frozen=True)
class _AreaGrid:
    """Area density |S_u × S_v| of a face on a regular grid of cells over its parameter box."""

    box: tuple[float, float, float, float]
    density: Array
    inside: float

    @classmethod
    def of(cls, face: FaceGeometry, cells: int) -> _AreaGrid:
        polyline = np.concatenate(face.trims)
        u0, u1, v0, v1 = face.surface.range
        (ul, vl), (uh, vh) = polyline.min(axis=0), polyline.max(axis=0)
        box = (max(u0, ul), min(u1, uh), max(v0, vl), min(v1, vh))
        u = box[0] + (np.arange(cells) + 0.5) / cells * (box[1] - box[0])
        v = box[2] + (np.arange(cells) + 0.5) / cells * (box[3] - box[2])
        cross = np.cross(face.surface.derivative(1, 0).on_grid(u, v), face.surface.derivative(0, 1).on_grid(u, v))
        density = np.linalg.norm(cross, axis=2)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
        within = inside_polylines(face.trims, uv).reshape(density.shape)
        cell = (box[1] - box[0]) * (box[3] - box[2]) / density.size
        return cls(box, density, float((density * within).sum() * cell))

    @property
    def whole(self) -> float:
        """Area of the parameter box in mm², trims left out of account."""
        return float(self.density.mean() * (self.box[1] - self.box[0]) * (self.box[3] - self.box[2]))

    def place(self, unit: Array) -> Array:
        """Points of the unit square (n, 2) to parameters (n, 2) even by area: inverse distribution function."""
        (u0, u1, v0, v1), cells = self.box, len(self.density)
        marginal = np.concatenate([[0.0], np.cumsum(self.density.sum(axis=1))])
        u = np.interp(unit[:, 0] * marginal[-1], marginal, np.linspace(0, 1, cells + 1))
        row = np.minimum((u * cells).astype(int), cells - 1)
        conditional = np.concatenate([np.zeros((cells, 1)), np.cumsum(self.density, axis=1)], axis=1)
        conditional /= np.maximum(conditional[:, -1:], 1e-300)
        position = np.empty(len(unit))
        for k in np.unique(row):
            mine = row == k
            position[mine] = np.interp(unit[mine, 1], conditional[k], np.linspace(0, 1, cells + 1))
        return np.stack([u0 + u * (u1 - u0), v0 + position * (v1 - v0)], axis=1)


def _sample_face(face: FaceGeometry, index: int, area: _AreaGrid, roundest: float, spacing: float) -> SurfaceSamples:
    """Even samples, denser where the face turns too far between two of them: with radii below ``roundest`` mm."""
    probe = _evaluate(face, area.place(_r2_sequence(32)), index)
    bent = float(np.quantile(np.linalg.norm(probe.curvature, axis=1), 0.75)) * roundest
    count = int(np.ceil(area.whole / spacing**2 * np.clip(bent**2, 1.0, 9.0)))
    uv = area.place(_r2_sequence(max(count, 12)))
    uv = uv[inside_polylines(face.trims, uv)]
    samples = _evaluate(face, uv, index)
    return SurfaceSamples(samples.points, samples.normals, samples.tangents, samples.curvature,
                          np.full(len(uv), area.inside / max(len(uv), 1)), samples.face)


def _r2_sequence(count: int) -> Array:
    """First points of the R2 low-discrepancy sequence in the unit square (M. Roberts, 2018); (count, 2)."""
    g = 1.32471795724474602596
    return np.mod(0.5 + np.arange(1, count + 1)[:, None] * np.array([1.0 / g, 1.0 / g**2]), 1.0)


def _evaluate(face: FaceGeometry, uv: Array, index: int) -> SurfaceSamples:
    """Points, outward frame and second fundamental form at parameters (n, 2)."""
    surface = face.surface
    su, sv = surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv)
    normal = face.outward * np.cross(su, sv)
    length = np.linalg.norm(normal, axis=1)
    regular = length > 1e-12 * max(float(length.max(initial=0.0)), 1e-300)
    uv, su, sv, normal, length = uv[regular], su[regular], sv[regular], normal[regular], length[regular]
    normal /= length[:, None]
    first = su / np.maximum(np.linalg.norm(su, axis=1), 1e-300)[:, None]
    second = np.cross(normal, first)
    forms = np.stack([np.einsum("ni,ni->n", surface.derivative(*order)(uv), normal)
                      for order in ((2, 0), (1, 1), (0, 2))], axis=1)
    # S_u = a·t1, S_v = b·t1 + c·t2, so the second form in the orthonormal frame follows by back substitution
    a, b, c = (np.einsum("ni,ni->n", x, y) for x, y in ((su, first), (sv, first), (sv, second)))
    h11 = forms[:, 0] / a**2
    h12 = (forms[:, 1] - a * b * h11) / (a * c)
    h22 = (forms[:, 2] - b * b * h11 - 2.0 * b * c * h12) / c**2
    points = surface(uv)
    return SurfaceSamples(points, normal, np.stack([first, second], axis=1), np.stack([h11, h12, h22], axis=1),
                          np.zeros(len(uv)), np.full(len(uv), index))


def _visibility(samples: SurfaceSamples, hiding: Array, views: Array, spacing: float,
                grazing: float) -> NDArray[np.bool_]:
    """Which samples an orthographic camera in each direction sees, by a depth buffer; (len(views), n).

    Parameters
    ----------
    hiding : (m, 3) points that hide what is behind them, some per pixel so that no pixel is a hole
    spacing : of the samples in mm; a pixel is twice that
    grazing : cosine under which a surface is too oblique to be seen
    """
    visible = np.zeros((len(views), len(samples.points)), dtype=bool)
    pixel = 2.0 * spacing
    for k, view in enumerate(views):
        across = np.cross(view, np.eye(3)[np.argmin(np.abs(view))])
        across /= np.linalg.norm(across)
        axes = np.stack([across, np.cross(view, across)], axis=1)
        corner = (hiding @ axes).min(axis=0)
        behind, mine = (np.floor((points @ axes - corner) / pixel).astype(int) + 1
                        for points in (hiding, samples.points))
        width = int(behind[:, 1].max()) + 2
        top = np.full(width * (int(behind[:, 0].max()) + 2), -np.inf)
        np.maximum.at(top, behind[:, 0] * width + behind[:, 1], hiding @ view)
        key = mine[:, 0] * width + mine[:, 1]
        height = samples.points @ view
        facing = samples.normals @ view
        steepness = np.sqrt(1.0 - np.clip(facing, grazing, 1.0) ** 2) / np.maximum(facing, grazing)
        slack = pixel * (0.2 + np.sqrt(2.0) * steepness)
        visible[k] = (facing > grazing) & (height > top[key] - slack)
    return visible
