"""Rainflow counting of coupling forces while they are computed (ASTM E1049-85, 5.4.4), and an index of damage made of it."""

from __future__ import annotations

import importlib
import itertools
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import UsageError

Array = NDArray[Any]

NEEDED = "pip install tractionpower[dynamics]"

EXPONENT = 3
"""Power of the range in the index of damage: that of welded details (an index of ours, no proof of strength)."""

CLASS_KN = 0.1
"""Cycles are kept by range and mean to this [kN]; the index of damage uses the exact ranges."""


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
        self._residues: list[list[float]] = [[] for _ in range(count)]
        self._closed: list[Counter[tuple[float, float]]] = [Counter() for _ in self._residues]
        self._sums = np.zeros(len(self._residues))

    def add(self, turns: Array) -> None:
        """Add turning points: records of `tractionpower.kernels.chain_state.TURN`, in the order in which they came.

        The first one of a series is the force with which it begins.
        """
        order = np.argsort(turns["link"], kind="stable")
        links, first = np.unique(turns["link"][order], return_index=True)
        for link, forces in zip(links.tolist(), np.split(turns["force_n"][order], first[1:]), strict=True):
            self.add_forces(int(link), forces.tolist())

    def add_forces(self, number: int, forces_n: Iterable[float]) -> None:
        """Add turning points [N] of one series."""
        closed, halves = self._cycles([*self._residues[number], *forces_n])
        for one, other in closed:
            self._closed[number][_class_of(one, other)] += 1
            self._sums[number] += (abs(one - other) / 1e3) ** EXPONENT
        self._residues[number] = halves

    def cycles(self, now_n: Sequence[float] | Array | None = None) -> list[dict[tuple[float, float], float]]:
        """Return how many cycles there are so far by range and mean [kN], for each series; the residue counts as half cycles.

        Parameters
        ----------
        now_n
            Extreme of each force since its last turn [N]: the last point of each history. None: the last turn is.
        """
        counts = []
        for number, closed in enumerate(self._closed):
            found: dict[tuple[float, float], float] = {key: float(count) for key, count in closed.items()}
            for one, other, count in self._rest(number, now_n):
                key = _class_of(one, other)
                found[key] = found.get(key, 0.0) + count
            counts.append(found)
        return counts

    def damage(self, now_n: Sequence[float] | Array | None = None) -> Array:
        """Return cycles times range cubed of each series [kN³], summed up; see `cycles`."""
        rests = [
            sum(count * (abs(one - other) / 1e3) ** EXPONENT for one, other, count in self._rest(number, now_n))
            for number in range(len(self._closed))
        ]
        return np.asarray(self._sums + np.array(rests, float).reshape(self._sums.shape))

    def _rest(self, number: int, now_n: Sequence[float] | Array | None) -> list[tuple[float, float, float]]:
        """Return what the residue counts: both ends [N] of each cycle, and how often."""
        points = self._residues[number]
        if now_n is not None and (len(points) < 2 or _goes_on(points, float(now_n[number]))):
            points = [*points, float(now_n[number])]
        closed, halves = self._cycles(points)
        rest = [(one, other, 0.5) for one, other in itertools.pairwise(halves) if one != other]
        return [(one, other, 1.0) for one, other in closed] + rest

    def _cycles(self, points: list[float]) -> tuple[list[tuple[float, float]], list[float]]:
        """Return both ends of each closed cycle, and the points that are left over: half cycles from each to the next."""
        if len(points) < 3:  # the library finds nothing in two points
            return [], points
        closed: list[tuple[float, float]] = []
        halves: list[int] = []
        for _, _, count, first, last in self._extract(points):
            if count == 1.0:
                closed.append((points[first], points[last]))
            else:
                halves = [*halves, last] if halves else [first, last]
        return closed, [points[k] for k in halves]


def relative_damage(damage: Array) -> Array:
    """Return sums of damage over the greatest of them; 0 where there is none at all."""
    most = float(damage.max()) if len(damage) else 0.0
    return damage / most if most > 0.0 else np.zeros(len(damage))


def _goes_on(points: list[float], force_n: float) -> bool:
    """Return whether a force turns back from the last of some points, as a last point has to."""
    return (force_n - points[-1]) * (points[-1] - points[-2]) < 0.0


def _class_of(one: float, other: float) -> tuple[float, float]:
    """Return range and mean [kN] of the cycle between two forces [N]."""
    range_kn, mean_kn = abs(one - other) / 1e3, 0.5 * (one + other) / 1e3
    return round(round(range_kn / CLASS_KN) * CLASS_KN, 6), round(round(mean_kn / CLASS_KN) * CLASS_KN, 6) + 0.0


def _library() -> Any:
    try:
        return importlib.import_module("rainflow")
    except ImportError:
        raise UsageError(f"counting cycles needs the package rainflow: {NEEDED}") from None
