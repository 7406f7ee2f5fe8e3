"""When the outage of a unit is the worst that a reserve replaces: looked for in the base case."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.quiet import run_quietly
from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.contingency import Contingency
from tractionpower.model.scenario import Scenario
from tractionpower.results.device_loads import DeviceLoads
from tractionpower.studies.ratings.counted import counted
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]


def worst_waits(scenario: Scenario) -> dict[str, float]:
    """Return when to begin the outage of a unit of each substation with a reserve [s after midnight].

    That is the start of the time of length `reserve_after_s` over which its units carry most in the base case at the normal
    grid voltage, by the root mean square; where the run is shorter than that, the first moment that counts. It takes a run,
    kept for the next call with the same scenario; without reserves there is none.
    """
    if not any(station.reserve_units and station.reserve_after_s > 0.0 for station in scenario.supply.substations):
        return {}
    bare = scenario.model_copy(update={"contingency": Contingency()})
    return dict(_worst_waits(_Hashed(bare)))


class _Hashed:
    """A scenario by its hash."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.key = scenario, scenario.input_hash

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Hashed) and self.key == other.key


@lru_cache(maxsize=64)
def _worst_waits(hashed: _Hashed) -> tuple[tuple[str, float], ...]:
    scenario = hashed.scenario
    from_s, watch = scenario.clock.counts_from_s, _UnitWatch(scenario)
    run_quietly(scenario, [watch])
    return tuple((name, watch.worst_s(name, seconds, from_s)) for name, seconds in watch.waits.items())


class _UnitWatch:
    """Takes the currents of one unit of each substation with a reserve.

    Attributes
    ----------
    waits
        Time until the reserve feeds, by substation [s].
    """

    def __init__(self, scenario: Scenario) -> None:
        clock, stations = scenario.clock, sorted(scenario.supply.substations, key=lambda station: station.id)
        self._from_s = clock.counts_from_s
        self.waits = {station.id: station.reserve_after_s for station in stations if station.reserve_units}
        self._at = [k for k, station in enumerate(stations) if station.id in self.waits]
        longest_s = clock.end - self._from_s + 0.5 * clock.step_s
        self._loads = DeviceLoads(len(self._at), clock.step_s, [wait for wait in self.waits.values() if wait <= longest_s])

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps, with the supply in its states then."""
        time_s, rows = counted(self._from_s, time_s, rows)
        own = [supply.substations[k] for k in self._at]
        units = np.array([s.units if s.units_in_service is None else s.units_in_service for s in own])
        if len(time_s):
            self._loads.add(time_s, rows.source_a[:, self._at] / np.maximum(units, 1))

    def worst_s(self, station: str, seconds: float, otherwise_s: float) -> float:
        """Return the start of the time in which the units of a substation carry most [s after midnight]."""
        if seconds not in self._loads.windows_s:
            return otherwise_s
        found = float(self._loads.from_s[self._loads.windows_s.index(seconds), list(self.waits).index(station)])
        return round(found, 3) if np.isfinite(found) else otherwise_s
