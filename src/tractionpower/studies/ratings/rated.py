"""Table ``ratings``: every device over every window, and what its rating permits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from tractionpower.results.device_loads import DeviceLoads
from tractionpower.studies.ratings.use import WHOLE_RUN, Use, Windows
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
    columns, windows = columns_of(devices), Windows(loads, from_s)
    for number, own in enumerate(uses.values()):
        at = np.flatnonzero(columns == number)
        for window_s in sorted({WHOLE_RUN, *own, *windows.full}):
            rated = own.get(window_s)
            load_a, begin_s = windows.rms(at, window_s) if rated is None else (rated.load_a, rated.from_s)
            yield {**_device(own), **_held(rated), "window_s": window_s, "load_a": load_a, "from_s": begin_s,
                   "mean_a": windows.mean(at, window_s)}  # fmt: skip


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
