"""Table ``load_duration``: which current a device carries for which share of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from tractionpower.results.device_loads import DeviceLoads
from tractionpower.supply.devices import Device, columns_of

SHARES_PERCENT = (0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, *(float(share) for share in range(10, 101, 5)))
"""Shares of the run at which the current is told; 0: the peak."""


def duration_rows(devices: Sequence[Device], loads: DeviceLoads) -> Iterator[dict[str, Any]]:
    """Yield the rows of table ``load_duration``; of a section that of the end with the greater root mean square."""
    columns, rms = columns_of(devices), loads.rms_a
    amps = loads.load_duration([share / 100.0 for share in SHARES_PERCENT])
    for number, device in enumerate(devices):
        own = np.flatnonzero(columns == number)
        shown = amps[:, own[int(np.argmax(rms[own]))]].tolist()
        for share, current_a in zip(SHARES_PERCENT, shown, strict=True):
            yield {"device": device.id, "kind": device.kind, "share_percent": share, "current_a": current_a}
