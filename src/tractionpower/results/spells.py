"""Spells beyond a limit: how long a voltage stays above U_max1 or below U_min2 (EN 50163, durations of voltages).

The standard's text is not at hand; which voltage may last how long is data (the limits table).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.windows import SPELL, add_spells
from tractionpower.results.windows import as_rows

Array = NDArray[np.float64]

TOLERANCE_V = 0.1
"""A voltage is beyond a limit only when it differs by more [V]: an unloaded busbar may stand at the limit itself."""


class TrainSpells:
    """Spells of series of which each has rows only some of the time: trains, while they are on the line.

    Rows of one series follow each other by a step; where one is missing, a spell ends. Results are arrays, shape (count,).

    Parameters
    ----------
    count
        Number of trains.
    limit
        The limit, in the unit of the values.
    above
        Look for values above the limit, otherwise below.
    tolerance
        How far beyond it a value must lie at least.
    """

    def __init__(self, count: int, limit: float, above: bool = True, tolerance: float = TOLERANCE_V) -> None:
        self._limit, self._sign, self._tolerance = limit, 1.0 if above else -1.0, tolerance
        self._spells = np.zeros(count, SPELL)
        self._spells["last_s"], self._spells["longest_from_s"] = -np.inf, np.nan

    def add(self, time_s: Array, train: NDArray[np.integer[Any]], values: Array, step_s: float) -> None:
        """Add rows ordered by time: start of the step [s], number of the train, value (each of shape (rows,)); their step [s]."""
        excess = self._sign * (as_rows(values) - self._limit)
        add_spells(self._spells, self._tolerance, float(step_s), as_rows(time_s), as_rows(train, np.int64), excess)

    @property
    def longest_s(self) -> Array:
        """Longest unbroken time beyond the limit [s]; 0 where there was none."""
        return self._spells["longest_s"]

    @property
    def longest_from_s(self) -> Array:
        """Start of the longest spell [s], of the first one among equals; NaN where there was none."""
        return self._spells["longest_from_s"]

    @property
    def total_s(self) -> Array:
        """Time beyond the limit in all [s]."""
        return self._spells["total_s"]


class Spells:
    """Spells of several series that all have a row in every step; parameters and results as in `TrainSpells`."""

    def __init__(self, width: int, limit: float, above: bool = True, tolerance: float = TOLERANCE_V) -> None:
        self._spells = TrainSpells(width, limit, above, tolerance)

    def add(self, time_s: Array, values: Array, step_s: float) -> None:
        """Add rows: start of the steps [s], shape (rows,), and values, shape (rows, width); their step [s]."""
        rows, width = values.shape
        self._spells.add(np.repeat(time_s, width), np.tile(np.arange(width), rows), values.ravel(), step_s)

    @property
    def longest_s(self) -> Array:
        """Longest unbroken time beyond the limit of each series [s]."""
        return self._spells.longest_s

    @property
    def longest_from_s(self) -> Array:
        """Start of the longest spell [s]; NaN where there was none."""
        return self._spells.longest_from_s

    @property
    def total_s(self) -> Array:
        """Time beyond the limit in all [s]."""
        return self._spells.total_s
