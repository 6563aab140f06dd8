# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a part may have deformed: a smooth displacement of space that its material resists.

The displacement d(X) of the nominal place X has a Gaussian process as its prior, with the squared exponential
covariance s² exp(−|X − Y|²/2ℓ²) (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006). The power
series of exp(X·Y/ℓ²) has the monomials Xᵅ with variances s²/(ℓ^2|α| α!): those of low degree are kept. The material
resists by Green's strain ½(FᵀF − 1), with F = 1 + ∇d, along the surface and through it.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations_with_replacement
from math import factorial, prod, sqrt

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...robust_weights import MAD_TO_SIGMA, TUKEY_SIGMAS, quantile, tukey
from ..model import SurfaceSamples, Target, kept_with_target
from ..settings import LARGEST_DEGREE, DeformationSettings

_SURFACE_STRAIN = (0, 0, 1.0), (1, 1, 1.0), (0, 1, sqrt(2.0))
"""Components (i, j) of the strain tensor within the surface, in a frame of two tangents and the normal. The third
number is the square root of how often the component occurs in the symmetric tensor (theory)."""
_THICKNESS_STRAIN = (2, 2, 1.0), (0, 2, sqrt(2.0)), (1, 2, sqrt(2.0))
"""The same through the thickness (theory)."""


@dataclass(frozen=True, eq=False)
class DisplacementBasis:
    """Basis of the smooth displacements of a part: monomials of low degree.

    Attributes
    ----------
    size : of the part in mm
    middle : (3,) in mm; monomials are those of (X − middle) / (size / 2)
    box : (2, 3) lower and upper end of what they are evaluated at
    parents : for each monomial but the first, the one that it is a multiple of, and the axis of the factor
    degree, precision : (k,) of each monomial, and 1/variance of its coefficient in units of 1/s²
    frames : (3, 3, m) components of the tangents and the normal at some places of the surface
    slopes : (3, k, m) derivatives of the monomials there along each of the three, in 1/mm
    settings : what is expected of a deformation
    """

    size: float
    middle: Array
    box: Array
    parents: tuple[tuple[int, int], ...]
    degree: NDArray[np.intp]
    precision: Array
    frames: Array
    slopes: Array
    settings: DeformationSettings

    def values(self, places: Array, count: int) -> NDArray[np.float32]:
        """The first monomials at places (n, 3): (count, n). Single precision is a micrometre for a part of some m."""
        x = ((places - self.middle) * (2.0 / self.size)).T.astype(np.float32)
        np.clip(x, self.box[0][:, None], self.box[1][:, None], out=x)
        result = np.empty((count, len(places)), dtype=np.float32)
        result[0] = 1.0
        for number, (parent, axis) in enumerate(self.parents[: count - 1], start=1):
            np.multiply(result[parent], x[axis], out=result[number])
        return result


