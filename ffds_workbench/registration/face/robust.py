# SPDX-License-Identifier: LGPL-2.1-or-later
"""Method ``robust``: a face fitted to all its scan points on a (u, v) raster, stiff first and soft later.

Scan points are expressed once as foot point and height over the nominal face. From then on every step works on the
raster: the residuals of each cell's points are averaged with Tukey weights, and the control lattice takes the
displacement that explains the cells with the least bending energy. Trust is earned step by step: the stiffer the field,
the wider the gate.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import RefusedError
from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..footpoints import SurfaceCoordinates
from ..scan_points import faces_alike, scan_normals
from ..uv_raster import Raster, make_raster
from .control_lattice import displacement_lattice
from .face_result import FaceRegistration
from .robust_fit import (MAIN_PATCHES, PROVEN, FacePoints, Layers, RasterFit, RobustSettings, RobustStage,
                         TrustedLayers, automatic_lattice, coarse_lattice, dense_layers, face_points, rigid_start,
                         trust_all, trust_main_patches, trust_proven)
from .scan_coverage import covered_share

_LEAST_POINTS, _LEAST_FITTED = 30, 20
"""Points near the face without which nothing is fitted, and points that have to agree on one surface (theory: twice,
and just above, the control points of the smallest lattice)."""
_RASTER_CELLS, _CELLS_PER_CONTROL_POINT = 4096, 4
"""Cells of a face, and cells for each control point of a fine lattice (unit: time; theory: four cells determine a
bicubic span's own control point)."""
_MANY_WALLS, _MOST_NORMALS = 0.1, 50_000
"""Where walls make up more than the first share of the layers, normals are computed to tell them apart, of at most the
second number of points (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark accuracy``; unit: time)."""


def register_robust(face: FaceGeometry, scan: Array, lattice: tuple[int, int] | None = None,
                    settings: RobustSettings | None = None, raster: Raster | None = None) -> FaceRegistration:
    """Deform a face to a scan that may be noisy, incomplete and full of other things.

    Parameters
    ----------
    face : the nominal face
    scan : (n, 3) in mm, finite, in the frame of the model; clutter, other faces and gaps are expected
    lattice : (N_i, N_j) control points in u and v, or None to choose them from the data
    settings : gates, stiffness and reach; None for the defaults
    raster : `make_raster` of the face where it is at hand already; a fine lattice needs a finer one

    Raises
    ------
    RefusedError
        Too little of the scan lies on the face, or the lattice is too fine for it.
    """
    settings = settings or RobustSettings()
    raster, settings = _frame(face, lattice, settings, raster)
    points, layers = _points_and_layers(face, scan, raster, settings)             # foot points (u, v) and heights h
    size = lattice or coarse_lattice(raster, layers, settings.stiffness)
    fit = RasterFit(face, raster, displacement_lattice(face.surface, size), settings)
    _check_lattice(face, fit, points, lattice is None)
    state, noise, gate = fit.moved(rigid_start(raster, layers)), layers.noise, settings.reach
    trust = trust_all(layers)
    for stage in settings.schedule:                                               # trust is earned step by step:
        begins = stage.trusts != trust.name
        if begins and stage.trusts == MAIN_PATCHES:                               # in connected layers,
            trust = trust_main_patches(raster, layers, *fit.look(state, layers, gate))
        elif begins:                                                              # then in what lies on its surface
            residual, weights = fit.look(state, layers, gate)
            trust = trust_proven(raster, layers, trust, residual, settings)
            fit = _fit_of_face(face, layers, trust, weights, lattice, fit)
        # minimised: Σ n/σ² (h − n·d)² + λ ∫ d_uu² + 2 d_uv² + d_vv², λ = stage.bending / (κ₀ l)²
        state = fit.step(state, _data(stage, points, layers, trust), noise, stage.bending, stage.gate)
        gate, noise = stage.gate, state.noise if trust.name == PROVEN else layers.noise
        if begins and trust.name == PROVEN:
            fit.allow_even_bending(state)
    _check_found(face, state.points)
    return FaceRegistration(face.name, fit.field(state), state.points, covered_share(raster, state.weights),
                            state.noise)


def _frame(face: FaceGeometry, lattice: tuple[int, int] | None, settings: RobustSettings,
           raster: Raster | None) -> tuple[Raster, RobustSettings]:
    """A raster with enough cells for the lattice, and the settings for a face of that size."""
    cells = max(_RASTER_CELLS, _CELLS_PER_CONTROL_POINT * int(np.prod(lattice or 0)))
    if raster is None or cells > _RASTER_CELLS:
        raster = make_raster(face, cells)
    # What lies farther than the face is long cannot be told from its surroundings.
    reach = min(settings.reach, float(max(raster.size * np.array(raster.shape))))
    return raster, replace(settings, reach=reach, margin=min(settings.margin, 0.5 * float(raster.depth.max())))


def _points_and_layers(face: FaceGeometry, scan: Array, raster: Raster, settings: RobustSettings,
                       ) -> tuple[FacePoints, Layers]:
    """The scan over the face and the layers it forms, without the walls beside the face where these are many."""
    points = face_points(raster, scan, settings.reach, settings.margin, settings.sample)
    _check_points(face, points, settings)
    layers = dense_layers(raster, points.sample)
    if np.mean(~layers.thin) > _MANY_WALLS and points.kept is not None and points.count <= _MOST_NORMALS:
        inner = points.kept[0]
        points = points.only(faces_alike(raster, inner, scan_normals(scan[inner.index])))
        _check_points(face, points, settings)
        layers = dense_layers(raster, points.sample)
    return points, replace(layers, density=layers.density * max(1.0, points.count / settings.sample))


def _fit_of_face(face: FaceGeometry, layers: Layers, trust: TrustedLayers, weights: Array,
                 lattice: tuple[int, int] | None, fit: RasterFit) -> RasterFit:
    """The fit with the lattice wanted, or else the one that the trusted layers determine by their ``weights`` (k,);
    without the cells that show nothing but other layers."""
    weights = weights * trust.layers
    _check_found(face, int(layers.count[weights > 0].sum()))
    size = lattice or automatic_lattice(face.surface, fit.raster, layers, weights, fit.settings.stiffness)
    if size != fit.size:
        fit = RasterFit(face, fit.raster, displacement_lattice(face.surface, size), fit.settings)
    fit.ignored = layers.part(~trust.layers).cells() & ~layers.part(trust.layers).cells()
    return fit


def _data(stage: RobustStage, points: FacePoints, layers: Layers, trust: TrustedLayers,
          ) -> FacePoints | SurfaceCoordinates | Layers:
    """What a stage is fitted to."""
    if stage.trusts != PROVEN:
        return layers.part(trust.layers)
    return points if stage.every_point else points.sample


def _check_points(face: FaceGeometry, points: FacePoints, settings: RobustSettings) -> None:
    if points.count < _LEAST_POINTS:
        raise RefusedError(
            f"The scan does not lie on {face.name}: {points.count} of its points are within {settings.reach:g} mm of "
            f"the face and at least {_LEAST_POINTS} are needed; check the unit and the alignment of the scan.")


def _check_found(face: FaceGeometry, points: int) -> None:
    if points < _LEAST_FITTED:
        raise RefusedError(f"The scan points near {face.name} do not form its surface: only {points} of them agree on "
                           f"one; leave the face out, or check the alignment of the scan.")


def _check_lattice(face: FaceGeometry, fit: RasterFit, points: FacePoints, automatic: bool) -> None:
    if fit.lattice.free <= np.count_nonzero(np.bincount(points.sample.in_cell[0])):
        return
    occupied = points.occupied()
    if fit.lattice.free <= occupied:
        return
    if automatic:
        raise RefusedError(
            f"The scan shows too little of {face.name}: its {points.count} points lie in {occupied} places, and at "
            f"least {fit.lattice.free} are needed; leave the face out or scan it from another side.")
    rows, columns = fit.lattice.unknown.shape
    raise RefusedError(
        f"The lattice {rows}x{columns} is too fine for {face.name}: its {fit.lattice.free} control points are not "
        f"determined by the {occupied} raster cells that hold scan points; choose a smaller lattice.")
