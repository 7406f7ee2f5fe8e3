"""What currents load devices with, found while a run lasts: peak, root mean square and mean over windows, load duration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.device_loads import BINS, FINEST_A, MAGNITUDES, SQUARES, DeviceSums, add_loads
from tractionpower.results.windows import WINDOWS_S, as_rows

Array = NDArray[np.float64]

_ROOM = 512
"""Rows that are summed up at a time."""


_WHOLE = 1e-6
"""Part of a step by which a window may miss a whole number of steps."""


def steps_of(window_s: float, step_s: float) -> int:
    """Return how many whole steps fit into a window: a load that a device may bear for 10 s is not held against 12 s.

    >>> steps_of(10.0, 4.0), steps_of(60.0, 0.1), steps_of(2.0, 5.0)
    (2, 600, 0)
    """
    return int(window_s / step_s + _WHOLE)


class DeviceLoads:
    """Loads of several series of currents, each with a row in every step.

    Currents have signs; peaks, windows and the load duration are of their magnitude, for a device warms up in either
    direction. The results do not depend on the pieces in which the rows come. Of windows with the same value the first
    counts; a window is made of as many whole steps as fit into it (`steps_of`), and one that is shorter than a step is left
    out. All sums are kept in double-double, so nothing drifts (`kernels/device_loads.py`).

    Parameters
    ----------
    columns
        Number of series.
    step_s
        Length of a step [s].
    windows_s
        Lengths of the windows [s].

    Attributes
    ----------
    windows_s
        Windows that are looked at [s].
    count
        Rows so far.
    """

    def __init__(self, columns: int, step_s: float, windows_s: Sequence[float] = WINDOWS_S) -> None:
        self.step_s, self.count = float(step_s), 0
        self.windows_s = tuple(sorted({float(window) for window in windows_s if steps_of(window, step_s)}))
        steps = np.array([steps_of(window, step_s) for window in self.windows_s], np.int64)
        ring, found = (2, columns, int(steps.max(initial=0)) + _ROOM + 1), (2, len(steps), columns)
        self._sums = DeviceSums(
            high=np.zeros(ring),
            low=np.zeros(ring),
            steps=steps,
            best=np.full(found, -np.inf),
            until_s=np.full(found, np.nan),
            peak=np.stack([np.zeros(columns), np.full(columns, np.nan), np.zeros(columns)]),
            total=np.zeros((2, columns)),
            bins=np.zeros((columns, BINS), np.int64),
            width=np.full(columns, FINEST_A),
        )

    def add(self, time_s: Array, amps: Array) -> None:
        """Add rows: start of the steps [s], shape (rows,), and currents [A], finite, shape (rows, columns)."""
        rows = as_rows(amps).reshape(len(time_s), len(self._sums.width))
        add_loads(self._sums, self.count, self.step_s, as_rows(time_s), rows)
        self.count += len(rows)

    @property
    def seconds(self) -> float:
        """Time that has been added [s]."""
        return self.count * self.step_s

    # -- peaks and the run as a whole ------------------------------------------------------------------------------

    @property
    def peak_a(self) -> Array:
        """Greatest magnitude of a step of each series [A]."""
        return np.asarray(self._sums.peak[0])

    @property
    def peak_s(self) -> Array:
        """Start of the step of the peak [s], the first one of equals; NaN where no current flowed."""
        return np.asarray(self._sums.peak[1])

    @property
    def signed_peak_a(self) -> Array:
        """The peak with the sign of its current [A]."""
        return np.asarray(self._sums.peak[2])

    @property
    def mean_a(self) -> Array:
        """Mean of each series with its sign [A]; NaN without rows."""
        return self._over_run(self._sums.total[0], self._sums.total[1])

    @property
    def mean_magnitude_a(self) -> Array:
        """Mean of the magnitudes of each series [A]."""
        return self._over_run(*self._whole(MAGNITUDES))

    @property
    def rms_a(self) -> Array:
        """Root mean square of each series over all rows [A]."""
        return np.asarray(np.sqrt(self._over_run(*self._whole(SQUARES))))

    def _whole(self, what: int) -> tuple[Array, Array]:
        now = self.count % self._sums.high.shape[2]
        return self._sums.high[what, :, now], self._sums.low[what, :, now]

    def _over_run(self, high: Array, low: Array) -> Array:
        return (high + low) / self.count if self.count else np.full(len(high), np.nan)

    # -- windows ---------------------------------------------------------------------------------------------------

    @property
    def best_rms(self) -> Array:
        """Highest sliding root mean square [A], shape (windows, columns); NaN where the run is shorter than the window."""
        return np.asarray(np.sqrt(self._means(SQUARES)))

    @property
    def from_s(self) -> Array:
        """Start of the window with the highest root mean square [s], shape (windows, columns)."""
        return self._begins(SQUARES)

    @property
    def best_mean(self) -> Array:
        """Highest sliding mean of the magnitude [A], shape (windows, columns)."""
        return self._means(MAGNITUDES)

    @property
    def mean_from_s(self) -> Array:
        """Start of the window with the highest mean [s], shape (windows, columns)."""
        return self._begins(MAGNITUDES)

    def _means(self, what: int) -> Array:
        best = self._sums.best[what] / self._sums.steps[:, np.newaxis]
        return np.where(np.isfinite(best), np.maximum(best, 0.0), np.nan)

    def _begins(self, what: int) -> Array:
        return np.asarray(self._sums.until_s[what] - self._sums.steps[:, np.newaxis] * self.step_s)

    # -- load duration ---------------------------------------------------------------------------------------------

    def load_duration(self, shares: Sequence[float]) -> Array:
        """Return the currents that are reached or passed for shares of the run [A], shape (shares, columns).

        They are known to the width of a bin, at most a 500th of the peak; share 0 is the peak itself.

        Parameters
        ----------
        shares
            Parts of the time, 0 to 1.
        """
        sums, found = self._sums, np.full((len(shares), len(self._sums.width)), np.nan)
        if not self.count:
            return found
        rank = np.clip(np.ceil(np.asarray(shares) * self.count - 1e-6), 1, self.count)  # of the value among all, from the top
        for c, (bins, width, peak) in enumerate(zip(sums.bins, sums.width, sums.peak[0], strict=True)):
            falling = np.cumsum(bins[::-1])  # rows in a bin, counted from the last, or beyond it
            at = np.searchsorted(falling, rank)
            part = (falling[at] - rank + 0.5) / bins[::-1][at]
            found[:, c] = np.minimum((BINS - 1 - at + part) * width, peak)
        found[np.asarray(shares) <= 0.0] = sums.peak[0]
        return found