@kept_with_target
def displacement_basis(target: Target) -> DisplacementBasis:
    """The displacements of a part."""
    half, settings = 0.5 * target.size, target.settings.deformation
    x = (target.samples.points - target.centre) / half
    powers: list[tuple[int, ...]] = []
    deviations = []
    for power in (p for d in range(LARGEST_DEGREE + 1) for p in combinations_with_replacement(range(3), d)):
        exponents = np.array([power.count(axis) for axis in range(3)])
        deviation = 1.0 / (sqrt(prod(factorial(int(e)) for e in exponents)) * settings.correlation ** len(power))
        moves = deviation * np.prod(np.abs(x).max(axis=0) ** exponents) > settings.negligible
        if len(power) < 2 or (moves and power[:-1] in powers):
            powers.append(power)
            deviations.append(deviation)
    some = target.even[np.arange(0, len(target.even.area), 1 + len(target.even.area) // settings.strain_points)]
    frames = np.ascontiguousarray(np.concatenate([some.tangents, some.normals[:, None]], axis=1).transpose(1, 2, 0))
    slopes = np.einsum("nka,ian->ikn", _gradients(powers, some, target.centre, half), frames)
    box = np.stack([x.min(axis=0) - settings.box_margin, x.max(axis=0) + settings.box_margin]).astype(np.float32)
    return DisplacementBasis(target.size, target.centre, box,
                             tuple((powers.index(power[:-1]), power[-1]) for power in powers[1:]),
                             np.array([len(power) for power in powers]), np.array(deviations) ** -2.0, frames, slopes,
                             settings)


def _gradients(powers: list[tuple[int, ...]], samples: SurfaceSamples, middle: Array, half: float) -> Array:
    """Gradients of the monomials at the samples, (n, k, 3) in 1/mm."""
    x = (samples.points - middle) / half
    result = np.zeros((len(x), len(powers), 3))
    for number, power in enumerate(powers):
        for axis in set(power):
            rest = list(power)
            rest.remove(axis)
            result[:, number, axis] = power.count(axis) * x[:, rest].prod(axis=1) / half
    return result


@dataclass(frozen=True)
class DisplacementField:
    """d(X) = Σ c_k m_k(X), with the first monomials of a space; ``coefficients`` (k, 3) in mm."""

    space: DisplacementBasis
    coefficients: Array

    def __call__(self, places: Array) -> Array:
        """Displacements of nominal places (n, 3), in mm."""
        values = self.space.values(places, len(self.coefficients))
        return (self.coefficients.T.astype(np.float32) @ values).T.astype(float)

    @property
    def is_none(self) -> bool:
        """Whether no deformation was looked for."""
        return len(self.coefficients) == 1

    def straightened(self, points: Array, near: Array) -> Array:
        """The nominal places (n, 3) that have moved to points (n, 3), one step nearer than places near them."""
        return points - self(near)

    def moved(self, motion: Array) -> DisplacementField:
        """The deformation of the part after a ``motion`` (4, 4) of it as a whole."""
        turn, half = motion[:3, :3], 0.5 * self.space.size
        coefficients = self.of_degree(max(1, int(self.space.degree[len(self.coefficients) - 1]))).coefficients @ turn.T
        coefficients[0] += (turn - np.eye(3)) @ self.space.middle + motion[:3, 3]
        coefficients[1:4] += half * (turn - np.eye(3)).T
        return replace(self, coefficients=coefficients)

    def of_degree(self, degree: int) -> DisplacementField:
        """The same with the monomials up to a degree."""
        count = int(np.searchsorted(self.space.degree, degree, side="right"))
        coefficients = np.zeros((count, 3))
        coefficients[: len(self.coefficients)] = self.coefficients[:count]
        return replace(self, coefficients=coefficients)

    def strains(self, components: tuple[tuple[int, int, float], ...]) -> tuple[Array, Array]:
        """Components of Green's strain at the space's places, (s,), and their derivatives by the coefficients, (3k, s);
        ``components`` are pairs of directions with the root of how often each stands in the tensor."""
        slopes = self.space.slopes[:, : len(self.coefficients)]
        moved = self.space.frames + self.coefficients.T @ slopes
        values, rows = [], []
        for i, j, share in components:
            values.append(0.5 * share * ((moved[i] * moved[j]).sum(axis=0) - float(i == j)))
            row = slopes[j][:, None] * moved[i] + slopes[i][:, None] * moved[j]
            rows.append(0.5 * share * row.reshape(-1, row.shape[-1]))
        return np.concatenate(values), np.concatenate(rows, axis=1)


def no_displacement(target: Target) -> DisplacementField:
    """No deformation at all."""
    return DisplacementField(displacement_basis(target), np.zeros((1, 3)))


@dataclass(frozen=True)
class DisplacementObservations:
    """Observed displacements of places, in one direction each.

    Attributes
    ----------
    places, directions : (n, 3) in mm and unit vectors
    displacement, residual : (n,) in mm: the displacement, and how much of it is not reached yet
    weight : (n,) in units of 1/variance of the points on the faces
    cutoff : least cut-off in mm of Tukey's weights
    """

    places: Array
    directions: Array
    displacement: Array
    residual: Array
    weight: Array
    cutoff: float

    @property
    def spread(self) -> float:
        """Standard deviation of what is left in mm, by its median."""
        return MAD_TO_SIGMA * quantile(np.abs(self.residual), 0.5)

    def robust(self) -> Array:
        """Weights (n,) after those that are far off are left out."""
        return self.weight * tukey(self.residual, max(TUKEY_SIGMAS * self.spread, self.cutoff))


def fit_displacement(start: DisplacementField, heights: DisplacementObservations,
                     ends: DisplacementObservations | None = None, noise: float | None = None) -> DisplacementField:
    """One Gauss-Newton step towards the likeliest deformation.

    Parameters
    ----------
    start : the deformation so far; its monomials are those that are fitted
    heights : displacements observed on the faces
    ends : displacements observed where the scan ends
    noise : standard deviation of the points in mm; with it, the weight of the surface strain is adapted to the strain
        so far: the larger the strain, the smaller its weight
    """
    space, count, settings = start.space, len(start.coefficients), start.space.settings
    coefficients = start.coefficients.ravel()
    deviation = max(heights.spread, settings.least_spread * space.size) / (settings.amplitude * space.size)
    matrix = np.diag(np.repeat(space.precision[:count] * deviation**2, 3))
    right = np.zeros(3 * count)
    number, places = len(heights.places), space.frames.shape[-1]
    for components in (_SURFACE_STRAIN, _THICKNESS_STRAIN):
        strain, rows = start.strains(components)
        cost = settings.strain_cost * space.size
        if noise is not None and components is _SURFACE_STRAIN:
            square = max(float(strain @ strain) / places, 1e-12)
            least, most = (bound * space.size for bound in settings.strain_bounds)
            cost = max(heights.spread, noise) * sqrt(settings.strain_heights / number / square)
            cost = min(max(cost, least), most)
        share = cost**2 * number / places
        matrix += share * (rows @ rows.T)
        right += share * (rows @ (coefficients @ rows - strain))
    for observed in (heights, ends) if ends is not None else (heights,):
        root = np.sqrt(observed.robust())
        directions = (root * observed.directions.T).astype(np.float32)
        rows = (space.values(observed.places, count)[:, None] * directions).reshape(3 * count, -1)
        matrix += rows @ rows.T
        right += rows @ (root * observed.displacement).astype(np.float32)
    return replace(start, coefficients=np.linalg.solve(matrix, right).reshape(-1, 3))
