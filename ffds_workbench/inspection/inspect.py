# SPDX-License-Identifier: LGPL-2.1-or-later
"""A plan held against an as-built model: values, what they may be off by, and verdicts (ISO 14253-1)."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from ..registration.arrays import Array
from ..report.stopwatch import Progress
from .characteristics import zone_value
from .dimensions import dimension_value, nominal_dimension
from .features import InspectedFeature
from .frames import Frame
from .plan import ZONES, Plan, PlanItem
from .sampling import PartPair

Verdict = Literal["pass", "fail", "undecided"]
_DRAWS = 400
_TAIL = 0.025
"""Of a 95 % interval, at either end: a verdict is wrong at most so often."""


@dataclass(frozen=True)
class Inspected:
    """One characteristic, inspected. Lengths in mm, angles in degrees.

    Attributes
    ----------
    name, characteristic, of, datums : of the plan
    value : by the minimum zone where it is a zone, else by least squares
    least_squares : the value by least squares
    local : lowest and highest local value, of a thickness, a gap or a flush
    band : half the width of the 95 % interval; None where the feature was not measured
    interval : 95 % interval of the value
    nominal, lower, upper : the nominal value of a dimension, and the limits of the value
    verdict : "pass" and "fail" where the whole interval says so, else "undecided"
    advice : what would decide it
    """

    name: str
    characteristic: str
    of: tuple[str, ...]
    datums: tuple[str, ...]
    value: float
    least_squares: float
    local: tuple[float, float] | None
    band: float | None
    interval: tuple[float, float] | None
    nominal: float | None
    lower: float | None
    upper: float | None
    verdict: Verdict
    advice: str = ""


@dataclass(frozen=True)
class Inspection:
    """A plan, inspected."""

    items: tuple[Inspected, ...]
    exact: bool

    @property
    def verdict(self) -> Verdict:
        """Of the part: "fail" if one item fails, "pass" if all pass."""
        found = {item.verdict for item in self.items}
        return "fail" if "fail" in found else "undecided" if "undecided" in found else "pass"

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return {"verdict": self.verdict, "bands_known": not self.exact, "items": [asdict(item) for item in self.items]}

    def table(self) -> str:
        """As text."""
        lines = [f"{'':<24}{'':<18}{'value':>10}{'± band':>10}{'lower':>10}{'upper':>10}  verdict"]
        for item in self.items:
            figures = "".join(f"{'–' if figure is None else format(figure, '.4f'):>10}"
                              for figure in (item.value, item.band, item.lower, item.upper))
            lines.append(f"{item.name[:23]:<24}{item.characteristic:<18}{figures}  {item.verdict}")
        lines += [f"{item.name}: {item.advice}" for item in self.items if item.advice]
        if self.exact:
            lines.append("No report was given: the model is taken as exact, and its bands as 0.")
        return "\n".join([*lines, f"The part: {self.verdict}"])


def inspect_shapes(plan: Plan, parts: PartPair, progress: Progress = lambda text: None) -> Inspection:
    """Hold a plan against an as-built model.

    Parameters
    ----------
    plan : what is to be inspected
    parts : the nominal and the as-built model
    progress : called with what is being done

    Raises
    ------
    InputError : the plan names what the model does not have, or a characteristic that a feature cannot have
    """
    known: dict[str, tuple[InspectedFeature, Array]] = {}

    def feature(name: str) -> tuple[InspectedFeature, Array]:
        if name not in known:
            known[name] = parts.feature(name)
        return known[name]

    box = parts.nominal.shape.BoundBox
    start = Frame(np.array(tuple(box.Center)), float(box.DiagonalLength))
    items = []
    for item in plan.items:
        progress(f"Inspecting {item.name}")
        items.append(_inspected(item, plan, feature, start, parts))
    return Inspection(tuple(items), parts.known.entries is None)


def _inspected(item: PlanItem, plan: Plan, feature: Callable[[str], tuple[InspectedFeature, Array]], start: Frame,
               parts: PartPair) -> Inspected:
    pairs = [feature(name) for name in item.of]
    features, datums = [own for own, _ in pairs], [feature(plan.datums[letter])[0] for letter in item.datums]
    random = np.random.default_rng(0)
    nominal, local = None, None
    upper, lower = item.upper, item.lower
    if item.characteristic in ZONES:
        found = zone_value(item.characteristic, features, datums, start, _DRAWS, random)
        values, draws, squares = np.full(3, found.least), np.repeat(found.draws[:, None], 3, axis=1), found.squares
        intervals = _intervals(values, draws)
        if found.least <= np.quantile(found.floor, 1.0 - _TAIL):
            intervals[:, 0] = 0.0  # errors alone show as much
        intervals = np.maximum(intervals, 0.0)
        if item.condition != "rfs":
            bonus, more = _bonus(item, features[0], random)
            upper = (upper or 0.0) + bonus
            intervals = np.maximum(_intervals(values, draws - more[:, None]), 0.0)
    else:
        size = dimension_value(item.characteristic, features, _DRAWS, random)
        values, draws, squares = size.values, size.draws, float(size.values[0])
        intervals = _intervals(values, draws)
        nominal = item.nominal
        if nominal is None:
            nominal = nominal_dimension(item.characteristic, features, [points for _, points in pairs])
        lower, upper = (None if limit is None else nominal + limit for limit in (item.lower, item.upper))
        local = (float(values[1]), float(values[2])) if values[1] != values[2] else None
    unseen = [own.name for own in (*features, *datums) if parts.known.unknown(own.name)]
    verdict = "undecided" if unseen else _verdict(intervals, lower, upper)
    low, high = (float(end) for end in intervals[0])
    return Inspected(item.name, item.characteristic, item.of, item.datums, float(values[0]), squares, local,
                     None if unseen else 0.5 * (high - low), None if unseen else (low, high), nominal, lower, upper,
                     verdict, _advice(verdict, unseen, (*features, *datums)))


def _intervals(values: Array, draws: Array) -> Array:
    """95 % intervals (3, 2) of values (3,) from what errors do to them (d, 3).

    What errors add to the true value they have added to the one that was found: the interval is the mirrored one (Efron
    and Tibshirani, *An Introduction to the Bootstrap*, 1993, section 13.4). Errors widen a zone on the mean; how much
    depends on how far they reach, which nothing tells, so that this is taken off the lower end and not off the upper.
    """
    low, high = np.quantile(draws, (_TAIL, 1.0 - _TAIL), axis=0)
    middle = draws.mean(axis=0)
    return np.stack([values - high, values - np.minimum(low, low - middle)], axis=1)


def _bonus(item: PlanItem, feature: InspectedFeature, random: np.random.Generator) -> tuple[float, Array]:
    """What the material condition adds to a tolerance, in mm, and how errors change it (d,)."""
    size = dimension_value("diameter", [feature], _DRAWS, random)
    hole, most = feature.outward < 0, item.condition == "mmc"
    sign = 1.0 if hole == most else -1.0
    return max(0.0, sign * (float(size.values[0]) - (item.size or 0.0))), sign * size.draws[:, 0]


def _verdict(intervals: Array, lower: float | None, upper: float | None) -> Verdict:
    """Of the lowest local value against the lower limit and the highest one against the upper limit."""
    sides = []
    if upper is not None:
        sides.append((intervals[2, 1] <= upper, intervals[2, 0] > upper))
    if lower is not None:
        sides.append((intervals[1, 0] >= lower, intervals[1, 1] < lower))
    if any(fails for _, fails in sides):
        return "fail"
    return "pass" if all(passes for passes, _ in sides) else "undecided"


def _advice(verdict: Verdict, unseen: Sequence[str], features: Sequence[InspectedFeature]) -> str:
    """Which further view would decide."""
    if verdict != "undecided":
        return ""
    worst = next((own for own in features if own.name in unseen), None) or max(
        features, key=lambda own: float(own.errors.sigma.mean()))
    direction = ", ".join(f"{part + 0.0:.2f}" for part in worst.view.round(2))
    why = "was not measured" if worst.name in unseen else "has the widest band"
    return f"{worst.name} {why}: a scan of it as seen from ({direction}) would help to decide."
