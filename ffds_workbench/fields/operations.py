# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is done with fields. Where two have different places, the second is taken at those of the first."""
from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError
from ..registration.arrays import Array
from ..registration.motions import apply
from .field import VectorField

_SAME_PLACES = 1e-6
"""Places nearer than this (mm) are one (unit: of a file's digits)."""
_REACH = 3.0
"""How far smoothing looks, in standard deviations of its weights (theory: beyond lies a hundredth of them)."""
_MOST_NEIGHBOURS = 400
"""Vectors that smoothing looks at around one, at most (unit: memory); where they lie denser than some 14 to the
square of the length, fewer are averaged than its weights reach."""


@dataclass(frozen=True)
class FieldMean:
    """The mean of several fields, and how far they differ.

    Attributes
    ----------
    common : what all have in common; its sigma is the standard deviation of the mean
    scatter : (n,) standard deviation in mm of one field about it, along the direction in which it is
        largest; of a single field its sigma, 0 where unknown
    """

    common: VectorField
    scatter: Array


def total(first: VectorField, second: VectorField) -> VectorField:
    """The ``first`` field and with it the ``second``, both told of the same nominal part."""
    return _combined(first, second, 1.0)


def difference(first: VectorField, second: VectorField) -> VectorField:
    """The ``first`` field without the ``second``."""
    return _combined(first, second, -1.0)


def _combined(first: VectorField, second: VectorField, sign: float) -> VectorField:
    vectors = first.displacements + sign * at_places(second, first.positions)
    if first.sigma is None or second.sigma is None or not _same_places(first.positions, second.positions):
        return replace(first, displacements=vectors)
    return replace(first, displacements=vectors, sigma=np.hypot(first.sigma, second.sigma))


def at_places(field: VectorField, places: Array) -> Array:
    """A field's displacements at places (n, 3): its own vectors where they are its own places."""
    return field.displacements if _same_places(field.positions, places) else field.at(places)


def _same_places(first: Array, second: Array) -> bool:
    return first.shape == second.shape and bool(np.abs(first - second).max() < _SAME_PLACES)


def mean(fields: Sequence[VectorField]) -> FieldMean:
    """The mean of fields of several parts of one kind, at the places of the first.

    Raises
    ------
    InputError : there is no field
    """
    if not fields:
        raise InputError("There is no field to take the mean of.")
    first, count = fields[0], len(fields)
    values = np.array([at_places(field, first.positions) for field in fields])
    common = values.mean(axis=0)
    if count == 1:
        return FieldMean(first, np.zeros(len(first)) if first.sigma is None else first.sigma)
    scatter = largest_scatter(values)
    return FieldMean(replace(first, displacements=common, sigma=scatter / np.sqrt(count)), scatter)


def largest_scatter(vectors: Array) -> Array:
    """Standard deviation (n,) of ``vectors`` (parts, n, 3) of some parts, in the direction where it is largest."""
    apart = vectors - vectors.mean(axis=0)
    spread = np.einsum("fni,fnj->nij", apart, apart) / (len(vectors) - 1)
    return np.sqrt(np.maximum(np.linalg.eigvalsh(spread)[:, -1], 0.0))


def scaled(field: VectorField, factor: float | Sequence[float]) -> VectorField:
    """The field times a factor, or times one for each of x, y and z. −1 reverses it.

    Raises
    ------
    InputError : a factor is no number
    """
    factors = np.broadcast_to(np.asarray(factor, dtype=float), 3)
    if not np.isfinite(factors).all():
        raise InputError("A factor of a field is no number.")
    sigma = None if field.sigma is None else field.sigma * np.abs(factors).max()
    return replace(field, displacements=field.displacements * factors, sigma=sigma)


def smoothed(field: VectorField, length: float) -> VectorField:
    """Every vector replaced by the plane through those around it, weighed by a normal distribution.

    Parameters
    ----------
    field : to be smoothed
    length : standard deviation of the weights in mm

    Raises
    ------
    InputError : the length is not above 0
    """
    if not length > 0:
        raise InputError(f"A smoothing length of {length:g} mm makes no sense: give one above 0.")
    tree = cKDTree(field.positions)
    near, distance = min(_MOST_NEIGHBOURS, len(field)), _REACH * length
    result = np.empty_like(field.displacements)
    for some in np.array_split(np.arange(len(field)), len(field) // 2000 + 1):
        gap, who = tree.query(field.positions[some], near, distance_upper_bound=distance)
        gap, who = gap.reshape(len(some), near), who.reshape(len(some), near)
        there = np.minimum(who, len(field) - 1)
        weight = np.where(np.isfinite(gap), np.exp(-0.5 * (np.where(np.isfinite(gap), gap, 0.0) / length) ** 2), 0.0)
        offset = (field.positions[there] - field.positions[some][:, None]) / length
        rows = np.concatenate([np.ones((*gap.shape, 1)), offset], axis=2)
        normal = np.einsum("nk,nki,nkj->nij", weight, rows, rows) + 1e-6 * np.eye(4)
        right = np.einsum("nk,nki,nkx->nix", weight, rows, field.displacements[there])
        result[some] = np.linalg.solve(normal, right)[:, 0]
    return replace(field, displacements=result)


def limited(field: VectorField, largest: float) -> VectorField:
    """Vectors of a ``field`` longer than ``largest`` (mm) shortened to it (InputError if it is negative)."""
    if not largest >= 0:
        raise InputError(f"A largest displacement of {largest:g} mm makes no sense: give one of 0 or more.")
    length = np.linalg.norm(field.displacements, axis=1, keepdims=True)
    return replace(field, displacements=field.displacements * np.minimum(1.0, largest / np.maximum(length, 1e-300)))


def masked(field: VectorField, faces: Collection[int]) -> VectorField:
    """Only what lies on faces, numbered from 1, moves; all other places stay.

    Raises
    ------
    InputError : the field does not know on which faces its places lie
    """
    if field.faces is None:
        raise InputError("The field does not tell the faces of its places: make it from two models, or of a mesh.")
    return replace(field, displacements=np.where(np.isin(field.faces, list(faces))[:, None], field.displacements, 0.0))


def transformed(field: VectorField, pose: Array) -> VectorField:
    """The field of a part that stands elsewhere: places and vectors moved by a pose (4, 4)."""
    return replace(field, positions=apply(pose, field.positions), displacements=field.displacements @ pose[:3, :3].T)
