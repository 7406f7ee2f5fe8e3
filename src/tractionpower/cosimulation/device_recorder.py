"""What currents load the devices of a supply with, watched while a run lasts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.check import counted_steps
from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.model.supply import Substation
from tractionpower.results.device_loads import DeviceLoads, steps_of
from tractionpower.results.windows import WINDOWS_S
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import Device, DeviceCurrents
from tractionpower.supply.ratings import Rating, ratings_of

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Wait:
    """A time in which a unit of a substation is out and its reserve does not feed yet, so that an overload is permitted.

    Attributes
    ----------
    station
        The substation.
    from_s, to_s
        Ends of the time [s after midnight].
    divisor
        By which the currents of its units count less.
    """

    station: str
    from_s: float
    to_s: float
    divisor: float


def find_waits(scenario: Scenario) -> tuple[Wait, ...]:
    """Return the times in which a reserve unit is awaited.

    Such a time begins when fewer units than before are in service, by a switch event or at the start of the clock by fewer
    than all, and ends when one comes back, which it must within `reserve_after_s`; else no reserve is awaited. Times of one
    substation that overlap, as a second unit goes before the first is replaced, are one: the overload is permitted once.
    """
    return tuple(wait for station in scenario.supply.substations for wait in _joined(_waits_of(scenario, station)))


def _joined(waits: Iterable[Wait]) -> list[Wait]:
    """Return the times of one substation, those that overlap or touch as one."""
    found: list[Wait] = []
    for wait in sorted(waits, key=lambda wait: wait.from_s):
        if found and wait.from_s <= found[-1].to_s:
            found[-1] = replace(found[-1], to_s=max(found[-1].to_s, wait.to_s))
        else:
            found.append(wait)
    return found


def _waits_of(scenario: Scenario, station: Substation) -> Iterator[Wait]:
    if not station.reserve_units or not station.reserve_overload_percent:
        return
    events = [event for event in scenario.supply.switch_events if event.device == station.id]
    start_s = scenario.clock.start
    steps = [(start_s if event.time < start_s else event.time, event.units_in_service) for event in events]
    steps = [(start_s, station.units), (start_s, station.units_in_service), *sorted(steps, key=lambda step: step[0])]
    counts = [(time_s, units) for time_s, units in steps if units is not None]
    for k, ((_, before), (out_s, left)) in enumerate(pairwise(counts)):
        again = next((time_s for time_s, units in counts[k + 2 :] if units > left), None)
        if left < before and again is not None and again <= out_s + station.reserve_after_s + ROUNDING_S:
            yield Wait(station.id, out_s, again, 1.0 + station.reserve_overload_percent / 100.0)


def _with_changing_units(scenario: Scenario) -> list[Substation]:
    """Return the substations whose units in service change during the run."""
    supply = scenario.supply
    named = {event.device for event in supply.switch_events if event.units_in_service is not None}
    return [station for station in supply.substations if station.id in named]


def _rated_by(station: Substation) -> int:
    """Return by how many units a substation is rated: those in service from the start (`supply.ratings`)."""
    return station.units if station.units_in_service is None else station.units_in_service


class DeviceRecorder:
    """Takes the currents of all devices from the rows of a run: a watch (`cosimulation.recorder.Watch`).

    What runs before the warm-up is over does not count. Loads are as they flow. Where units go and come, other currents are
    held against the ratings: of units whose reserve is awaited (`find_waits`) those of these times divided by
    1 + `reserve_overload_percent`/100, of the substation as many of its units as it is rated by.

    Parameters
    ----------
    scenario
        What runs.
    supply
        Its supply, in any states.
    windows_s
        Windows to look at besides those of the ratings [s].

    Attributes
    ----------
    devices
        All devices.
    columns
        Number of the device of each column.
    ratings
        What they can bear, in the same order.
    loads
        Loads of all columns, over all windows that are not longer than what counts of the run.
    eased
        Loads of substations whose units go and come, and of their units, as they are held against their ratings.
    eased_columns
        The column of `eased` that belongs to a column of `loads`.
    from_s
        From when on the run counts [s].
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables, windows_s: Iterable[float] = WINDOWS_S) -> None:
        self._currents = DeviceCurrents(supply)
        self.devices: tuple[Device, ...] = self._currents.devices
        self.columns = self._currents.columns
        clock = scenario.clock
        self.ratings: tuple[Rating, ...] = ratings_of(scenario, self.devices)
        self.from_s = clock.counts_from_s
        wanted, rows = {*windows_s, *(window for rating in self.ratings for window, _ in rating.windows)}, counted_steps(clock)
        full_s = [window for window in wanted if steps_of(window, clock.step_s) <= rows]  # others only take memory
        self.loads = DeviceLoads(len(self.columns), clock.step_s, full_s)
        unit, plant = ({d.station: k for k, d in enumerate(self.devices) if d.kind == kind} for kind in ("unit", "substation"))
        self._waits = [(unit[wait.station], wait) for wait in find_waits(scenario)]
        changing = _with_changing_units(scenario)
        self._plants = [(plant[s.id], unit[s.id], _rated_by(s)) for s in changing]
        own = sorted({column for s in changing for column in (unit[s.id], plant[s.id])})
        self.eased_columns = {column: k for k, column in enumerate(own)}
        rated_s = {window for column in own for window, _ in self.ratings[column].windows}
        self.eased = DeviceLoads(len(own), clock.step_s, [window for window in full_s if window in rated_s])

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps, with the supply in its states then."""
        counted = slice(int(np.searchsorted(time_s, self.from_s - ROUNDING_S)), None)
        time_s, amps = time_s[counted], self._currents(rows, supply)[counted]
        if not len(time_s):
            return
        self.loads.add(time_s, amps)
        held, at = amps[:, list(self.eased_columns)], self.eased_columns
        for column, wait in self._waits:
            within = (time_s >= wait.from_s - ROUNDING_S) & (time_s < wait.to_s - ROUNDING_S)
            held[within, at[column]] /= wait.divisor
        for plant, unit, units in self._plants:
            held[:, at[plant]] = units * held[:, at[unit]]
        self.eased.add(time_s, held)

    def of(self, device: int) -> int:
        """Return the column of a device, of a section that of the end with the greater root mean square over the run."""
        own = np.flatnonzero(self.columns == device)
        return int(own[np.argmax(self.loads.rms_a[own])])

    def peak_of(self, device: int) -> int:
        """Return the column of a device, of a section that of the end with the greater peak."""
        own = np.flatnonzero(self.columns == device)
        return int(own[np.argmax(self.loads.peak_a[own])])
