"""Sliding windows, demand by the clock, and spells beyond a limit: one pass over the rows as they come.

Every window needs the sum of its last rows. What is kept is the running sum since the first row, in *double-double*
(`kernels/double_double.py`), in a ring as long as the longest
window: a window's sum is the difference of two running sums, so one ring serves all windows, nothing drifts over a day
(a plain running sum loses digits at each addition and subtraction, a compensated one still needs its correction per
window), and the sum of the same rows is the same number wherever they stand in the run.
Rows are taken one by one, so the results do not depend on how many come at a time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.double_double import minus, plus
from tractionpower.kernels.jit import njit

GAP_STEPS = 1.5
"""Rows of a train that lie further apart than so many steps do not follow each other."""

_ON_BOUNDARY = 1e-6
"""Share of a step by which a time may miss a boundary of the clock and still stand on it."""


class Sliding(NamedTuple):
    """Sliding sums of several series that all have a row in every step; k running sums fit into the ring.

    Attributes
    ----------
    high, low
        Running sums in double-double, shape (k, series); k is one more than the steps of the longest window.
    steps
        Length of each window in steps, shape (windows,).
    best, until_s
        Greatest sum so far and the time at which its window ends [s], shape (windows, series).
    """

    high: NDArray[np.float64]
    low: NDArray[np.float64]
    steps: NDArray[np.int64]
    best: NDArray[np.float64]
    until_s: NDArray[np.float64]


class TrainSliding(NamedTuple):
    """Sliding sums of trains, of which each has rows only while it is on the line.

    Attributes
    ----------
    high, low
        Running sums in double-double, shape (rings, k): a train on the line has a ring.
    steps
        Length of each window in steps, shape (windows,).
    best, until_s, at
        Greatest sum so far, the time at which its window ends [s] and the place given with the last row of that window,
        shape (windows, trains).
    trains
        Records of `TRAIN_RING`, one for each train.
    """

    high: NDArray[np.float64]
    low: NDArray[np.float64]
    steps: NDArray[np.int64]
    best: NDArray[np.float64]
    until_s: NDArray[np.float64]
    at: NDArray[np.float64]
    trains: NDArray[np.void]


TRAIN_RING = np.dtype(
    [
        ("ring", "i8"),  # -1: none
        ("rows", "i8"),  # since the train entered, or since a gap
        ("last_s", "f8"),
    ]
)
"""A train among the rings."""

DEMAND = np.dtype(
    [
        ("period", "f8"),  # the one that is being added up, counted from midnight; NaN: none yet
        ("covered_s", "f8"),  # how much of it
    ]
)
"""Where the demand by the clock stands."""

SPELL = np.dtype(
    [
        ("beyond", "?"),  # the last row was
        ("last_s", "f8"),
        ("from_s", "f8"),  # start of the present spell
        ("longest_s", "f8"),
        ("longest_from_s", "f8"),
        ("total_s", "f8"),
    ]
)
"""A series against a limit."""


@njit
def slide(sliding, count, sign, until_s, values):
    """Add rows to the sliding sums.

    Parameters
    ----------
    sliding
        `Sliding`.
    count
        Rows added before.
    sign
        1.0 to find the greatest sums, -1.0 for the least ones (`best` then holds them with their sign turned).
    until_s
        End of each row's step [s], shape (rows,).
    values
        Shape (rows, series).
    """
    high, low, best, best_s = sliding.high, sliding.low, sliding.best, sliding.until_s
    size, width = high.shape
    for i in range(values.shape[0]):
        k = count + i + 1
        before, now, end = (k - 1) % size, k % size, until_s[i]
        for c in range(width):
            high[now, c], low[now, c] = plus(high[before, c], low[before, c], sign * values[i, c])
        for w in range(sliding.steps.shape[0]):
            if sliding.steps[w] > k:
                continue
            then = (k - sliding.steps[w]) % size
            for c in range(width):
                total = minus(high[now, c], low[now, c], high[then, c], low[then, c])
                better = total > best[w, c]
                best[w, c] = total if better else best[w, c]  # without a branch, so that the loop runs in vectors
                best_s[w, c] = end if better else best_s[w, c]


@njit
def slide_trains(sliding, sign, step_s, time_s, train, values, at):
    """Add rows of trains to their sliding sums; a train that was away begins anew.

    Parameters
    ----------
    sliding
        `TrainSliding`; every train among the rows has a ring.
    sign
        As in `slide`.
    step_s
        Length of a step [s].
    time_s, train, values, at
        Start of the step [s], ascending; number of the train; value; place: shape (rows,).
    """
    high, low = sliding.high, sliding.low
    size = high.shape[1]
    for i in range(values.shape[0]):
        t = train[i]
        state = sliding.trains[t]
        ring = state.ring
        if not time_s[i] - state.last_s <= GAP_STEPS * step_s:
            state.rows = 0
            high[ring, 0] = low[ring, 0] = 0.0
        before = state.rows % size
        state.rows += 1
        state.last_s = time_s[i]
        k = state.rows
        now = k % size
        high[ring, now], low[ring, now] = plus(high[ring, before], low[ring, before], sign * values[i])
        for w in range(sliding.steps.shape[0]):
            if sliding.steps[w] > k:
                continue
            then = (k - sliding.steps[w]) % size
            total = minus(high[ring, now], low[ring, now], high[ring, then], low[ring, then])
            if total > sliding.best[w, t]:
                sliding.best[w, t] = total
                sliding.until_s[w, t] = time_s[i] + step_s
                sliding.at[w, t] = at[i]


@njit
def add_demand(state, total, best, lengths_s, time_s, values):
    """Add rows to the demand in periods of the clock; a step across a boundary is shared out by time.

    Parameters
    ----------
    state
        One record of `DEMAND`, in an array.
    total
        Sums of value times time in the present period, shape (series,).
    best
        Highest mean of a complete period and the start of that period [s], shape (2, series).
    lengths_s
        Length of a step and of a period [s].
    time_s, values
        Start of the steps [s], shape (rows,), and values, shape (rows, series).
    """
    step_s, period_s = lengths_s
    near = _ON_BOUNDARY * step_s
    for i in range(values.shape[0]):
        begin, end = time_s[i], time_s[i] + step_s
        while end - begin > near:
            period = np.floor(begin / period_s)
            if period != state[0].period:
                state[0].period, state[0].covered_s = period, 0.0
                for c in range(total.shape[0]):
                    total[c] = 0.0
            boundary = (period + 1.0) * period_s
            until = boundary if end > boundary - near else end
            part = until - begin
            state[0].covered_s += part
            for c in range(total.shape[0]):
                total[c] += part * values[i, c]
            if until == boundary and state[0].covered_s > period_s - 2.0 * near:
                for c in range(total.shape[0]):
                    mean = total[c] / state[0].covered_s
                    if mean > best[0, c]:
                        best[0, c], best[1, c] = mean, period * period_s
            begin = until


@njit
def add_spells(spells, threshold, step_s, time_s, series, excess):
    """Add rows to spells beyond a limit; a row that is missing ends a spell.

    Parameters
    ----------
    spells
        Records of `SPELL`, one for each series.
    threshold
        A row is beyond the limit when its excess is greater than this.
    step_s
        Length of a step [s].
    time_s, series, excess
        Start of the step [s], ascending; number of the series; excess over the limit: shape (rows,).
    """
    for i in range(excess.shape[0]):
        spell = spells[series[i]]
        follows = time_s[i] - spell.last_s <= GAP_STEPS * step_s
        spell.last_s = time_s[i]
        beyond = excess[i] > threshold
        if beyond:
            if not (spell.beyond and follows):
                spell.from_s = time_s[i]
            lasted = time_s[i] + step_s - spell.from_s
            spell.total_s += step_s
            if lasted > spell.longest_s:
                spell.longest_s, spell.longest_from_s = lasted, spell.from_s
        spell.beyond = beyond
