"""Table ``peaks``: when each device carries most, and which trains cause how much of it."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.device_recorder import DeviceRecorder
from tractionpower.cosimulation.places import Places
from tractionpower.cosimulation.tables import CompiledScenario, assemble
from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Supply
from tractionpower.studies.ratings.superposition import Instant, Superposition
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import DeviceCurrents

Floats = NDArray[np.float64]

LEAST_PART_A = 1e-3
"""A train with a smaller part in a peak is not listed [A]."""


@dataclass(frozen=True)
class _Kept:
    """A step at which a device carries most so far: what was on, and the supply in its states then."""

    instant: Instant
    supply: Supply


class PeakWatch:
    """Keeps what was on in the steps at which devices carry most; to be called after the recorder of their currents.

    Parameters
    ----------
    scenario, compiled
        What runs, with all devices in their normal states.
    recorder
        Takes the currents of the devices.
    """

    def __init__(self, scenario: Scenario, compiled: CompiledScenario, recorder: DeviceRecorder) -> None:
        self._scenario, self._movement, self._recorder = scenario, compiled.movement, recorder
        self._places = Places(scenario, compiled.movement)
        self._currents = DeviceCurrents(compiled.supply)
        self._seen_s: Floats = recorder.loads.peak_s.copy()
        self._kept: dict[float, _Kept] = {}

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Keep those of some steps that are peaks."""
        peak_s = self._recorder.loads.peak_s
        new = np.unique(peak_s[(peak_s != self._seen_s) & ~np.isnan(peak_s)])
        if not len(new):
            return
        ends = np.cumsum(rows.steps["trains"])
        for when in new.tolist():
            row = int(np.searchsorted(time_s, when))
            trains = rows.trains[ends[row] - rows.steps["trains"][row] : ends[row]]
            instant = Instant(
                rows.source_a[row].copy(), rows.load_a[row].copy(),
                *(trains[name].copy() for name in ("train", "s_m", "current_a")),
            )  # fmt: skip
            self._kept[when] = _Kept(instant, supply.supply)
        self._seen_s = peak_s.copy()
        current = set(peak_s.tolist())
        self._kept = {when: kept for when, kept in self._kept.items() if when in current}

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the rows of table ``peaks``: of each device the trains that have a part in its peak, the greatest first.

        The parts of all trains and loads and the remainder add up to the peak. A part is negative where without it the peak
        would be greater.
        """
        loads = self._recorder.loads
        columns = [self._recorder.peak_of(number) for number in range(len(self._recorder.devices))]
        parts = self._parts(columns)
        for number, device in enumerate(self._recorder.devices):
            column = columns[number]
            peak_s = float(loads.peak_s[column])
            head = {"device": device.id, "kind": device.kind, "peak_a": float(loads.peak_a[column]), "peak_s": peak_s}
            if math.isnan(peak_s):
                yield head
                continue
            own, sign = parts[column], math.copysign(1.0, loads.signed_peak_a[column])
            yield from (head | row for row in self._rows_of(self._kept[peak_s].instant, sign * own))

    def _rows_of(self, instant: Instant, own: Floats) -> Iterator[dict[str, Any]]:
        """Yield what has a part in one peak: `own` are the remainder and the parts of loads and trains [A]."""
        remainder_a, load_a, trains = float(own[0]), float(own[1]), own[2:]
        listed = [k for k in np.argsort(-np.abs(trains), kind="stable").tolist() if abs(trains[k]) >= LEAST_PART_A]
        for k in listed:
            number = int(instant.train[k])
            track, km = self._places.name(number, float(instant.s_m[k]))
            yield {
                "train": self._movement.names[number], "train_current_a": float(instant.train_a[k]), "track": track,
                "position_km": km, "part_a": float(trains[k]), "remainder_a": remainder_a,
            }  # fmt: skip
        if abs(load_a) >= LEAST_PART_A or not listed:
            yield {"train": "", "train_current_a": float(instant.load_a.sum()), "part_a": load_a, "remainder_a": remainder_a}

    def _parts(self, columns: list[int]) -> dict[int, Floats]:
        """Return for each of some columns of currents what nothing, all loads and each train cause of it at its peak [A]."""
        at: dict[float, list[int]] = defaultdict(list)
        for column in columns:
            at[float(self._recorder.loads.peak_s[column])].append(column)
        compiled: dict[int, CompiledScenario] = {}
        found: dict[int, Floats] = {}
        for when, here in at.items():
            if math.isnan(when):
                continue
            kept = self._kept[when]
            if id(kept.supply) not in compiled:
                compiled[id(kept.supply)] = assemble(self._scenario, self._movement, kept.supply)
            tables = compiled[id(kept.supply)]
            amps = self._currents(Superposition(tables, kept.instant).rows, tables.supply)
            for column in here:
                found[column] = np.concatenate([amps[:1, column], amps[1:-1, column] - amps[0, column]])
        return found
