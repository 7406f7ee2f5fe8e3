"""The shift between the clock of a measurement and that of a run, by the highest correlation.

The normalised cross-correlation, in which only pairs count that both have, is computed for all shifts by whole steps at
once with Fourier transforms (D. Padfield, Masked object registration in the Fourier domain, IEEE Trans. Image Process.
21(5) 2012, 2706-2718, eq. 10-12). Around the best of them the measurement is resampled at quarter steps, and a parabola
through the three highest values gives the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.studies.measured.computed import Computed
from tractionpower.studies.measured.samples import Samples

Array = NDArray[Any]

LEAST_PAIRS = 10
"""Pairs of values that a correlation needs."""

LEAST_OVERLAP = 0.5
"""Part of the shorter series that must overlap."""

SMALLEST_SPREAD = 1e-6
"""Standard deviation as a part of the largest value below which a signal is constant."""

UNLIKE = 0.5
"""Correlation below which two series hardly resemble each other."""

MORE_OPPOSITE = 0.1
"""By how much a series must be more opposite than alike for its sign to be taken for wrong."""

CLOSE = 0.02
"""Two maxima whose correlations differ by less are equally good."""

LEAST_FALL = 1e-4
"""Fall of the correlation that is told from rounding."""

FINE = 4
"""Parts of a step by which the measurement is moved around the best whole step."""


@dataclass(frozen=True, slots=True)
class Pair:
    """A computed series and the measured one that is held against it; sign -1 turns one of them round."""

    computed: Computed
    measured: Samples
    sign: float = 1.0


@dataclass(frozen=True, slots=True)
class Shift:
    """A shift of the clock.

    Attributes
    ----------
    shift_s
        What is added to the measured times [s].
    correlation
        Mean correlation of the series by which it was found; NaN if it was given or could not be found.
    width_s
        How wide the maximum is [s], up to where the part that does not correlate is half as large again.
    rival_s, rival_correlation
        The best of the other maxima [s], NaN if there is none.
    shifts_s, correlations
        The search, for a figure.
    doubts
        What makes the shift doubtful, in words.
    """

    shift_s: float
    correlation: float = np.nan
    width_s: float = np.nan
    rival_s: float = np.nan
    rival_correlation: float = np.nan
    shifts_s: Array | None = None
    correlations: Array | None = None
    doubts: tuple[str, ...] = ()


def correlation(a: Array, b: Array) -> float:
    """Return the correlation of two series over the pairs that both have; NaN if they are few or one is constant."""
    both = np.isfinite(a) & np.isfinite(b)
    if np.count_nonzero(both) < LEAST_PAIRS or is_constant(a[both]) or is_constant(b[both]):
        return np.nan
    x, y = a[both] - a[both].mean(), b[both] - b[both].mean()
    return float(np.clip(x @ y / np.sqrt((x @ x) * (y @ y)), -1.0, 1.0))


def is_constant(values: Array) -> bool:
    """Return whether values hardly change."""
    known = values[np.isfinite(values)]
    return bool(known.size < 2 or np.std(known) <= SMALLEST_SPREAD * np.abs(known).max())


def find_shift(pairs: Sequence[Pair], range_s: float) -> Shift:
    """Return the shift within `range_s` [s] either way for which the series are most alike.

    A series that at no shift resembles the computed one as much as it is its opposite at some has the wrong sign: it counts
    turned round, so that it does not spoil the shift of the others.
    """
    curves, used = [], []
    step = min((pair.computed.every_s for pair in pairs), default=1.0)
    lags = np.arange(-int(np.floor(range_s / step + 1e-9)), int(np.floor(range_s / step + 1e-9)) + 1)
    for pair in pairs:
        if not is_constant(pair.computed.values) and pair.measured.begin.size:
            curve = _curve(pair, step, lags)
            if np.isfinite(curve).any():
                lowest, highest = np.nanmin(curve), np.nanmax(curve)
                sign = -1.0 if lowest < -UNLIKE and -lowest > highest + MORE_OPPOSITE else 1.0
                curves.append(sign * curve)
                used.append(replace(pair, sign=sign))
    if not curves:
        doubt = "no shift can be found: the series do not overlap within the range, or are constant; 0 s is taken"
        return Shift(0.0, doubts=(doubt,))
    known = np.isfinite(curves)
    count = known.sum(axis=0)
    total = np.where(known, curves, 0.0).sum(axis=0)
    # A shift at which series fall out counts only if most are still there.
    mean = np.divide(total, count, out=np.full(len(lags), np.nan), where=2 * count >= len(curves))
    best = int(np.nanargmax(mean))
    shift_s, highest = _refined(used, float(lags[best] * step), step, (float(lags[0]), float(lags[-1])))
    highest = float(max(highest, mean[best])) if np.isfinite(highest) else float(mean[best])
    return _judged(Shift(shift_s, highest, shifts_s=lags * step, correlations=mean), best, step)


def _curve(pair: Pair, step: float, lags: Array) -> Array:
    """Return the correlation for each lag, NaN where too little overlaps."""
    windows, values = pair.computed.windows, pair.computed.values
    place = np.rint((windows - windows[0]) / step).astype(int)
    x = np.full(place[-1] + 1, np.nan)
    x[place] = values
    reach = len(lags) // 2
    begin = windows[0] + step * np.arange(-reach, len(x) + reach)
    y = pair.measured.means(begin, pair.computed.step_s)
    if is_constant(y):
        return np.full(len(lags), np.nan)
    # Lag k adds k steps to the measured times: x[i] meets y[i + reach - k].
    return _masked(x, y, len(lags))[::-1]


def _masked(x: Array, y: Array, count: int) -> Array:
    """Return the normalised correlation of `x` with ``y[m:]`` for m from 0 to `count` - 1, over pairs that both have."""
    here, there = np.isfinite(x), np.isfinite(y)
    a = np.where(here, (x - np.nanmean(x)) / np.nanstd(x), 0.0)
    b = np.where(there, (y - np.nanmean(y)) / np.nanstd(y), 0.0)
    size = 1 << int(np.ceil(np.log2(len(x) + len(y))))
    from_x = [np.conj(np.fft.rfft(part, size)) for part in (here.astype(float), a, a * a)]
    from_y = [np.fft.rfft(part, size) for part in (there.astype(float), b, b * b)]

    def summed(i: int, j: int) -> Array:
        return np.asarray(np.fft.irfft(from_x[i] * from_y[j], size)[:count])

    n = np.rint(summed(0, 0))
    enough = n >= max(LEAST_PAIRS, LEAST_OVERLAP * min(here.sum(), there.sum()))
    n = np.where(enough, n, 1.0)
    sum_a, sum_b = summed(1, 0), summed(0, 1)
    spread_a, spread_b = summed(2, 0) - sum_a**2 / n, summed(0, 2) - sum_b**2 / n
    product = np.sqrt(np.clip(spread_a, 0.0, None) * np.clip(spread_b, 0.0, None))
    usable = enough & (spread_a > SMALLEST_SPREAD * n) & (spread_b > SMALLEST_SPREAD * n)
    return np.asarray(np.divide(summed(1, 1) - sum_a * sum_b / n, product, out=np.full(count, np.nan), where=usable))


def _refined(pairs: Sequence[Pair], shift_s: float, step: float, ends: tuple[float, float]) -> tuple[float, float]:
    """Return the shift around a whole number of steps for which the correlation is highest, and that correlation."""
    shifts = shift_s + step / FINE * np.arange(-FINE, FINE + 1)
    found = np.array([_mean_correlation(pairs, shift) for shift in shifts])
    if not np.isfinite(found).all():
        return shift_s, np.nan
    k = int(np.argmax(found))
    if k in (0, len(shifts) - 1):
        return float(np.clip(shifts[k], ends[0] * step, ends[1] * step)), float(found[k])
    low, top, high = found[k - 1 : k + 2]
    curve = low - 2.0 * top + high
    part = 0.5 * (low - high) / curve if curve < 0.0 else 0.0
    refined = shifts[k] + part * step / FINE
    return float(np.clip(refined, ends[0] * step, ends[1] * step)), float(top - 0.25 * (low - high) * part)


def _mean_correlation(pairs: Sequence[Pair], shift_s: float) -> float:
    values = [
        pair.sign * correlation(pair.computed.values, pair.measured.means(pair.computed.windows - shift_s, pair.computed.step_s))
        for pair in pairs
    ]
    known = [value for value in values if np.isfinite(value)]
    return float(np.mean(known)) if known else np.nan


def _judged(shift: Shift, best: int, step: float) -> Shift:
    """Return a shift with its sharpness, its rival and its doubts."""
    assert shift.correlations is not None
    assert shift.shifts_s is not None
    curve, highest = np.nan_to_num(shift.correlations, nan=-1.0), shift.correlation
    low, high = _stretch(curve, best, highest - max(0.5 * (1.0 - highest), LEAST_FALL))
    width = (high - low + 1) * step
    # The maximum ends where the correlation has fallen half way to its middle; what is higher than that beyond is another.
    a, b = _stretch(curve, best, 0.5 * (highest + float(np.median(curve))))
    wide = np.concatenate(([-np.inf], curve, [-np.inf]))
    tops = (curve >= wide[:-2]) & (curve >= wide[2:]) & np.isfinite(shift.correlations)
    tops[a : b + 1] = False
    rest = np.where(tops, curve, -np.inf)
    rival = int(np.argmax(rest))
    has_rival = bool(tops[rival])
    rival_s, rival_r = (float(shift.shifts_s[rival]), float(rest[rival])) if has_rival else (np.nan, np.nan)
    doubts = []
    if highest < UNLIKE:
        doubts.append(f"measured and computed values hardly resemble each other: the highest correlation is {highest:.2f}")
    if has_rival and highest - rival_r < CLOSE:
        doubts.append(f"the shift is ambiguous: {rival_s:+.1f} s is as good (correlation {rival_r:.3f} against {highest:.3f})")
    if best in (0, len(curve) - 1):
        doubts.append(f"the best shift lies at the end of the range: widen shift_range_s beyond {abs(shift.shifts_s[best]):g} s")
    elif width > 0.25 * len(curve) * step:
        doubts.append(f"the maximum is flat: within {width:g} s all shifts are about as good")
    return Shift(
        shift.shift_s, highest, width, rival_s, rival_r, shift.shifts_s, shift.correlations, tuple(doubts)
    )  # fmt: skip


def _stretch(curve: Array, peak: int, level: float) -> tuple[int, int]:
    """Return first and last index around a peak up to which a curve stays at or above a level."""
    below = np.flatnonzero(curve < level)
    before, after = below[below < peak], below[below > peak]
    return (int(before[-1]) + 1 if before.size else 0), (int(after[0]) - 1 if after.size else len(curve) - 1)
