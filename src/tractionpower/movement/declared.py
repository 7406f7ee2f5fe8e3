"""What stands in a timetable for the runs of a day: the checks tell a problem of a service once, and where it is declared."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from tractionpower.model.scenario import Scenario
from tractionpower.model.services import DAY_BEFORE, run_name, service_run, start_times
from tractionpower.model.timetable import TrainRun
from tractionpower.movement.telling import item_paths


@dataclass(frozen=True, slots=True)
class Declared:
    """A train or a service of the timetable that runs on the day.

    Attributes
    ----------
    path
        Its model path.
    run
        The train as declared; of a service its run with times counted from the start.
    runs
        Its runs of the day, in order; those that the day before has left are not among them.
    is_service
        Whether it is a service.
    """

    path: str
    run: TrainRun
    runs: tuple[TrainRun, ...]
    is_service: bool

    def at(self, key: str) -> str:
        """Return the model path of the key of a run, which a service calls otherwise."""
        if self.is_service:
            key = {"start.time": "first", "start.speed_kmh": "start_speed_kmh"}.get(key, key)
        return f"{self.path}.{key}"

    def moved(self, path: str) -> str:
        """Return a model path of a run of this as that of what is declared."""
        return self.at(path.removeprefix(f"{self.path}.")) if path.startswith(f"{self.path}.") else path


def declared_runs(scenario: Scenario) -> list[Declared]:
    """Return what stands for the runs of the day, those left of the day before included."""
    table = scenario.timetable
    runs: dict[str, list[TrainRun]] = defaultdict(list)
    for run in scenario.runs:
        today = runs[run.id.removesuffix(DAY_BEFORE)]
        if not run.id.endswith(DAY_BEFORE):
            today.append(run)
    found = [
        Declared(path, run, tuple(runs[run.id][:1]), False)
        for path, run in zip(item_paths("timetable.trains", [run.id for run in table.trains]), table.trains, strict=True)
        if run.id in runs
    ]
    for path, service in zip(
        item_paths("timetable.services", [service.id for service in table.services]), table.services, strict=True
    ):
        names = [run_name(service, time) for time in start_times(service)]
        known = [name for name in names if name in runs]
        if known:
            mine = tuple(run for name in known for run in runs[name][:1])
            found.append(Declared(path, service_run(service, 0.0, service.id), mine, True))
    return found
