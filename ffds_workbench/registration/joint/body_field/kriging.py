# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kriging of a displacement in space from single components of it: Gaussian process regression of a vector field.

Formulas and their numbers are those of Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006. The three
components of the field are alike and independent; its length, size and noise are the likeliest ones (eq. 5.8). Own code
because scikit-learn's regression takes scalar values only, not components in a direction of its own at each place.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import product

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.spatial.distance import cdist

from ...arrays import Array, Index

_TRIED_LENGTHS = (0.06, 0.1, 0.16, 0.25, 0.4, 0.7)
"""Tried for the length over which the field changes, relative to the extent of the places (unit)."""
_TRIED_NOISES = (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Tried for the variance of the noise, relative to that of the field (unit)."""
_LEAST_MOVEMENT = 1e-8
"""Standard deviation of a part that has not moved at all, over the extent of the places (unit)."""
_LIKELIHOOD_SAMPLE = 400
"""Number of observations that the likelihood is computed from (unit: time)."""
_LOT = 512
"""Places that are looked at together (unit: memory)."""


@dataclass(frozen=True)
class Observations:
    """What is known of the field: direction · f(place) = value, with a standard deviation of √variance.

    Attributes
    ----------
    place, direction : (n, 3) in mm, and unit vectors
    body : (n,) number of the body that a place belongs to
    value : (n,) in mm
    noise : (n,) variance relative to the noise that is common to all, which is found; 0 where it is known
    variance : (n,) known variance in mm², 0 where it is to be found
    """

    place: Array
    direction: Array
    body: Index
    value: Array
    noise: Array
    variance: Array

    def take(self, which: Index) -> Observations:
        return Observations(*(values[which] for values in vars(self).values()))


@dataclass(frozen=True)
class FieldModel:
    """A field of one kind: ``smooth`` to all orders, or with two derivatives; bodies ``apart`` move by themselves.

    ``length`` in mm, ``variance`` of a component in mm², ``noise`` relative to it.
    """

    smooth: bool
    apart: bool
    length: float
    variance: float = 1.0
    noise: float = 0.0

    def correlation(self, first: Array, first_body: Index, second: Array, second_body: Index) -> Array:
        """Between places (n, 3) and (m, 3): (n, m), the squared exponential (4.9) or Matérn 5/2 (4.17)."""
        distance = cdist(first, second) / self.length
        if self.smooth:
            result: Array = np.exp(-0.5 * distance**2)
        else:
            scaled = np.sqrt(5.0) * distance
            result = (1 + scaled + scaled**2 / 3) * np.exp(-scaled)
        return result * (first_body[:, None] == second_body) if self.apart else result

    def between(self, seen: Observations) -> Array:
        """Covariance of the observations without noise, over the variance: (n, n)."""
        return self.correlation(seen.place, seen.body, seen.place, seen.body) * (seen.direction @ seen.direction.T)


@dataclass(frozen=True)
class Pose:
    """Six means of a field over places (q, 3) on bodies (q,): its translation and rotation of them as a whole.

    ``rows`` (6, q, 3) give them in mm, rotations as the movement that they cause.
    """

    place: Array
    body: Index
    rows: Array

    @classmethod
    def of(cls, place: Array, body: Index) -> Pose:
        arm = place - place.mean(axis=0)
        arm /= max(float(np.sqrt((arm**2).sum(axis=1).mean())), 1e-12)
        rows = [np.broadcast_to(axis, arm.shape) for axis in np.eye(3)] + [np.cross(axis, arm) for axis in np.eye(3)]
        return cls(place, body, np.stack(rows) / len(place))


@dataclass(frozen=True)
class Field:
    """The field given the observations, and a pose that it is known to have."""

    model: FieldModel
    seen: Observations
    pose: Pose
    factor: Array
    weight: Array

    def mean(self, place: Array, body: Index) -> Array:
        """Mean (n, 3) in mm at places (n, 3) on bodies (n,) (2.25)."""
        return np.concatenate([(self.weight @ self._cross(*some)).reshape(-1, 3) for some in _lots(place, body)])

    def covariance(self, place: Array, body: Index) -> Array:
        """Covariance (n, 3, 3) in mm² of the field there, without noise (2.26)."""
        known = []
        for some in _lots(place, body):
            rows = solve_triangular(self.factor, self._cross(*some), lower=True, check_finite=False)
            rows = rows.reshape(len(rows), -1, 3)
            known.append(np.matmul(rows.transpose(1, 2, 0), rows.transpose(1, 0, 2)))
        return self.model.variance * (np.eye(3) - np.concatenate(known))

    def _cross(self, place: Array, body: Index) -> Array:
        """Between what is known and all components there: (observations + 6, 3 n)."""
        across = self.model.correlation(self.seen.place, self.seen.body, place, body)
        seen = (across[:, :, None] * self.seen.direction[:, None]).reshape(len(across), -1)
        return np.concatenate([seen, _with_pose(self.model, self.pose, place, body).reshape(6, -1)])


def _lots(place: Array, body: Index) -> list[tuple[Array, Index]]:
    """Places in lots that need little memory: at least one, (n, 3) and (n,) each."""
    starts = range(0, max(len(place), 1), _LOT)
    return [(place[start : start + _LOT], body[start : start + _LOT]) for start in starts]


def _with_pose(model: FieldModel, pose: Pose, place: Array, body: Index) -> Array:
    """Between the pose and the components at places (n, 3): (6, n, 3)."""
    across = model.correlation(place, body, pose.place, pose.body)
    return np.matmul(across, pose.rows)


def most_likely_model(seen: Observations) -> FieldModel:
    """The likeliest model of observations whose noise is to be found; its variance has a closed form."""
    few = seen.take(np.flatnonzero(seen.noise > 0)[:_LIKELIHOOD_SAMPLE])
    extent = float(np.linalg.norm(np.ptp(few.place, axis=0)))
    best = -np.inf, FieldModel(True, False, extent)
    start = len(_TRIED_LENGTHS) // 2, len(_TRIED_NOISES) // 2
    for smooth, apart in product((True, False), (False, True) if np.ptp(few.body) else (False,)):
        models = [FieldModel(smooth, apart, length * extent) for length in _TRIED_LENGTHS]
        between = cache(lambda length, models=models: models[length].between(few))
        tried: dict[tuple[int, int], tuple[float, FieldModel]] = {}
        around = [start]
        while around:
            for length, noise in around:
                model = replace(models[length], noise=_TRIED_NOISES[noise])
                tried[length, noise] = _likelihood(model, few, between(length), (_LEAST_MOVEMENT * extent) ** 2)
            start = max(tried, key=lambda at: tried[at][0])
            around = [at for at in _grid_neighbours(*start) if at not in tried]
        best = max(best, tried[start], key=lambda found: found[0])
    return best[1]


def overconfidence(model: FieldModel, seen: Observations, block: Index) -> float:
    """Factor, ≥ 1, by which the true variance exceeds the stated one when the field predicts a block from all others.

    Every block (n,) of observations is left out in turn (eq. 5.10 to 5.12, for blocks: the inverse of K's own block).
    """
    some = np.flatnonzero(seen.noise > 0)[:_LIKELIHOOD_SAMPLE]
    few, block = seen.take(some), block[some]
    factor = cholesky(model.between(few) + np.diag(model.noise * few.noise), lower=True, check_finite=False)
    inverse = cho_solve((factor, True), np.eye(len(some)), check_finite=False)
    pull = inverse @ few.value
    ratio = 0.0
    for number in np.unique(block):
        own = np.flatnonzero(block == number)
        covariance = np.linalg.inv(inverse[np.ix_(own, own)])
        ratio += len(own) * float(((covariance @ pull[own]) ** 2).sum() / np.trace(covariance))
    return max(1.0, ratio / (model.variance * len(some)))


def _grid_neighbours(length: int, noise: int) -> list[tuple[int, int]]:
    """Neighbours of a model on the grid of lengths and noises."""
    return list(product(range(max(0, length - 1), min(length + 2, len(_TRIED_LENGTHS))),
                        range(max(0, noise - 1), min(noise + 2, len(_TRIED_NOISES)))))


def _likelihood(model: FieldModel, seen: Observations, between: Array, least: float) -> tuple[float, FieldModel]:
    """Logarithm of the likelihood, less what all models share, of a model with its likeliest variance, which is
    ``least`` mm² or more."""
    factor = cholesky(between + np.diag(model.noise * seen.noise), lower=True, check_finite=False)
    white = solve_triangular(factor, seen.value, lower=True, check_finite=False)
    variance = max(float(white @ white) / len(white), least)
    score = -0.5 * len(white) * np.log(variance) - np.log(np.diag(factor)).sum()
    return float(score), replace(model, variance=variance)


def condition(model: FieldModel, seen: Observations, pose: Pose, pose_variance: float) -> Field:
    """The field of a model given the observations, and that its pose is zero within a variance in mm²."""
    with_seen = np.einsum("jnx,nx->jn", _with_pose(model, pose, seen.place, seen.body), seen.direction)
    with_pose = np.einsum("jqx,iqx->ji", _with_pose(model, pose, pose.place, pose.body), pose.rows)
    between = np.block([[model.between(seen), with_seen.T], [with_seen, with_pose]])
    variance = np.append(model.noise * seen.noise + seen.variance / model.variance,
                         np.full(6, pose_variance / model.variance))
    factor = cholesky(between + np.diag(variance), lower=True, check_finite=False)
    known = np.append(seen.value, np.zeros(6))
    return Field(model, seen, pose, factor, cho_solve((factor, True), known, check_finite=False))
