"""Rainflow counting of coupling forces while they are computed (ASTM E1049-85, 5.4.4), and an index of damage made of it."""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import UsageError

Array = NDArray[Any]
Classes = Counter[tuple[int, int]]
"""How many cycles there are in each class of range and mean."""

NEEDED = "pip install tractionpower[dynamics]"

EXPONENT = 3
"""Power of the range in the index of damage: that of welded details (an index of ours, no proof of strength)."""

RANGE_N, MEAN_N = 5e3, 25e3
"""Widths of the classes in which cycles are kept [N]; the index of damage uses the exact ranges."""

WAITING = 200_000
"""Turning points that wait before they are counted: few at a time would cost more for the calls than for the counting."""

_ROUNDING = 1e-9


class RainflowCounter:
    """Counts the cycles of several forces from their turning points, some at a time.

    What is not a closed cycle yet, the residue, is kept and counted anew together with what comes; so cutting a history
    anywhere gives the counts of the whole.

    Parameters
    ----------
    count
        Number of series.

    Raises
    ------
    UsageError
        If the package rainflow is not installed.
    """

    def __init__(self, count: int) -> None:
        self._extract = _library().extract_cycles
        self._residues: list[Array] = [np.empty(0) for _ in range(count)]
        self._closed: list[Classes] = [Counter() for _ in range(count)]
        self._sums = np.zeros(count)
        self._waiting: list[Array] = []

    def add(self, turns: Array) -> None:
        """Add turning points: records of `tractionpower.kernels.chain_state.TURN`, in the order in which they came.

        The first one of a series is the force with which it begins.
        """
        if len(turns):
            self._waiting.append(turns)
        if sum(map(len, self._waiting)) >= WAITING:
            self._count()

    def cycles(self, now_n: Sequence[float] | Array | None = None) -> list[dict[tuple[float, float], float]]:
        """Return how many cycles there are so far in classes of range and mean [kN], for each series; the residue counts half.

        Parameters
        ----------
        now_n
            Extreme of each force since its last turn [N]: the last point of each history. None: the last turn is.
        """
        self._count()
        counts = []
        for number, closed in enumerate(self._closed):
            halves: Classes = Counter()
            ranges, means, weights = self._rest(number, now_n)
            for key, weight in zip(_classes(ranges, means), weights.tolist(), strict=True):
                halves[key] += int(2 * weight)
            keys = sorted({*closed, *halves})
            counts.append({_told(key): closed[key] + 0.5 * halves[key] for key in keys})
        return counts

    def damage(self, now_n: Sequence[float] | Array | None = None) -> Array:
        """Return cycles times range cubed of each series [kN³], summed up; see `cycles`."""
        self._count()
        rests = [self._rest(number, now_n) for number in range(len(self._closed))]
        return np.asarray(self._sums + np.array([_damage(ranges, weights) for ranges, _, weights in rests], float))

    def _count(self) -> None:
        """Count the turning points that wait."""
        if not self._waiting:
            return
        turns = np.concatenate(self._waiting)
        self._waiting = []
        order = np.argsort(turns["link"], kind="stable")
        links, first = np.unique(turns["link"][order], return_index=True)
        for link, forces in zip(links.tolist(), np.split(turns["force_n"][order], first[1:]), strict=True):
            ranges, means, self._residues[link] = self._cycles(np.concatenate([self._residues[link], forces]))
            self._closed[link].update(_classes(ranges, means))
            self._sums[link] += _damage(ranges, np.ones(len(ranges)))

    def _rest(self, number: int, now_n: Sequence[float] | Array | None) -> tuple[Array, Array, Array]:
        """Return what the residue counts: range and mean [N] of each cycle, and how often."""
        points = self._residues[number]
        if now_n is not None and _goes_on(points, float(now_n[number])):
            points = np.append(points, float(now_n[number]))
        ranges, means, halves = self._cycles(points)
        half_ranges = np.abs(np.diff(halves))
        half_means = 0.5 * (halves[:-1] + halves[1:])
        is_one = half_ranges > 0.0
        weights = np.concatenate([np.ones(len(ranges)), np.full(int(is_one.sum()), 0.5)])
        return np.concatenate([ranges, half_ranges[is_one]]), np.concatenate([means, half_means[is_one]]), weights

    def _cycles(self, points: Array) -> tuple[Array, Array, Array]:
        """Return ranges and means of the closed cycles, and the points that are left over: half cycles from each to the next."""
        if len(points) < 3:  # the library finds nothing in two points
            return np.empty(0), np.empty(0), points
        found = np.array(list(self._extract(points.tolist()))).reshape(-1, 5)  # range, mean, count, first, last
        whole = found[:, 2] == 1.0
        halves = found[~whole, 3:].astype(np.int64)
        left = np.append(halves[:, 0], halves[-1:, 1])  # each begins where the one before ended
        return found[whole, 0], found[whole, 1], points[left]


def relative_damage(damage: Array) -> Array:
    """Return sums of damage over the greatest of them; 0 where there is none at all."""
    most = float(damage.max()) if len(damage) else 0.0
    return damage / most if most > 0.0 else np.zeros(len(damage))


def _goes_on(points: Array, force_n: float) -> bool:
    """Return whether a force turns back from the last of some points, as a last point has to."""
    return len(points) < 2 or bool((force_n - points[-1]) * (points[-1] - points[-2]) < 0.0)


def _damage(ranges: Array, weights: Array) -> float:
    """Return cycles times range cubed [kN³]."""
    return float((weights * (ranges / 1e3) ** EXPONENT).sum())


def _classes(ranges: Array, means: Array) -> Iterable[tuple[int, int]]:
    """Return the class of each cycle, in widths: of the range the upper end, of the mean the middle."""
    upper = np.ceil(ranges / RANGE_N - _ROUNDING).astype(int)
    return zip(upper.tolist(), np.rint(means / MEAN_N).astype(int).tolist(), strict=True)


def _told(key: tuple[int, int]) -> tuple[float, float]:
    """Return range and mean [kN] that stand for a class."""
    return key[0] * RANGE_N / 1e3, key[1] * MEAN_N / 1e3


def _library() -> Any:
    try:
        return importlib.import_module("rainflow")
    except ImportError:
        raise UsageError(f"counting cycles needs the package rainflow: {NEEDED}") from None
