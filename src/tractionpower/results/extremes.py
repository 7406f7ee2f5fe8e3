"""Series summed up while the run lasts, over every step whether its row is written or not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def add_up(total: Array, values: Array) -> Array:
    """Return `total` plus all rows of `values`, added one after the other: the sum does not depend on how many come at a time."""
    return np.asarray(np.cumsum(np.concatenate([total[np.newaxis], values]), axis=0)[-1])


class Extremes:
    """Lowest, highest and mean of several series, with the time of the extremes; values that are not a number count nothing.

    Parameters
    ----------
    width
        Number of series.
    """

    def __init__(self, width: int) -> None:
        self.lowest, self.highest = np.full(width, np.inf), np.full(width, -np.inf)
        self.lowest_s, self.highest_s = np.full(width, np.nan), np.full(width, np.nan)
        self.total, self.squares = np.zeros(width), np.zeros(width)
        self.counts = np.zeros(width, np.int64)
        self.count = 0

    def add(self, time_s: Array, values: Array) -> None:
        """Add rows: times [s], shape (steps,), and values, shape (steps, width)."""
        if not values.size:
            return
        columns = np.arange(values.shape[1])
        gaps = bool(np.isnan(values.sum()))
        low = np.where(np.isnan(values), np.inf, values) if gaps else values
        high = np.where(np.isnan(values), -np.inf, values) if gaps else values
        for pick, series, best, when, better in (
            (low.argmin(axis=0), low, self.lowest, self.lowest_s, np.less),
            (high.argmax(axis=0), high, self.highest, self.highest_s, np.greater),
        ):
            found = series[pick, columns]
            new = better(found, best)
            best[new], when[new] = found[new], time_s[pick][new]
        present = np.where(np.isnan(values), 0.0, values) if gaps else values
        self.total = add_up(self.total, present)
        self.squares = add_up(self.squares, present**2)
        self.counts += len(values) - np.isnan(values).sum(axis=0) if gaps else len(values)
        self.count += len(values)

    @property
    def mean(self) -> Array:
        """Mean of each series."""
        return self.total / np.maximum(self.counts, 1)

    @property
    def rms(self) -> Array:
        """Root of the mean square of each series."""
        return np.asarray(np.sqrt(self.squares / np.maximum(self.counts, 1)))
