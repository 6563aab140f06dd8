# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mean part, and how far parts scatter about it: what the measurement adds to that is taken out."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from ...registration.arrays import Array

_TAIL = 0.025


@dataclass(frozen=True)
class SeriesPlaces:
    """Places on a part.

    Attributes
    ----------
    position : (n, 3) on the nominal part, in mm
    normal : (n, 3) outward unit normals on faces; zero along edges
    weight : (n,) share of the part's surface that a place on a face stands for; zero along edges
    owner : (n,) name of the face or edge
    """

    position: Array
    normal: Array
    weight: Array
    owner: NDArray[np.str_]


@dataclass(frozen=True)
class SeriesScatter:
    """Mean and scatter of displacements at n places.

    Attributes
    ----------
    parts : how many there were
    mean : (n, 3) mean displacement in mm
    sigma : (n,) standard deviation of that mean, of a part's displacement along its normal (along edges: of its
        length), in mm
    total : (n,) variance over parts in mm², along the normal on faces, across all directions along edges
    measurement : (n,) share of it that the measurement explains, NaN where nothing tells
    """

    parts: int
    mean: Array
    sigma: Array
    total: Array
    measurement: Array


@dataclass(frozen=True)
class OwnerScatter:
    """Mean and scatter of a face or an edge; lengths in mm.

    Attributes
    ----------
    name : "Face3"
    mean : mean displacement along the normal of a face; of an edge, its mean length
    total, measurement : standard deviations over parts, and what the measurement explains of it (None: not known)
    process : what is left, None where the measurement's share is not known
    interval : 95 % interval of ``process``
    """

    name: str
    mean: float
    total: float
    measurement: float | None
    process: float | None
    interval: tuple[float, float] | None


def find_scatter(moved: Array, sigma: Array, places: SeriesPlaces) -> SeriesScatter:
    """Mean and scatter of the displacements of parts.

    Parameters
    ----------
    moved : (parts, n, 3) in mm
    sigma : (parts, n) standard deviation of each measurement in mm, NaN where it is not known
    places : of the n places
    """
    parts = len(moved)
    mean = moved.mean(axis=0)
    off = moved - mean
    along = np.einsum("pnx,nx->pn", off, places.normal)
    freedom = max(parts - 1, 1)
    total = np.where(places.normal.any(axis=1), (along**2).sum(axis=0), (off**2).sum(axis=(0, 2))) / freedom
    known = np.isfinite(sigma)
    measurement = np.where(known, sigma, 0.0) ** 2
    count = known.sum(axis=0)
    measured = np.where(count > 0, measurement.sum(axis=0) / np.maximum(count, 1), np.nan)
    spread = total if parts > 1 else measured
    return SeriesScatter(parts, mean, np.sqrt(spread / parts), total, measured)


def owner_scatter(found: SeriesScatter, places: SeriesPlaces) -> list[OwnerScatter]:
    """The scatter of each face and edge, in the order in which they come.

    The process's variance is that of the parts less that of the measurement, no less than 0. Its interval is that of
    a variance with as many degrees of freedom as there are parts but one (chi square), less the measurement's: places
    on one face move together, so that they count as one.
    """
    result, freedom = [], max(found.parts - 1, 1)
    quantiles = chi2.ppf([1.0 - _TAIL, _TAIL], freedom)
    for name in dict.fromkeys(places.owner.tolist()):
        own = places.owner == name
        along = np.einsum("nx,nx->n", found.mean[own], places.normal[own])
        mean = float(along.mean()) if places.normal[own].any() else float(
            np.linalg.norm(found.mean[own], axis=1).mean())
        total, measurement = float(found.total[own].mean()), float(found.measurement[own].mean())
        process = interval = None
        if np.isfinite(measurement) and found.parts > 1:
            low, high = (max(0.0, freedom * total / quantile - measurement) ** 0.5 for quantile in quantiles)
            process, interval = max(0.0, total - measurement) ** 0.5, (float(low), float(high))
        result.append(OwnerScatter(str(name), mean, total**0.5, measurement**0.5 if np.isfinite(measurement) else None,
                                   process, interval))
    return result
