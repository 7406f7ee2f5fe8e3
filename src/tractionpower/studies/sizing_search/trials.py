"""Designs run: each case of a design by the runner, of which the search sees what counts."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from tractionpower.cosimulation.prepared import prepare
from tractionpower.model.change import apply_changes
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.outages import outages
from tractionpower.studies.runner.case import Case, CasesProgress
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore
from tractionpower.studies.sizing_search.climb import StoppedError
from tractionpower.studies.sizing_search.items import Design, Item, changes_of
from tractionpower.studies.sizing_search.shortfalls import MENDED_BY_VOLTAGE, Asked, CaseFacts, Shortfall
from tractionpower.supply.devices import Device, devices_of

Told = Callable[[str, CasesProgress], None]
"""Called with what is being run, and how far it is."""


class Trials:
    """Runs the cases of designs; `tractionpower.studies.sizing_search.climb.Evaluator`.

    Parameters
    ----------
    scenario, library
        What is sized, and the tables of equipment.
    items
        What may be varied.
    store
        Keeps what was run, so that a search that was stopped goes on.
    workers, scheduler
        As of `run_cases`.
    progress
        Called whenever a case has ended.

    Attributes
    ----------
    rounds, runs
        Calls of `evaluate`, and runs that they took, without those taken from the store.
    interrupted
        Whether Ctrl-C came.
    """

    def __init__(
        self, scenario: Scenario, library: Library, items: Mapping[str, Item], store: CaseStore,
        *, workers: int = 1, scheduler: str | None = None, progress: Told | None = None,
    ) -> None:  # fmt: skip
        self._scenario, self._library, self._items, self._store = scenario, library, items, store
        self._workers, self._scheduler, self._progress = workers, scheduler, progress
        self._asked = Asked(scenario)
        self._devices = {device.id: device for device in devices_of(prepare(scenario)[0].supply)}
        self.rounds, self.runs, self.interrupted = 0, 0, False

    @property
    def spent(self) -> bool:
        """Whether nothing more may be tried."""
        return self.interrupted or self.rounds >= self._scenario.sizing.search.most_runs

    def evaluate(self, design: Design, only: Collection[str] | None = None) -> dict[str, CaseFacts]:
        """Return the facts of all cases, or of some, by name; of cases that a design does not have nothing.

        Raises
        ------
        StoppedError
            If Ctrl-C came before all of them were run.
        """
        changes = changes_of(self._items, design)
        cases = self._cases(changes, only)
        told = self._progress
        self.rounds += 1
        run = run_cases(
            self._scenario, self._library, cases, measure, self._store, workers=self._workers, scheduler=self._scheduler,
            progress=None if told is None else lambda how: told(f"design {self.rounds}", how),
        )  # fmt: skip
        self.runs += run.run
        if run.interrupted:
            self.interrupted = True
            raise StoppedError
        devices: dict[str, list[dict[str, object]]] = {}
        for table in run.tables("case_devices"):
            for row in table.select(["case", "device", "utilisation_percent"]).to_pylist():
                devices.setdefault(row["case"], []).append(row)
        return {row["case"]: self._asked.facts(row, devices.get(row["case"], ())) for row in run.rows}

    def _cases(self, changes: Sequence[str], only: Collection[str] | None) -> list[Case]:
        """Return the cases of a design: those of the study of outages, or its base cases."""
        designed = apply_changes(self._scenario, changes, self._library)
        found = outages(designed)
        if not self._scenario.sizing.search.outages:
            found = tuple(case for case in found if case.base)
        named = [replace(case, id=_name(case), changes=(*changes, *case.changes)) for case in found]
        return [case for case in named if only is None or case.id in only]

    def helps(self, shortfall: Shortfall) -> Sequence[str]:
        """Return the items of which more may lessen a shortfall, the nearest first."""
        device = self._devices.get(shortfall.subject) if shortfall.what == "device" else None
        names: Iterable[str] = ()
        if device is not None:
            names = self._of_device(device)
        elif shortfall.what in MENDED_BY_VOLTAGE:
            names = self._of_place(shortfall.track, shortfall.km)
        return [name for name in dict.fromkeys(names) if name in self._items]

    def _of_device(self, device: Device) -> Iterator[str]:
        if device.kind in ("unit", "substation"):
            yield f"units of {device.station}"
        elif device.kind == "contact_line":
            yield from self._lines(device.track, device.from_km, device.to_km)
        else:
            yield f"cables of {device.id}"

    def _of_place(self, track: str, km: float) -> Iterator[str]:
        """Yield the units of the two nearest substations on either side, then the contact line."""
        units = [item for item in self._items.values() if item.kind == "units"]
        for side in (-1.0, 1.0):
            beside = sorted(
                (item for item in units if side * (item.from_km - km) >= 0.0), key=lambda item: abs(item.from_km - km)
            )
            yield from (item.name for item in beside[:2])
        yield from self._lines(track, km, km)

    def _lines(self, track: str, from_km: float, to_km: float) -> Iterator[str]:
        for item in self._items.values():
            if item.kind == "contact_line" and track in item.tracks and item.from_km <= to_km and from_km <= item.to_km:
                yield item.name


def _name(case: Case) -> str:
    """Return a name that a case has in every design: how many units are left when one is out depends on the design."""
    return f"{case.subject} out, grid voltage {case.grid}" if case.kind == "unit" else case.id
