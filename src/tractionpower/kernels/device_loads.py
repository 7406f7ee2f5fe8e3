"""What currents load devices with: sliding sums of squares and magnitudes, peaks, load duration, one series after the other.

Squares and magnitudes are never negative, so the sum of a window that ends in a group of rows is at most that of all rows
from the first window's start to the last one's end: one difference of running sums tells that none of them beats the
greatest sum so far, and most groups of a day are left out by it. What remains is summed up as in `kernels/windows.py`.
Running sums of one series lie one behind the other, so hundreds of series and windows of hours cost a second a day.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.double_double import minus, plus
from tractionpower.kernels.jit import njit

BINS = 1024
"""Bins of the load duration of one series."""

FINEST_A = 2.0**-10
"""Width of the bins at first; it doubles, two bins become one, when a value lies beyond the last [A]."""

BEYOND_A = 1e12
"""No current: the load duration does not tell more than this from each other [A]."""

SQUARES, MAGNITUDES = 0, 1
"""What is summed up."""

FEWEST_ROWS = 16
"""Rows of the smallest group that is left out or looked at as a whole."""

_MARGIN = 1e-12
"""Share by which the bound of a group may be wrong, more than what rounds in it."""


class DeviceSums(NamedTuple):
    """Sums over several series that all have a row in every step; k running sums fit into a ring.

    k is one more than the steps of the longest window and the rows that are added at a time, one or more.

    Attributes
    ----------
    high, low
        Running sums of squares and of magnitudes in double-double, shape (2, series, k).
    steps
        Length of each window in steps, shape (windows,).
    best, until_s
        Greatest sum so far and the time at which its window ends [s], shape (2, windows, series).
    peak
        Greatest magnitude so far, start of its step [s], and its value with sign, shape (3, series).
    total
        Sum with sign in double-double, shape (2, series).
    bins, width
        How many magnitudes lie in each bin, shape (series, `BINS`), and the width of the bins, shape (series,).
    """

    high: NDArray[np.float64]
    low: NDArray[np.float64]
    steps: NDArray[np.int64]
    best: NDArray[np.float64]
    until_s: NDArray[np.float64]
    peak: NDArray[np.float64]
    total: NDArray[np.float64]
    bins: NDArray[np.int64]
    width: NDArray[np.float64]


@njit
def add_loads(sums, count, step_s, time_s, values):
    """Add rows to the sums.

    Parameters
    ----------
    sums
        `DeviceSums`.
    count
        Rows added before.
    step_s
        Length of a step [s].
    time_s
        Start of each row's step [s], shape (rows,).
    values
        Finite, shape (rows, series).
    """
    longest = 0
    for w in range(sums.steps.shape[0]):
        longest = max(longest, sums.steps[w])
    room = sums.high.shape[2] - longest - 1
    for first in range(0, values.shape[0], room):
        piece = first, min(first + room, values.shape[0])
        for c in range(values.shape[1]):
            _run_on(sums, count, c, piece, time_s, values)
            for what in range(2):
                for w in range(sums.steps.shape[0]):
                    _look_for_best(sums, (what, w, c), count, piece, step_s, time_s)


@njit
def _run_on(sums, count, c, piece, time_s, values):
    """Add a piece of the rows to the running sums, the peak and the load duration of series `c`."""
    high, low, size = sums.high, sums.low, sums.high.shape[2]
    before = (count + piece[0]) % size
    for i in range(piece[0], piece[1]):
        now = before + 1 if before + 1 < size else 0
        value = values[i, c]
        magnitude = abs(value)
        high[0, c, now], low[0, c, now] = plus(high[0, c, before], low[0, c, before], value * value)
        high[1, c, now], low[1, c, now] = plus(high[1, c, before], low[1, c, before], magnitude)
        sums.total[0, c], sums.total[1, c] = plus(sums.total[0, c], sums.total[1, c], value)
        before = now
        if magnitude > sums.peak[0, c]:
            sums.peak[0, c], sums.peak[1, c], sums.peak[2, c] = magnitude, time_s[i], value
        magnitude = min(magnitude, BEYOND_A)
        while magnitude >= sums.width[c] * BINS:
            _widen(sums, c)
        sums.bins[c, int(magnitude / sums.width[c])] += 1


@njit
def _widen(sums, c):
    """Double the width of the bins of series `c`."""
    bins = sums.bins[c]
    for b in range(BINS // 2):
        bins[b] = bins[2 * b] + bins[2 * b + 1]
    for b in range(BINS // 2, BINS):
        bins[b] = 0
    sums.width[c] *= 2.0


@njit
def _look_for_best(sums, which, count, piece, step_s, time_s):
    """Look for a greater sum among the windows that end in a piece of the rows.

    Parameters
    ----------
    sums
        `DeviceSums`.
    which : tuple
        What is summed up, number of the window, series.
    count, step_s, time_s
        As in `add_loads`.
    piece : tuple
        Its first row, and the first row behind it.
    """
    what, w, c = which
    high, low, steps = sums.high[what, c], sums.low[what, c], sums.steps[w]
    size, group = high.shape[0], max(FEWEST_ROWS, steps // 4)
    best = sums.best[what, w, c]
    i = max(piece[0], steps - count - 1)  # the first row at which a window is full
    while i < piece[1]:
        last = min(i + group, piece[1]) - 1
        end, begin = (count + last + 1) % size, (count + i + 1 - steps) % size
        if minus(high[end], low[end], high[begin], low[begin]) <= best * (1.0 - _MARGIN):
            i = last + 1
            continue
        now, then = (count + i + 1) % size, begin
        while i <= last:
            total = minus(high[now], low[now], high[then], low[then])
            if total > best:
                best = total
                sums.until_s[what, w, c] = time_s[i] + step_s
            now = now + 1 if now + 1 < size else 0
            then = then + 1 if then + 1 < size else 0
            i += 1
    sums.best[what, w, c] = best
