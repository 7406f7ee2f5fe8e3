"""Table ``ratings``: every device over every window, and what its rating permits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from tractionpower.results.device_loads import DeviceLoads
from tractionpower.studies.ratings.use import WHOLE_RUN, Use
from tractionpower.supply.devices import columns_of

NAN = math.nan


def rating_rows(found: Sequence[Use], loads: DeviceLoads, from_s: float) -> Iterator[dict[str, Any]]:
    """Yield the rows of table ``ratings``: windows of the ratings and all others that the run was long enough for.

    Parameters
    ----------
    found
        Uses of the devices, in the order of the devices.
    loads
        Their loads.
    from_s
        Start of what is counted of the run [s].
    """
    uses: dict[str, dict[float, Use]] = {}
    for use in found:
        uses.setdefault(use.device.id, {})[use.window_s] = use
    devices = [next(iter(own.values())).device for own in uses.values()]
    columns, means = columns_of(devices), _Means(loads)
    for number, own in enumerate(uses.values()):
        at = np.flatnonzero(columns == number)
        for window_s in sorted({WHOLE_RUN, *own, *means.full}):
            rated = own.get(window_s)
            load_a, begin_s = means.rms(at, window_s, from_s) if rated is None else (rated.load_a, rated.from_s)
            yield {**_device(own), **_held(rated), "window_s": window_s, "load_a": load_a, "from_s": begin_s,
                   "mean_a": means.mean(at, window_s)}  # fmt: skip


def _device(own: dict[float, Use]) -> dict[str, Any]:
    use = next(iter(own.values()))
    device, rating = use.device, use.rating
    return {
        "device": device.id, "kind": device.kind, "station": device.station, "track": device.track,
        "from_km": device.from_km, "to_km": device.to_km, "rated_current_a": rating.rated_a,
        "duty_class": rating.duty_class, "status": rating.status, "source": rating.source,
    }  # fmt: skip


def _held(use: Use | None) -> dict[str, Any]:
    """Return what a window is held against; nothing for one that the rating does not name."""
    if use is None:
        return {"permitted_a": NAN, "utilisation_percent": NAN, "ruling": False, "met": "", "left_a": NAN}
    return {
        "permitted_a": use.permitted_a, "utilisation_percent": use.utilisation_percent, "ruling": use.ruling,
        "met": use.met, "left_a": use.left_a,
    }  # fmt: skip


class _Means:
    """Highest root mean squares and means by columns and windows."""

    def __init__(self, loads: DeviceLoads) -> None:
        self._windows = loads.windows_s
        self._rms, self._rms_from_s, self._mean = loads.best_rms, loads.from_s, loads.best_mean
        self._run_rms, self._run_mean = loads.rms_a, loads.mean_magnitude_a
        self.full = [window for window, best in zip(self._windows, self._rms, strict=True) if np.isfinite(best).all()]

    def rms(self, at: Any, window_s: float, run_from_s: float) -> tuple[float, float]:
        if window_s == WHOLE_RUN:
            return float(self._run_rms[at].max()), run_from_s
        row = self._windows.index(window_s)
        column = at[int(np.argmax(self._rms[row, at]))]
        return float(self._rms[row, column]), float(self._rms_from_s[row, column])

    def mean(self, at: Any, window_s: float) -> float:
        if window_s == WHOLE_RUN:
            return float(self._run_mean[at].max())
        if window_s not in self.full:
            return NAN
        return float(self._mean[self._windows.index(window_s), at].max())
