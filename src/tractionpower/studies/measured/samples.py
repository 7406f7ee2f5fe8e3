"""Samples as a function with gaps, of time or of place, whose integrals over any windows are exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Kind = Literal["instant", "mean_after", "mean_before"]

USUAL_GAPS = 5.0
"""Rows further apart than so many usual distances leave a gap."""

LEAST_COVERED = 0.5
"""Part of a window that must be measured for it to have a mean."""


@dataclass(frozen=True, slots=True)
class Samples:
    """Straight pieces one behind the other, with gaps between some of them.

    Attributes
    ----------
    begin, end
        Where each piece begins and ends, rising; a piece has a length.
    first, last
        Values at both ends.
    gaps
        Begin and end of each gap, shape (gaps, 2).
    usual
        Usual distance of two rows.
    """

    begin: Array
    end: Array
    first: Array
    last: Array
    gaps: Array
    usual: float

    def totals(self, at: Array) -> tuple[Array, Array]:
        """Return the integral of the values, and the measured length, from the beginning up to some places."""
        if not self.begin.size:
            return np.zeros(len(at)), np.zeros(len(at))
        lengths = self.end - self.begin
        areas = np.concatenate(([0.0], np.cumsum(lengths * (self.first + self.last) / 2.0)))
        covered = np.concatenate(([0.0], np.cumsum(lengths)))
        piece = np.searchsorted(self.begin, at, side="right") - 1
        inside = np.maximum(piece, 0)
        along = np.where(piece < 0, 0.0, np.clip(at - self.begin[inside], 0.0, lengths[inside]))
        slope = (self.last[inside] - self.first[inside]) / lengths[inside]
        return areas[inside] + along * (self.first[inside] + slope * along / 2.0), covered[inside] + along

    def means(self, begin: Array, width: float) -> Array:
        """Return means over windows of a `width`; NaN where less than half of a window was measured."""
        low, covered_low = self.totals(begin)
        high, covered_high = self.totals(begin + width)
        covered = covered_high - covered_low
        enough = covered >= LEAST_COVERED * width * (1.0 - 1e-9)
        return np.asarray(np.divide(high - low, covered, out=np.full(len(begin), np.nan), where=enough & (covered > 0.0)))


def samples_of(at: Array, values: Array, kind: Kind = "instant", gap: float | None = None) -> Samples:
    """Return samples as a function.

    Parameters
    ----------
    at, values
        Strictly rising places or times, and the finite values there.
    kind
        ``instant``: straight lines between the samples; ``mean_after``: each holds until the next; ``mean_before``: since
        the one before. Beside a gap a mean holds for the usual distance.
    gap
        Distance from which on there is a gap; None: five times the median.
    """
    steps = np.diff(at)
    usual = float(np.median(steps)) if steps.size else 0.0
    longest = USUAL_GAPS * usual if gap is None else gap
    whole = steps <= longest * (1.0 + 1e-9)
    gaps = np.stack([at[:-1][~whole], at[1:][~whole]], axis=1)
    if kind == "instant":
        kept = np.flatnonzero(whole)
        return Samples(at[kept], at[kept + 1], values[kept], values[kept + 1], gaps, usual)
    held = np.where(whole, steps, np.minimum(steps, usual))
    if kind == "mean_after":
        begin, end = at, at + np.append(held, usual)
    else:
        begin, end = at - np.concatenate(([usual], held)), at
    lasting = end > begin
    return Samples(begin[lasting], end[lasting], values[lasting], values[lasting], gaps, usual)


def in_order(at: Array, *columns: Array) -> tuple[Array, list[Array], int, int]:
    """Return rows sorted, those at the same place averaged; and how many fell back, and how many shared a place.

    Averaging keeps the integral: rows that share a time lie within the same interval of a coarse clock.
    """
    back = int(np.count_nonzero(np.diff(at) < 0.0))
    order = np.argsort(at, kind="stable") if back else np.arange(len(at))
    at, columns = at[order], tuple(column[order] for column in columns)
    new = np.diff(at, prepend=-np.inf) > 0.0
    if new.all():
        return at, list(columns), back, 0
    group = np.cumsum(new) - 1
    averaged = []
    for column in columns:
        known = np.isfinite(column)
        count = np.bincount(group[known], minlength=group[-1] + 1)
        total = np.bincount(group[known], column[known], minlength=group[-1] + 1)
        averaged.append(np.asarray(np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)))
    return at[new], averaged, back, int(np.count_nonzero(~new))
