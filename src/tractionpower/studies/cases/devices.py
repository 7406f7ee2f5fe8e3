"""What the devices of a case carry, of what they can bear."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.cosimulation.device_recorder import DeviceRecorder
from tractionpower.model.scenario import Scenario
from tractionpower.studies.cases.voltages import case_table, coded
from tractionpower.studies.ratings.use import Use, ruling, uses_of
from tractionpower.supply.compile import compile_network
from tractionpower.supply.devices import devices_of
from tractionpower.supply.ratings import Rating, ratings_of

NAN = float("nan")


def ratings_by_id(scenario: Scenario) -> dict[str, Rating]:
    """Return the ratings of all devices of a checked scenario by their identifiers."""
    devices = devices_of(compile_network(scenario.supply, scenario.line, scenario.limits, conductors=scenario.conductors))
    return {rating.device_id: rating for rating in ratings_of(scenario, devices)}


def device_uses(scenario: Scenario, recorder: DeviceRecorder) -> tuple[Use, ...]:
    """Return the use of each device over the window that rules it, in the order of the devices."""
    return ruling(uses_of(recorder, scenario.sizing.utilisation_percent))


def device_figures(found: tuple[Use, ...]) -> dict[str, Any]:
    """Return the key figures of the devices of a case."""
    rated = [use for use in found if np.isfinite(use.utilisation_percent)]
    worst = max(rated, key=lambda use: use.utilisation_percent, default=None)
    return {
        "utilisation_percent": NAN if worst is None else worst.utilisation_percent,
        "utilisation_device": "" if worst is None else worst.device.id,
        "overloaded": sum(use.met == "no" for use in found),
    }


def devices_table(found: tuple[Use, ...], recorder: DeviceRecorder) -> pa.Table:
    """Return table ``case_devices`` without the column case; of a section the end that carries more."""
    loads, count = recorder.loads, range(len(found))
    peaks, means = [recorder.peak_of(k) for k in count], [recorder.of(k) for k in count]
    return case_table(
        "case_devices",
        {
            "device": coded([use.device.id for use in found]),
            "kind": coded([use.device.kind for use in found]),
            "peak_a": loads.peak_a[peaks],
            "peak_s": loads.peak_s[peaks],
            "rms_a": loads.rms_a[means],
            **{name: [getattr(use, name) for use in found] for name in ("window_s", "load_a", "permitted_a")},
            **{name: [getattr(use, name) for use in found] for name in ("utilisation_percent", "from_s")},
            "met": coded([use.met for use in found]),
        },
    )
