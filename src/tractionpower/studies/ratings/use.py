"""How much of its rating a device uses: highest sliding root mean square over each window of its duty class."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tractionpower.results.device_loads import DeviceLoads
from tractionpower.supply.devices import Device, columns_of
from tractionpower.supply.ratings import Rating

WHOLE_RUN = 0.0
"""The window that is as long as the run [s]."""

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
        What the rating permits [A]; NaN without a rating.
    utilisation_percent
        `load_a` of `permitted_a` [%]; NaN without a rating.
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


def uses(
    devices: Sequence[Device], ratings: Sequence[Rating], loads: DeviceLoads, from_s: float, allowed_percent: float = 100.0
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

    Raises
    ------
    LookupError
        If a rating has a window that `loads` has not looked at.
    """
    columns = columns_of(devices)
    table = _Loads(loads, from_s)
    found: list[Use] = []
    for number, (device, rating) in enumerate(zip(devices, ratings, strict=True)):
        own = np.flatnonzero(columns == number)
        found += _marked([_use(device, rating, window, table.of(own, window[0]), allowed_percent) for window in _windows(rating)])
    return tuple(found)


def ruling(found: Sequence[Use]) -> tuple[Use, ...]:
    """Return the ruling use of each device, in their order."""
    return tuple(use for use in found if use.ruling)


def _windows(rating: Rating) -> tuple[tuple[float, float], ...]:
    return rating.windows if rating.windows and np.isfinite(rating.rated_a) else ((WHOLE_RUN, math.nan),)


def _use(device: Device, rating: Rating, window: tuple[float, float], load: tuple[float, float], allowed_percent: float) -> Use:
    window_s, multiple = window
    load_a, from_s = load
    permitted_a = rating.rated_a * multiple
    percent = 100.0 * load_a / permitted_a
    met = "" if math.isnan(percent) else "yes" if percent <= allowed_percent * (1.0 + _ROUNDING) else "no"
    return Use(device, rating, window_s, load_a, permitted_a, percent, from_s, False, met)


def _marked(own: list[Use]) -> list[Use]:
    """Return the uses of one device with the ruling one marked."""
    worst = max(
        range(len(own)), key=lambda k: -math.inf if math.isnan(own[k].utilisation_percent) else own[k].utilisation_percent
    )
    return [replace(use, ruling=k == worst) for k, use in enumerate(own)]


class _Loads:
    """Root mean squares by columns and windows."""

    def __init__(self, loads: DeviceLoads, from_s: float) -> None:
        self.loads, self.run_from_s = loads, from_s
        self.rms_a, self.best, self.from_s = loads.rms_a, loads.best_rms, loads.from_s

    def of(self, columns: NDArray[np.int64], window_s: float) -> tuple[float, float]:
        """Return the greatest load of some columns over a window [A], and when it begins [s]."""
        if window_s == WHOLE_RUN or window_s > self.loads.seconds * (1.0 + _ROUNDING):
            return float(self.rms_a[columns].max()), self.run_from_s
        if window_s not in self.loads.windows_s:
            raise LookupError(f"nothing is known of windows of {window_s:g} s")
        row = self.loads.windows_s.index(window_s)
        if np.isnan(self.best[row, columns[0]]):  # a window that rounds to more steps than the run has
            return float(self.rms_a[columns].max()), self.run_from_s
        column = columns[int(np.argmax(self.best[row, columns]))]
        return float(self.best[row, column]), float(self.from_s[row, column])
