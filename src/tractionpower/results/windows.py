"""Highest and lowest means over sliding windows and over periods of the clock, found while the run lasts.

All of them take the rows of a run as they come, in pieces of any length; the results do not depend on the pieces.
Values must be finite: a sum over NaN would stay NaN.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.windows import (
    DEMAND,
    GAP_STEPS,
    TRAIN_RING,
    Sliding,
    TrainSliding,
    add_demand,
    slide,
    slide_trains,
)

Array = NDArray[np.float64]
Pick = Literal["highest", "lowest"]

WINDOWS_S = (10.0, 15.0, 60.0, 300.0, 900.0, 1800.0, 3600.0, 7200.0, 10800.0)
"""Lengths of the sliding windows of all reports [s]."""

_SIGNS: dict[Pick, float] = {"highest": 1.0, "lowest": -1.0}


def window_label(seconds: float) -> str:
    """Return a window's part of a name: ``10_s``, ``1_min``."""
    return f"{seconds / 60.0:.0f}_min" if seconds % 60.0 == 0.0 and seconds else f"{seconds:g}_s"


def as_rows(values: Any, kind: type = np.float64) -> NDArray[Any]:
    """Return `values` as the kernels take them (of one type, contiguous, writable), copied only where they differ."""
    return np.require(values, kind, ("C", "W"))


class _Windows:
    """Windows in steps; those that are shorter than a step are left out.

    Attributes
    ----------
    windows_s
        Windows that are looked at, as given [s].
    """

    def __init__(self, step_s: float, windows_s: Sequence[float], pick: Pick) -> None:
        self.step_s, self._sign = step_s, _SIGNS[pick]
        self.windows_s = tuple(float(window) for window in windows_s if window > step_s * (1.0 - 1e-9))
        self._steps = np.array([int(window / step_s + 0.5) for window in self.windows_s], np.int64)

    @property
    def _longest(self) -> int:
        return int(self._steps.max(initial=1))

    def _means(self, best: Array) -> Array:
        """Return means from the greatest sums, NaN where there was no whole window."""
        means = self._sign * best / self._steps[:, np.newaxis]
        return np.where(np.isfinite(best), means + 0.0, np.nan)  # + 0.0: no minus zero

    def _begins(self, until_s: Array) -> Array:
        return np.asarray(until_s - self._steps[:, np.newaxis] * self.step_s)


class SlidingWindows(_Windows):
    """Highest or lowest mean of several series over sliding windows, each series with a row in every step.

    Of windows with the same mean the first counts. A window is rounded to whole steps.

    Parameters
    ----------
    width
        Number of series.
    step_s
        Length of a step [s].
    windows_s
        Lengths of the windows [s].
    pick
        Which mean is looked for.
    squares
        Take the root of the mean square of each window instead of its mean.

    Attributes
    ----------
    best_until_s
        End of each window found [s], shape (windows, width); NaN where there was none.
    """

    def __init__(
        self,
        width: int,
        step_s: float,
        windows_s: Sequence[float] = WINDOWS_S,
        pick: Pick = "highest",
        squares: bool = False,
    ) -> None:
        super().__init__(step_s, windows_s, pick)
        ring, found = (self._longest + 1, width), (len(self.windows_s), width)
        self._sliding = Sliding(np.zeros(ring), np.zeros(ring), self._steps, np.full(found, -np.inf), np.full(found, np.nan))
        self._squares, self._count = squares, 0
        self.best_until_s = self._sliding.until_s

    def add(self, time_s: Array, values: Array) -> None:
        """Add rows: start of the steps [s], shape (rows,), and values, shape (rows, width)."""
        rows = as_rows(values).reshape(len(time_s), self.best_until_s.shape[1])
        if self._squares:
            rows = rows * rows
        slide(self._sliding, self._count, self._sign, as_rows(time_s) + self.step_s, rows)
        self._count += len(rows)

    @property
    def best(self) -> Array:
        """Highest or lowest mean (with `squares` its root), shape (windows, width); NaN where the window was never full."""
        means = self._means(self._sliding.best)
        return np.sqrt(np.maximum(means, 0.0)) if self._squares else means

    @property
    def best_from_s(self) -> Array:
        """Start of each window found [s], shape (windows, width)."""
        return self._begins(self.best_until_s)


