"""The runs of a day: trains as declared, those that services stand for, those that the day before has left."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import get_args

from tractionpower.model.base import DAY_S, format_time
from tractionpower.model.timetable import Call, Day, Service, Start, Timetable, TrainRun

DAY_BEFORE = " (day before)"
"""Ends the name of a run of the day before that is still on the line at midnight."""

MOST_RUNS = 10_000
"""A service has no more runs than this."""

_DECIMALS = 6  # of times
_OF_A_SERVICE = ("first", "last", "headway_s", "start_speed_kmh")


@lru_cache(maxsize=8)
def unfold(timetable: Timetable, day: Day | None) -> tuple[TrainRun, ...]:
    """Return the runs of a timetable on a day: its trains, and the runs of its services.

    A run belongs to the day on which its timetable begins, also past midnight. With `carry_over` those of the day before
    that are still under way at midnight run as well, their times counted from the midnight between.

    Parameters
    ----------
    timetable
        The timetable as declared.
    day
        The day; None: everything runs that is not bound to days.
    """
    today = tuple(_of_day(timetable, day))
    if not timetable.carry_over:
        return today
    return (*today, *(_carried(run) for run in _of_day(timetable, _before(day)) if last_time(run) > DAY_S))


def run_names(timetable: Timetable) -> dict[str, Service | None]:
    """Return the names of all runs of all days, each with the service that it is of."""
    names: dict[str, Service | None] = {run.id: None for run in timetable.trains}
    return names | {run_name(service, time): service for service in timetable.services for time in start_times(service)}


def run_name(service: Service, start_s: float) -> str:
    """Return the name of the run of a service that starts at `start_s` [s after midnight].

    Seconds are written where the time is not one of whole minutes.
    """
    return f"{service.id} {format_time(start_s).removesuffix(':00')}"


def start_times(service: Service) -> list[float]:
    """Return when the runs of a service start [s after midnight], at most `MOST_RUNS`."""
    return [round(service.first + k * service.headway_s, _DECIMALS) for k in range(min(count_runs(service), MOST_RUNS))]


def count_runs(service: Service) -> int:
    """Return how many runs a service has."""
    return max(0, math.floor((service.last - service.first) / service.headway_s + 1e-9) + 1)


def service_run(service: Service, start_s: float, name: str) -> TrainRun:
    """Return a run of a service that starts at `start_s` [s after midnight]."""
    shared = {key: getattr(service, key) for key in type(service).model_fields if key not in _OF_A_SERVICE}
    start = Start.model_construct(time=start_s, speed_kmh=service.start_speed_kmh)
    calls = tuple(_moved(call, start_s) for call in service.calls)
    return TrainRun.model_construct(**shared | {"id": name, "start": start, "calls": calls})


def last_time(run: TrainRun) -> float:
    """Return the last planned time of a run [s after midnight]."""
    times = [time for call in run.calls for time in (call.arrival, call.departure) if time is not None]
    return max([run.start.time, *times] if run.start is not None else times)


def _of_day(timetable: Timetable, day: Day | None) -> Iterator[TrainRun]:
    yield from (run for run in timetable.trains if run.days is None or day in run.days)
    for service in timetable.services:
        if service.days is None or day in service.days:
            yield from (service_run(service, time, run_name(service, time)) for time in start_times(service))


def _before(day: Day | None) -> Day | None:
    days: tuple[Day, ...] = get_args(Day)
    return None if day is None else days[days.index(day) - 1]


def _carried(run: TrainRun) -> TrainRun:
    """Return a run of the day before in the times of this day; those before midnight are negative."""
    start = None if run.start is None else run.start.model_copy(update={"time": round(run.start.time - DAY_S, _DECIMALS)})
    calls = tuple(_moved(call, -DAY_S) for call in run.calls)
    return run.model_copy(update={"id": run.id + DAY_BEFORE, "start": start, "calls": calls})


def _moved(call: Call, by_s: float) -> Call:
    # Not validated again: of thousands of calls it would cost seconds, and times before midnight are none of a file.
    times = {name: getattr(call, name) for name in ("arrival", "departure")}
    moved = {name: round(time + by_s, _DECIMALS) for name, time in times.items() if time is not None}
    return call.model_copy(update=moved)
