"""Departure shifts: all planned times of a train moved by the same seconds, those of linked runs with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tractionpower.model.base import format_time
from tractionpower.model.scenario import Clock
from tractionpower.model.timetable import Service, TrainRun
from tractionpower.studies.remedies.candidate import Candidate, steps_within
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import Declared, linked, planned_times, start_of


def shifts(case: Case) -> Iterator[Candidate]:
    """Yield shifts of the trains near the loss, later and earlier.

    Runs that the same train set makes afterwards are carried along to later times, those before to earlier ones. A train of
    which a linked run belongs to a service is left out: a single run of a service cannot be moved.
    """
    bounds, known = case.bounds, case.known
    for item in case.foremost:
        for onwards in (True, False):
            names = [name for run in item.runs for name in linked(case.scenario.timetable, run.id, onwards=onwards)]
            if any(name not in known for name in names):
                continue
            carried = tuple(dict.fromkeys(known[name] for name in names if known[name] is not item))
            if names and any(isinstance(each.trip, Service) for each in (item, *carried)):
                continue
            moved = (item, *carried)
            room = min(bounds.greatest_shift_s, _room(moved, case.scenario.clock, later=onwards))
            if (most := steps_within(room, bounds.shift_step_s)) > 0:
                yield _candidate(case, moved, bounds.shift_step_s if onwards else -bounds.shift_step_s, most)


def _candidate(case: Case, moved: Sequence[Declared], step: float, most: int) -> Candidate:
    first, runs = moved[0], sum(len(item.runs) for item in moved)

    def change(size: float) -> tuple[str, ...]:
        return tuple(text for item in moved for text in shift_changes(item, size))

    def tell(size: float) -> str:
        with_it = f"; so do {', '.join(item.name for item in moved[1:])}" if len(moved) > 1 else ""
        way = "later" if size > 0 else "earlier"
        return f"{first.words[0].upper()}{first.words[1:]} runs {abs(size):g} s {way}, all its planned times with it{with_it}."

    cost = case.bounds.costs.departure_shift
    return Candidate(
        "departure_shift", first.name, "s", step, most, change, tell, lambda size: cost * abs(size) * max(runs, 1)
    )  # fmt: skip


def shift_changes(item: Declared, seconds: float) -> Iterator[str]:
    """Yield the changes by path that move all planned times of a train or a service."""
    trip, path = item.trip, item.path
    if isinstance(trip, Service):  # times of its calls are counted from the start of each run
        yield f"{path}.first={format_time(trip.first + seconds)}"
        yield f"{path}.last={format_time(trip.last + seconds)}"
        return
    if trip.start is not None:
        yield f"{path}.start.time={format_time(trip.start.time + seconds)}"
    for index, call in enumerate(trip.calls):
        for name, time in (("arrival", call.arrival), ("departure", call.departure)):
            if time is not None:
                yield f"{path}.calls[{index}].{name}={format_time(time + seconds)}"


def _room(moved: Sequence[Declared], clock: Clock, *, later: bool) -> float:
    """Return by how much trains can be moved without leaving the clock [s]; a train that goes beyond it already may go on."""
    runs = [run for item in moved for run in item.runs]
    if later:
        ends = [_last(run) for run in runs]
        return min([clock.end - end for end in ends if end <= clock.end], default=float("inf"))
    starts = [start_of(run) for run in runs]
    return min([start - clock.start if start >= clock.start else start for start in starts], default=float("inf"))


def _last(run: TrainRun) -> float:
    return max([start_of(run), *planned_times(run.calls)])