class ClockDemand:
    """Highest mean over complete periods of the clock (00:00, 00:15, ...): the demand that a grid operator bills.

    Parameters
    ----------
    width
        Number of series.
    step_s, period_s
        Length of a step and of a period [s].
    """

    def __init__(self, width: int, step_s: float, period_s: float = 900.0) -> None:
        self._lengths_s = (float(step_s), float(period_s))
        self._state = np.array([(np.nan, 0.0)], DEMAND)
        self._total, self._best = np.zeros(width), np.stack([np.full(width, -np.inf), np.full(width, np.nan)])

    def add(self, time_s: Array, values: Array) -> None:
        """Add rows: start of the steps [s], shape (rows,), and values, shape (rows, width)."""
        rows = as_rows(values).reshape(len(time_s), len(self._total))
        add_demand(self._state, self._total, self._best, self._lengths_s, as_rows(time_s), rows)

    @property
    def best(self) -> Array:
        """Highest mean of each series; NaN where no period was complete."""
        return np.where(np.isfinite(self._best[0]), self._best[0], np.nan)

    @property
    def best_from_s(self) -> Array:
        """Start of the period of the highest mean [s]; the first one of equals."""
        return np.asarray(self._best[1])


class TrainWindows(_Windows):
    """Lowest or highest mean of each train over sliding windows; a train has rows only while it is on the line.

    A window never reaches across a gap. Running sums are kept for trains that are on the line, not for all.

    Parameters
    ----------
    count
        Number of trains.
    step_s
        Length of a step [s].
    windows_s
        Lengths of the windows [s].
    pick
        Which mean is looked for.
    """

    def __init__(self, count: int, step_s: float, windows_s: Sequence[float] = (10.0,), pick: Pick = "lowest") -> None:
        super().__init__(step_s, windows_s, pick)
        trains = np.zeros(count, TRAIN_RING)
        trains["ring"], trains["last_s"] = -1, -np.inf
        found, none = (len(self.windows_s), count), np.zeros((0, self._longest + 1))
        best, until_s, at = np.full(found, -np.inf), np.full(found, np.nan), np.full(found, np.nan)
        self._sliding = TrainSliding(none, none.copy(), self._steps, best, until_s, at, trains)

    def add(self, time_s: Array, train: NDArray[np.integer[Any]], values: Array, at: Array) -> None:
        """Add rows of many trains, ordered by time.

        Parameters
        ----------
        time_s, train
            Start of the step [s] and number of the train, shape (rows,).
        values
            What is averaged.
        at
            What is told about the end of a window, for instance the place: `best_at`.
        """
        if not len(train):
            return
        numbers = as_rows(train, np.int64)
        self._hand_out_rings(float(time_s[0]), numbers)
        slide_trains(self._sliding, self._sign, self.step_s, as_rows(time_s), numbers, as_rows(values), as_rows(at))

    def _hand_out_rings(self, now_s: float, train: NDArray[np.int64]) -> None:
        """Give a ring to every train among the rows, from those that have left before now."""
        trains = self._sliding.trains
        gone = (trains["ring"] >= 0) & (now_s - trains["last_s"] > GAP_STEPS * self.step_s)
        trains["ring"][gone] = -1
        here = np.bincount(train, minlength=len(trains)) > 0
        wanting = np.flatnonzero(here & (trains["ring"] < 0))
        rings = len(self._sliding.high)
        free = np.setdiff1d(np.arange(rings + len(wanting)), trains["ring"])[: len(wanting)]
        trains["ring"][wanting] = free
        more = int(free.max(initial=-1)) + 1 - rings
        if more > 0:
            new = np.zeros((more, self._longest + 1))
            high, low = (np.concatenate([ring, new]) for ring in (self._sliding.high, self._sliding.low))
            self._sliding = self._sliding._replace(high=high, low=low)

    @property
    def best(self) -> Array:
        """Lowest or highest mean, shape (windows, trains); NaN for a train that was never so long on the line."""
        return self._means(self._sliding.best)

    @property
    def best_from_s(self) -> Array:
        """Start of each window found [s]."""
        return self._begins(self._sliding.until_s)

    @property
    def best_until_s(self) -> Array:
        """End of each window found [s]; NaN where there was none."""
        return self._sliding.until_s

    @property
    def best_at(self) -> Array:
        """What was told of the last row of each window found."""
        return self._sliding.at
