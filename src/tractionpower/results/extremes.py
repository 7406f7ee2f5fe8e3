"""Series summed up while the run lasts, over every step whether its row is written or not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def add_up(total: Array, values: Array) -> Array:
    """Return `total` plus all rows of `values`, added one after the other: the sum does not depend on how many come at a time."""
    return np.asarray(np.cumsum(np.concatenate([total[np.newaxis], values]), axis=0)[-1])


class Extremes:
    """Lowest, highest and mean of several series, with the time of the extremes.

    Parameters
    ----------
    width
        Number of series.
    """

    def __init__(self, width: int) -> None:
        self.lowest, self.highest = np.full(width, np.inf), np.full(width, -np.inf)
        self.lowest_s, self.highest_s = np.full(width, np.nan), np.full(width, np.nan)
        self.total, self.squares = np.zeros(width), np.zeros(width)
        self.count = 0

    def add(self, time_s: Array, values: Array) -> None:
        """Add rows: times [s], shape (steps,), and values, shape (steps, width)."""
        if not values.size:
            return
        columns = np.arange(values.shape[1])
        for pick, best, when, better in (
            (values.argmin(axis=0), self.lowest, self.lowest_s, np.less),
            (values.argmax(axis=0), self.highest, self.highest_s, np.greater),
        ):
            found = values[pick, columns]
            new = better(found, best)
            best[new], when[new] = found[new], time_s[pick][new]
        self.total = add_up(self.total, values)
        self.squares = add_up(self.squares, values**2)
        self.count += len(values)

    @property
    def mean(self) -> Array:
        """Mean of each series."""
        return self.total / max(self.count, 1)

    @property
    def rms(self) -> Array:
        """Root of the mean square of each series."""
        return np.asarray(np.sqrt(self.squares / max(self.count, 1)))
