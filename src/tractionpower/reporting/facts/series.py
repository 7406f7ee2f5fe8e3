"""Long series for a figure of some thousand pixels: fewer points, no peak lost; sliding means."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def peaks_kept(values: Array, most: int) -> NDArray[np.intp]:
    """Return the indices of the points to draw, at most some `most`: of each bucket the first, the lowest and the highest.

    The last point is kept too. What is not a number is no peak.

    >>> peaks_kept(np.array([0.0, 1.0, 9.0, 1.0, 0.0, -3.0, 0.0, 0.0]), 6).tolist()
    [0, 2, 4, 5, 7]
    """
    count = len(values)
    if count <= most:
        return np.arange(count)
    first = bucket_starts(count, max(most // 3, 1))
    lengths = np.diff(first, append=count)
    number = np.repeat(np.arange(len(first)), lengths)
    finite = np.isfinite(values)
    picks = [first, np.array([count - 1])]
    for sign in (1.0, -1.0):
        cost = np.where(finite, sign * values, np.inf)
        best = np.minimum.reduceat(cost, first)
        hits = np.flatnonzero(cost == best[number])
        picks.append(hits[np.unique(number[hits], return_index=True)[1]])
    return np.unique(np.concatenate(picks)).astype(np.intp)


def bucket_starts(count: int, buckets: int) -> NDArray[np.intp]:
    """Return where each of `buckets` parts of `count` points begins; parts without points are left out."""
    return np.unique(np.arange(buckets) * count // buckets).astype(np.intp)


def envelope(time_s: Array, values: Array, buckets: int) -> tuple[Array, Array, Array]:
    """Return starts of `buckets` spells [s] and the lowest and highest of the values in each: a band that no peak leaves."""
    first = bucket_starts(len(values), buckets)
    return time_s[first], np.fmin.reduceat(values, first), np.fmax.reduceat(values, first)


def sliding_mean(values: Array, window: int) -> Array:
    """Return the mean of the last `window` values at each of them; not a number before there are as many.

    >>> sliding_mean(np.array([1.0, 3.0, 5.0]), 2).tolist()
    [nan, 2.0, 4.0]
    """
    mean = np.full(len(values), np.nan)
    if window <= len(values):
        total = np.concatenate(([0.0], np.cumsum(values)))
        mean[window - 1 :] = (total[window:] - total[:-window]) / window
    return mean


def interval(time_s: Array) -> float:
    """Return the usual interval between rows [s]; 1 for a single row."""
    return float(np.median(np.diff(time_s))) if len(time_s) > 1 else 1.0
