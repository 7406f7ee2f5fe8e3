"""How much of its rating a device uses: highest sliding root mean square over each window of its duty class."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.device_recorder import DeviceRecorder
from tractionpower.results.device_loads import DeviceLoads, steps_of
from tractionpower.results.words import yes_or_no
from tractionpower.supply.devices import Device, columns_of
from tractionpower.supply.ratings import Rating

Numbers = NDArray[np.int64]

WHOLE_RUN = 0.0
"""The window that is as long as the run [s]."""

MOST_PERCENT = 1e6
"""Utilisation of a device that may carry nothing, and does: beyond every limit, but a number that tables and charts bear."""

_ROUNDING = 1e-9
"""Share by which a utilisation may be beyond what is permitted."""


@dataclass(frozen=True, slots=True)
class Use:
    """What a device carries over one window of its rating.

    Attributes
    ----------
    device, rating
        The device and what it can bear.
    window_s
        Length of the window as the rating gives it [s]; 0: the whole run.
    load_a
        Highest root mean square of the current over the window [A].
    permitted_a
        What the rating permits [A]; NaN without a rating. Where units go and come during the run it is the load over its
        utilisation, so that it has in it what is permitted until a reserve feeds, and the units that are in service when.
    utilisation_percent
        `load_a` of `permitted_a`, at most `MOST_PERCENT` [%]; NaN without a rating.
    from_s
        Start of the window with that load [s after midnight].
    ruling
        Whether no window of the device has a higher utilisation; of equal ones the first is ruling.
    met
        yes, no; empty without a rating.
    """

    device: Device
    rating: Rating
    window_s: float
    load_a: float
    permitted_a: float
    utilisation_percent: float
    from_s: float
    ruling: bool
    met: str

    @property
    def left_a(self) -> float:
        """What of the permitted current is left [A]; negative where the device is overloaded."""
        return self.permitted_a - self.load_a


class Eased(NamedTuple):
    """Loads of units that go and come and of their substations, as they are held against their ratings, and their columns."""

    loads: DeviceLoads
    columns: Mapping[int, int]


def uses(
    devices: Sequence[Device],
    ratings: Sequence[Rating],
    loads: DeviceLoads,
    from_s: float,
    allowed_percent: float = 100.0,
    eased: Eased | None = None,
) -> tuple[Use, ...]:
    """Return the use of every device over every window of its rating; of one without a rating that over the whole run.

    A window longer than the run is held against the root mean square of the whole run, for nothing is known beyond it. Of a
    section the end with the greater load counts.

    Parameters
    ----------
    devices, ratings
        Devices and their ratings, in the same order.
    loads
        Their loads, with the columns of `supply.devices.columns_of` and all windows of the ratings that the run fills.
    from_s
        Start of what is counted of the run [s].
    allowed_percent
        Highest utilisation that is met [%].
    eased
        Loads of units that go and come and of their substations, as they are held against their ratings.

    Raises
    ------
    LookupError
        If a rating has a window that `loads` has not looked at.
    """
    columns, table = columns_of(devices), Windows(loads, from_s)
    lighter = None if eased is None else Windows(eased.loads, from_s)
    found: list[Use] = []
    for number, (device, rating) in enumerate(zip(devices, ratings, strict=True)):
        own, here = np.flatnonzero(columns == number), []
        for window_s, multiple in _windows(rating):
            load_a, begin_s = table.rms(own, window_s)
            held_a = load_a
            if eased is not None and lighter is not None and number in eased.columns:
                held_a = lighter.rms(np.array([eased.columns[number]]), window_s)[0]
            here.append(_use(device, rating, (window_s, multiple), (load_a, held_a, begin_s), allowed_percent))
        found += _marked(here)
    return tuple(found)


def uses_of(recorder: DeviceRecorder, allowed_percent: float) -> tuple[Use, ...]:
    """Return the use of every device of a run over every window of its rating (`uses`)."""
    eased = Eased(recorder.eased, recorder.eased_columns)
    return uses(recorder.devices, recorder.ratings, recorder.loads, recorder.from_s, allowed_percent, eased)


def ruling(found: Sequence[Use]) -> tuple[Use, ...]:
    """Return the ruling use of each device, in their order."""
    return tuple(use for use in found if use.ruling)


def _windows(rating: Rating) -> tuple[tuple[float, float], ...]:
    return rating.windows if rating.windows and np.isfinite(rating.rated_a) else ((WHOLE_RUN, math.nan),)


def _use(
    device: Device, rating: Rating, window: tuple[float, float], load: tuple[float, float, float], allowed_percent: float
) -> Use:
    """Return a use: its window [s] and multiple; its load as it flows, as it is held against the rating [A], its start [s]."""
    load_a, held_a, from_s = load
    rated_a = rating.rated_a * window[1]
    percent = _percent(held_a, rated_a)
    permitted_a = rated_a * (load_a / held_a) if held_a > 0.0 else rated_a
    met = yes_or_no(None if math.isnan(percent) else percent <= allowed_percent * (1.0 + _ROUNDING))
    return Use(device, rating, window[0], load_a, permitted_a, percent, from_s, False, met)


def _percent(load_a: float, permitted_a: float) -> float:
    if permitted_a == 0.0:
        return MOST_PERCENT if load_a > 0.0 else 0.0
    return min(100.0 * load_a / permitted_a, MOST_PERCENT)


def _marked(own: list[Use]) -> list[Use]:
    """Return the uses of one device with the ruling one marked."""
    worst = max(
        range(len(own)), key=lambda k: -math.inf if math.isnan(own[k].utilisation_percent) else own[k].utilisation_percent
    )
    return [replace(use, ruling=k == worst) for k, use in enumerate(own)]


class Windows:
    """Highest root mean squares and means of columns over windows.

    Parameters
    ----------
    loads
        What the devices carried.
    from_s
        Start of what is counted of the run [s].

    Attributes
    ----------
    full
        Windows that the run fills, of those that were looked at [s].
    """

    def __init__(self, loads: DeviceLoads, from_s: float) -> None:
        self._loads, self._run_from_s = loads, from_s
        self._run_rms, self._run_mean = loads.rms_a, loads.mean_magnitude_a
        self._rms, self._from_s, self._mean = loads.best_rms, loads.from_s, loads.best_mean
        self.full = tuple(window for window in loads.windows_s if self._is_full(window))

    def _is_full(self, window_s: float) -> bool:
        return window_s != WHOLE_RUN and steps_of(window_s, self._loads.step_s) <= self._loads.count

    def rms(self, columns: Numbers, window_s: float) -> tuple[float, float]:
        """Return the greatest root mean square of some columns [A], and when it begins [s].

        Of a window that the run does not fill that of the whole run.
        """
        if not self._is_full(window_s):
            return float(self._run_rms[columns].max()), self._run_from_s
        row = self._row(window_s)
        column = columns[int(np.argmax(self._rms[row, columns]))]
        return float(self._rms[row, column]), float(self._from_s[row, column])

    def mean(self, columns: Numbers, window_s: float) -> float:
        """Return the greatest mean of the magnitude of some columns [A]; NaN for a window that the run does not fill."""
        if window_s == WHOLE_RUN:
            return float(self._run_mean[columns].max())
        return float(self._mean[self._row(window_s), columns].max()) if self._is_full(window_s) else math.nan

    def _row(self, window_s: float) -> int:
        if window_s not in self._loads.windows_s:
            raise LookupError(f"nothing is known of windows of {window_s:g} s")
        return self._loads.windows_s.index(window_s)
