# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a run of figures changes, by a step or by a drift that sets in, and whether groups of parts differ."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as f_distribution

from ...registration.arrays import Array

_LEAST_BESIDE = 4
"""Parts on either side of a change: fewer tell no mean and no slope."""
_SHUFFLES = 399
_ERROR = 0.01
"""Share of steady runs in which a change is seen."""


@dataclass(frozen=True)
class Change:
    """A change in a run of figures.

    Attributes
    ----------
    kind : "step" or "drift"
    at : index of the first figure after it
    size : by how much the figures step, or drift to the end of the run
    p : how often a run without a change would show as much
    """

    kind: str
    at: int
    size: float
    p: float


@dataclass(frozen=True)
class GroupDifference:
    """Whether groups of parts differ in a figure.

    Attributes
    ----------
    means : mean of each group by its name
    p : how often groups that do not differ would show as much (analysis of variance)
    differ : whether they do, with less than one error in a hundred
    """

    means: dict[str, float]
    p: float
    differ: bool


def find_change(figures: Array) -> Change | None:
    """The one change that explains a run of figures best; None where it needs none.

    Parameters
    ----------
    figures : (n,) in the order of time

    Notes
    -----
    For every place both models are fitted by least squares: a step there, and a slope that sets in there. The better
    one is compared with what shuffled runs show (seeded, so that the answer is the same every time): nothing is
    assumed of the distribution.
    """
    figures = np.asarray(figures, dtype=float)
    count = len(figures)
    if count < 2 * _LEAST_BESIDE or np.ptp(figures) <= 1e-12 * max(1.0, float(np.abs(figures).max())):
        return None
    places = np.arange(_LEAST_BESIDE, count - _LEAST_BESIDE + 1)
    steps = _regressor((np.arange(count) >= places[:, None]).astype(float))
    drifts = _regressor(np.maximum(np.arange(count) - places[:, None] + 1.0, 0.0))
    centred = figures - figures.mean()
    gains = np.stack([(rows @ centred) ** 2 for rows in (steps, drifts)])
    kind, place = np.unravel_index(int(np.argmax(gains)), gains.shape)
    random = np.random.default_rng(0)
    both = np.concatenate([steps, drifts])
    others = np.stack([random.permutation(centred) for _ in range(_SHUFFLES)], axis=1)
    p = float((1 + (((both @ others) ** 2).max(axis=0) >= gains.max()).sum()) / (1 + _SHUFFLES))
    if p > _ERROR:
        return None
    at = int(places[place])
    if kind == 0:
        size = float(figures[at:].mean() - figures[:at].mean())
    else:
        ramp = np.maximum(np.arange(count) - at + 1.0, 0.0)
        slope = float(np.polyfit(ramp, figures, 1)[0])
        size = slope * ramp[-1]
    return Change(("step", "drift")[kind], at, size, p)


def _regressor(rows: Array) -> Array:
    """Rows (k, n) without their mean and of unit length: the square of a product with them is what they explain."""
    rows = rows - rows.mean(axis=1, keepdims=True)
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def group_difference(figures: Array, groups: Sequence[str]) -> GroupDifference | None:
    """Whether groups differ in their mean figure; None where there are no two groups of two parts.

    Parameters
    ----------
    figures : (n,) of the parts
    groups : (n,) the name of the group of each part, empty for those of none
    """
    names = np.array(groups)
    samples = {str(name): figures[names == name] for name in dict.fromkeys(groups) if name}
    samples = {name: sample for name, sample in samples.items() if len(sample) > 1}
    if len(samples) < 2:
        return None
    everything = np.concatenate(list(samples.values()))
    between = sum(len(sample) * (sample.mean() - everything.mean()) ** 2 for sample in samples.values())
    within = sum(((sample - sample.mean()) ** 2).sum() for sample in samples.values())
    first, second = len(samples) - 1, len(everything) - len(samples)
    p = float(f_distribution.sf(between / first / max(within / second, 1e-300), first, second))
    return GroupDifference({name: float(sample.mean()) for name, sample in samples.items()}, p, p <= _ERROR)
