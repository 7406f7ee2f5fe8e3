"""Prices of time that make a group of legs take a given time.

The time of the best way falls as the price of time rises, in jumps where the best way changes at once. So prices are taken
from a fixed ladder, on which ways are kept for other times of the same leg, and the ways of the two neighbours are mixed,
w = (1 - x) w_fast + x w_slow, until the time is met exactly. Force and resistance are nearly linear in w, and what a force
costs is convex in it for a drive of constant efficiency, so a mixed way needs no more energy than the two in proportion:
mixing is as good as the straight line between two points of the curve of least energy over time.

Below a price of nothing the ladder goes on: time is paid for, and the train brakes and runs slowly to lose it. That is how it
passes a place on time. Before a stop, where it may as well wait, it does so for next to nothing only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.movement.driving.eco_legs import Floats, LegModel

STEP = 1.2
"""Ratio of neighbouring prices of the ladder."""

FREE, HIGHEST = -40, 40
"""Steps of the ladder around 1 kW for each tonne: at the one time is free, above the other is the greatest effort."""

WAITING, LOWEST = FREE - 15, FREE - 65
"""Lowest steps, where time is paid for: 0.01 kW for each tonne before a stop, more than any train pays before a pass."""

_ROUNDS = 6  # of parts of a group that share a leg
_CARRIES = 3  # how often what parts miss is handed on
_MIXES = 60  # halvings
_BLEND_M = 400.0
_SAME_S = 1e-3
_KEPT_S = 0.02


@dataclass(frozen=True, eq=False)
class GroupLeg:
    """A leg in its group: the leg, and the part of the group in which it begins."""

    leg: LegModel
    first: int


@dataclass(frozen=True, eq=False)
class InTime:
    """How a group keeps its times.

    Attributes
    ----------
    ways
        Squares of the speed for each leg [m2/s2]; None: no part has time to spare.
    times_s
        The running time of each part [s].
    late_s
        By how much it is late at its end, because it cannot be faster [s].
    """

    ways: list[Floats] | None
    times_s: Floats
    late_s: float


def ways_in_time(legs: Sequence[GroupLeg], targets_s: Sequence[float], waits: bool = True) -> InTime:
    """Return how each part of a group takes its time, with the least energy.

    Parts that cannot be so slow or so fast are as slow or fast as they can; the next ones make up for it.

    Parameters
    ----------
    legs
        The legs of the group.
    targets_s
        Running time of each part [s]; NaN: as much more than the shortest as in the part before.
    waits
        Whether the train waits at the end of the last part if it is early.
    """
    group, parts = _Group(legs, len(targets_s)), len(targets_s)
    wanted, shortest = np.array(targets_s, float), group.times([HIGHEST] * parts)
    for part in np.flatnonzero(np.isnan(wanted)).tolist():
        wanted[part] = shortest[part] * wanted[part - 1] / shortest[part - 1]
    late = lateness(shortest, wanted)
    if (shortest > wanted - _SAME_S).all():
        return InTime(None, shortest, late)
    lowest = [LOWEST] * (parts - 1) + [WAITING if waits else LOWEST]
    steps, targets = [0] * parts, wanted.copy()
    for _ in range(1 if parts == 1 else _CARRIES):
        _settle(group, steps, targets, lowest)
        ways = _mixed(group, steps, targets)
        times = group.times_of(ways)
        missed = np.cumsum(times - wanted)
        before, targets = targets, wanted - np.append(0.0, missed[:-1])
        if np.abs(targets - before).max() < _KEPT_S:
            break
    return InTime(ways, times, late)


def _settle(group: _Group, steps: list[int], targets: Floats, lowest: Sequence[int]) -> None:
    """Move `steps` to where each part takes at least its time, those of the others given, and is not slower than needed."""
    for _ in range(1 if len(targets) == 1 else _ROUNDS):
        before = list(steps)
        for part in range(len(targets)):
            steps[part] = _bisect(group, steps, part, (float(targets[part]), lowest[part]))
        if steps == before:
            break


def lateness(shortest: Floats, targets: Floats) -> float:
    """Let each part make up, as far as it can, for what those before it are late by; return what is left at the end [s].

    `targets` become times that can be kept, none below the `shortest` ones [s].
    """
    late = 0.0
    for part in range(len(targets)):
        targets[part] -= late
        late = max(float(shortest[part] - targets[part]), 0.0)
        targets[part] += late
    return late


def _bisect(group: _Group, steps: list[int], part: int, goal: tuple[float, int]) -> int:
    """Return the greatest step of the ladder of a part at which it takes at least its time; its lowest one if none does.

    `goal` holds that time [s] and the lowest step.
    """
    target_s, lowest = goal

    def is_slow(step: int) -> bool:
        return bool(group.times([*steps[:part], step, *steps[part + 1 :]])[part] >= target_s)

    low, high, width = lowest, HIGHEST, 2
    guess = steps[part]
    if is_slow(guess):  # widen from the last one
        low = guess
        while low + width < high and is_slow(low + width):
            low, width = low + width, 2 * width
        high = min(high, low + width)
    else:
        high = guess
        while high - width > low and not is_slow(high - width):
            high, width = high - width, 2 * width
        low = max(low, high - width)
    while high - low > 1:
        middle = (low + high) // 2
        if is_slow(middle):
            low = middle
        else:
            high = middle
    return low


def _mixed(group: _Group, steps: list[int], targets: Floats) -> list[Floats]:
    """Return the ways between those of `steps` and the next ones that take their times exactly, as far as they can."""
    slow = group.squares(steps)
    fast = group.squares([min(step + 1, HIGHEST) for step in steps])
    shares = np.ones(len(targets))
    for _ in range(1 if len(targets) == 1 else _ROUNDS):
        before = shares.copy()
        for part in range(len(targets)):
            shares[part] = _share(group, (slow, fast), shares, part, targets[part])
        if np.abs(shares - before).max() < _SAME_S:
            break
    return group.mix(slow, fast, shares)


def _share(group: _Group, ways: tuple[list[Floats], list[Floats]], shares: Floats, part: int, target_s: float) -> float:
    """Return the share of the slow way with which a part takes its time."""
    trial = shares.copy()

    def late(x: float) -> float:
        trial[part] = x
        return float(group.times_of(group.mix(*ways, trial))[part] - target_s)

    return halve(late, 0.0, 1.0)


def halve(late: Callable[[float], float], low: float, high: float) -> float:
    """Return where `late`, which rises from `low` to `high`, is 0, or the nearer end where it is not between."""
    if late(high) <= 0.0:
        return high
    if late(low) >= 0.0:
        return low
    for _ in range(_MIXES):
        middle = 0.5 * (low + high)
        wrong = late(middle)
        if abs(wrong) <= _SAME_S:
            return middle
        if wrong > 0.0:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


class _Group:
    """Legs with common prices of time, by steps of the ladder for each part."""

    def __init__(self, legs: Sequence[GroupLeg], parts: int) -> None:
        self._legs, self._parts = legs, parts
        self._in_part = [item.first + item.leg.stages["part"] for item in legs]
        self._unit_w = float(legs[0].leg.eco["inertia_kg"][0])  # 1 kW a tonne is 1 W/kg

    def squares(self, steps: Sequence[int]) -> list[Floats]:
        return [item.leg.way(self._prices(item, steps)).squares for item in self._legs]

    def times(self, steps: Sequence[int]) -> Floats:
        """Return the time of each part [s]."""
        return self._sums([item.leg.way(self._prices(item, steps)).times for item in self._legs])

    def times_of(self, squares: Sequence[Floats]) -> Floats:
        return self._sums([item.leg.times(w) for item, w in zip(self._legs, squares, strict=True)])

    def mix(self, slow: Sequence[Floats], fast: Sequence[Floats], shares: Floats) -> list[Floats]:
        if self._parts == 1:
            return [f + float(shares[0]) * (s - f) for s, f in zip(slow, fast, strict=True)]
        return [
            item.leg.within_effort(f + self._blend(item.leg.stages, part, shares) * (s - f))
            for item, part, s, f in zip(self._legs, self._in_part, slow, fast, strict=True)
        ]

    def _blend(self, stages: NDArray[np.void], part: NDArray[np.int64], shares: Floats) -> Floats:
        """Return the shares at the ends of stages, straight for a way about the places where parts meet."""
        ends = np.append(stages["from_m"], stages["from_m"][-1] + stages["length_m"][-1])
        meet = ends[1:-1][np.diff(part) != 0]
        if len(meet) == 0:
            return np.full(len(ends), shares[part[0]])
        half = 0.4 * min(float(np.diff(np.concatenate(([ends[0]], meet, [ends[-1]]))).min()), _BLEND_M)
        x = np.column_stack((meet - half, meet + half)).reshape(-1)
        numbers = np.unique(part)
        y = np.column_stack((shares[numbers[:-1]], shares[numbers[1:]])).reshape(-1)
        return np.asarray(np.interp(ends, x, y))

    def _prices(self, item: GroupLeg, steps: Sequence[int]) -> tuple[float, ...]:
        count = int(item.leg.stages["part"][-1]) + 1
        if min(steps) >= HIGHEST:
            return (np.inf,) * count
        return tuple(self._price(steps[item.first + n]) for n in range(count))

    def _price(self, step: int) -> float:
        if step == FREE:
            return 0.0
        return self._unit_w * (STEP**step if step > FREE else -(STEP ** (2 * FREE - step)))

    def _sums(self, times: Sequence[Floats]) -> Floats:
        found = np.zeros(self._parts)
        for part, seconds in zip(self._in_part, times, strict=True):
            found += np.bincount(part, seconds, self._parts)
        return found
