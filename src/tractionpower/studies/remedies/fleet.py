"""What a timetable declares, as the search changes it: trains and services by path, their classes, the runs linked with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from tractionpower.model.scenario import Scenario
from tractionpower.model.services import DAY_BEFORE
from tractionpower.model.timetable import Call, Service, Timetable, TrainRun


@dataclass(frozen=True, eq=False)
class Declared:
    """A train or a service as the timetable declares it.

    Attributes
    ----------
    name
        Its identifier.
    path
        Its path in the scenario.
    trip
        The declaration.
    runs
        Its runs of the day.
    """

    name: str
    path: str
    trip: TrainRun | Service
    runs: tuple[TrainRun, ...]

    @property
    def words(self) -> str:
        """What it is, and its name."""
        return f"{'service' if isinstance(self.trip, Service) else 'train'} {self.name}"


def declared_of(scenario: Scenario) -> dict[str, Declared]:
    """Return what the timetable declares, by the runs of the day."""
    runs = {run.id: run for run in scenario.runs}
    known: dict[str, Declared] = {}
    for trip in scenario.timetable.trains:
        if trip.id in runs:
            known[trip.id] = Declared(trip.id, f"timetable.trains[{trip.id}]", trip, (runs[trip.id],))
    for service in sorted(scenario.timetable.services, key=lambda service: -len(service.id)):  # `S 1` before `S`
        own = tuple(run for name, run in runs.items() if name not in known and name.startswith(f"{service.id} "))
        of_day = tuple(run for run in own if not run.id.endswith(DAY_BEFORE))  # those of the day before are no further ones
        item = Declared(service.id, f"timetable.services[{service.id}]", service, of_day)
        known |= {run.id: item for run in own}
    return known


def classes_of(scenario: Scenario, items: Iterable[Declared]) -> dict[str, tuple[Declared, ...]]:
    """Return the trains and services of each class, a type of train or a category; only classes of more than one."""
    categories = {train.id: train.category for train in scenario.trains}
    classes: dict[str, list[Declared]] = {}
    for item in dict.fromkeys(items):
        trip = item.trip
        category = trip.category or (categories.get(trip.train) if trip.train else None)
        names = [f"trains of type {trip.train}" if trip.train else "", f"category {category}" if category else ""]
        for name in filter(None, names):
            classes.setdefault(name, []).append(item)
    several = {name: tuple(members) for name, members in classes.items() if len(members) > 1}
    distinct: dict[tuple[Declared, ...], str] = {}
    for name, members in several.items():
        distinct.setdefault(members, name)  # a category with one type of train only is that type
    return {name: members for members, name in distinct.items()}


def linked(timetable: Timetable, run: str, *, onwards: bool) -> tuple[str, ...]:
    """Return the runs that the same train sets make after a run, or before it, by rotations, joins and splits."""
    pairs = [*_links(timetable)]
    following: dict[str, list[str]] = {}
    for before, after in pairs:
        following.setdefault(before if onwards else after, []).append(after if onwards else before)
    found: dict[str, None] = {}
    waiting = [run]
    while waiting:
        for name in following.get(waiting.pop(), ()):
            if name not in found and name != run:
                found[name] = None
                waiting.append(name)
    return tuple(found)


def _links(timetable: Timetable) -> Iterator[tuple[str, str]]:
    for rotation in timetable.rotations:
        yield from pairwise(rotation.runs)
    for join in timetable.joins:
        yield from ((portion, join.into) for portion in join.portions)
    for split in timetable.splits:
        yield from ((split.run, portion) for portion in split.portions)


def start_of(run: TrainRun) -> float:
    """Return when a run starts [s after midnight]."""
    if run.start is not None:
        return run.start.time
    return run.calls[0].departure or 0.0  # a run without a start has it: checked when it was made


def planned_times(calls: Sequence[Call]) -> list[float]:
    """Return the planned times of calls, in their order [s]."""
    return [time for call in calls for time in (call.arrival, call.departure) if time is not None]
