"""All that a study of ratings watches of one run, and the tables that it makes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from tractionpower.cosimulation.device_recorder import DeviceRecorder
from tractionpower.cosimulation.recorder import Watch
from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.model.scenario import Scenario
from tractionpower.studies.ratings.breakers import BreakerWatch
from tractionpower.studies.ratings.demand import DemandWatch
from tractionpower.studies.ratings.duration import duration_rows
from tractionpower.studies.ratings.peaks import PeakWatch
from tractionpower.studies.ratings.rated import rating_rows
from tractionpower.studies.ratings.sharing import SharingWatch
from tractionpower.studies.ratings.use import Use, uses_of

Rows = Iterable[dict[str, Any]]


class RatingsWatch:
    """Watches a run for the tables ``ratings``, ``peaks``, ``breakers``, ``load_duration``, ``demand`` and ``sharing``.

    Parameters
    ----------
    scenario, compiled
        What runs, with all devices in their normal states.

    Attributes
    ----------
    recorder
        Takes the currents of all devices.
    watches
        What is called with the rows of the run, in this order.
    """

    def __init__(self, scenario: Scenario, compiled: CompiledScenario) -> None:
        supply = compiled.supply
        self._sizing = scenario.sizing
        self.recorder = DeviceRecorder(scenario, supply)
        self._peaks = PeakWatch(scenario, compiled, self.recorder)
        self._breakers, self._demand = BreakerWatch(scenario, supply), DemandWatch(scenario, supply)
        self._sharing = SharingWatch(scenario, supply)
        self.watches: tuple[Watch, ...] = (self.recorder, self._peaks, self._breakers, self._demand, self._sharing)

    def uses(self) -> tuple[Use, ...]:
        """Return how much of their ratings the devices use, over every window of the ratings."""
        return uses_of(self.recorder, self._sizing.utilisation_percent)

    def tables(self, trips: Mapping[str, int]) -> Iterator[tuple[str, Rows]]:
        """Yield the names of the tables and their rows; `trips` are how often breakers have tripped, by feeder."""
        recorder = self.recorder
        yield "ratings", rating_rows(self.uses(), recorder.loads, recorder.from_s)
        yield "peaks", self._peaks.rows()
        yield "breakers", self._breakers.rows(trips, self._sizing.breaker_percent)
        yield "load_duration", duration_rows(recorder.devices, recorder.loads)
        yield "demand", self._demand.rows()
        yield "sharing", self._sharing.rows()
