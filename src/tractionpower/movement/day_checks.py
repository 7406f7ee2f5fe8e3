"""Checks of services and days of operation: what never runs, how many runs there are, whose names clash."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.alignment.checks import check_ids
from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.model.scenario import Scenario
from tractionpower.model.services import MOST_RUNS, count_runs, run_name, start_times
from tractionpower.model.timetable import Service, TrainRun
from tractionpower.movement.telling import doubt, item_paths, listed

_DAYS = "mon, tue, wed, thu, fri, sat, sun"


def check_days(scenario: Scenario) -> list[Problem]:
    """Return what is wrong with services and days of operation."""
    table = scenario.timetable
    paths = item_paths("timetable.services", [service.id for service in table.services])
    problems = check_ids("timetable.trains", [run.id for run in table.trains])
    problems += check_ids("timetable.services", [service.id for service in table.services])
    trains = {run.id for run in table.trains}
    for path, service in zip(paths, table.services, strict=True):
        problems += _check_service(path, service, trains)
    return [*problems, *_check_day(scenario)]


def _check_service(path: str, service: Service, trains: set[str]) -> Iterator[Problem]:
    number = count_runs(service)
    if number > MOST_RUNS:
        found = f"{service.headway_s:g} s from {format_time(service.first)} to {format_time(service.last)} make {number} runs"
        yield Problem(
            "too_many_runs", f"{path}.headway_s", found, f"up to {MOST_RUNS} runs", "make it longer, or split the service"
        )
    clashing = [name for time in start_times(service) if (name := run_name(service, time)) in trains]
    if clashing:
        found = f"its run{'s' * (len(clashing) > 1)} {listed(clashing)} would be called as a train of timetable.trains"
        yield Problem("duplicate_id", f"{path}.id", found, "a name of its own for each run", "rename one of them")
    offsets = [time for call in service.calls for time in (call.arrival, call.departure) if time is not None]
    if offsets and service.first > 0.0 and min(offsets) >= service.first:
        found = f"the first call is {format_time(min(offsets))} after the start of each run, which looks like a time of day"
        remedy = f"count from the start: the first run starts at {format_time(service.first)}"
        yield doubt("times_of_day", f"{path}.calls[0]", found, "times from 00:00 on, counted from the start", remedy)


def _check_day(scenario: Scenario) -> Iterator[Problem]:
    table = scenario.timetable
    items: list[TrainRun | Service] = [*table.trains, *table.services]
    bound = [item.id for item in items if item.days is not None]
    if bound and scenario.day is None:
        found = f"the study names no day, but {listed(bound)} run{'s' * (len(bound) == 1)} on certain days only"
        yield Problem("no_day", "day", found, _DAYS, "write day: mon in study.yaml, or leave days out of the timetable")
    elif items and not scenario.runs:
        yield doubt("nothing_runs", "day", f"no train runs on {scenario.day}", remedy="correct day, or the days of the timetable")
