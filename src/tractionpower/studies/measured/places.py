"""Measured and computed values of a train at the same places, whatever the time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.studies.measured.computed import Computed
from tractionpower.studies.measured.errors import Compared
from tractionpower.studies.measured.reading import Measured
from tractionpower.studies.measured.samples import Samples, in_order, samples_of

Array = NDArray[Any]

METRES = 1000.0


def over_places(computed: Computed, place: Computed, measured: Measured, measured_place: Measured, every_m: float) -> Compared:
    """Return means over pieces of the way, weighted by distance, so that standing counts as a moment.

    Parameters
    ----------
    computed, place
        Computed values and places of a train, row by row.
    measured, measured_place
        The same, measured.
    every_m
        Length of the pieces [m].
    """
    km = METRES if measured_place.series.quantity == "position_km" else 1.0
    x = place.values * km
    if not computed.instant:  # a mean belongs to the middle of its step
        x = np.append((x[:-1] + x[1:]) / 2.0, x[-1])
    got = _along(x, computed.values, np.diff(computed.time_s) > 1.5 * computed.every_s)
    own, own_m = measured.time_s, np.interp(measured.time_s, measured_place.time_s, measured_place.values * km)
    gap = np.inf if not len(measured.samples.gaps) else float(np.diff(measured.samples.gaps, axis=1).min())
    given = _along(own_m, measured.values, np.diff(own) >= gap)
    low = np.floor(min(got.begin.min(initial=np.inf), given.begin.min(initial=np.inf)) / every_m)
    high = np.ceil(max(got.end.max(initial=-np.inf), given.end.max(initial=-np.inf)) / every_m)
    if not np.isfinite([low, high]).all():
        return Compared(np.empty(0), np.empty(0), np.empty(0), np.nan)
    begin = every_m * np.arange(low, high)
    middle = (begin + every_m / 2.0) / METRES
    return Compared(middle, given.means(begin, every_m), got.means(begin, every_m), np.nan)


def _along(x: Array, values: Array, broken: Array) -> Samples:
    """Return values as a function of the place [m]; a stretch before which time is missing is a gap."""
    known = np.isfinite(x) & np.isfinite(values)
    part = np.concatenate(([0], np.cumsum(broken)))[known]
    x, (values, part), _, _ = in_order(x[known], values[known], part.astype(float))
    if len(x) < 2:
        return samples_of(np.empty(0), np.empty(0))
    whole = samples_of(x, values, gap=np.inf)
    kept = np.diff(part) == 0.0
    return Samples(whole.begin[kept], whole.end[kept], whole.first[kept], whole.last[kept], whole.gaps, whole.usual)
