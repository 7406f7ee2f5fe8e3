"""Is a timetable faster than its trains? Planned times held against those flat out, alone, at nominal voltage."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.errors import Problem
from tractionpower.kernels.journey import ARRIVED, run_journey
from tractionpower.kernels.train_tables import POINT, TRAIN_ROW, new_train_state
from tractionpower.model.base import format_time
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import Call, Start, Timetable, TrainRun
from tractionpower.movement.compile import AT_START_M, compile_trains, start_time
from tractionpower.movement.declared import Declared
from tractionpower.movement.driving.driven import compile_driven
from tractionpower.movement.telling import doubt

LEAST_S = 0.5
"""Fewer missing seconds are never told, whatever the study tolerates: running times are of steps of 1 s [s]."""

STEP_S = 1.0
LONGEST_STEPS = 86_400

Passed = tuple[list[float], list[float]] | None
"""When a run comes to its calls [s], and where they are on its route [m]; None: it does not come to its end."""


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a run, from where it may not leave earlier to a call with a planned time.

    Attributes
    ----------
    since, call
        Numbers of the calls at its ends, -1 for the start of the run.
    key
        The planned time at its end, ``arrival`` or ``departure``.
    planned_s, shortest_s
        Planned and shortest time [s].
    """

    since: int
    call: int
    key: str
    planned_s: float
    shortest_s: float

    @property
    def missing_s(self) -> float:
        """Seconds by which the plan is too short."""
        return self.shortest_s - self.planned_s


def check_pace(scenario: Scenario, items: Sequence[Declared]) -> list[Problem]:
    """Return a warning for each section on which trains or services are planned faster than they can run.

    It names all of them with the seconds that each lacks, the worst first. `items` have no errors.
    """
    timed = [item for item in items if len(list(_planned(item.run))) > 1]
    if not timed:
        return []
    alike: dict[Any, list[Declared]] = {}
    for item in timed:
        alike.setdefault(what_counts(item.run), []).append(item)
    times = shortest_times(scenario, [members[0].run for members in alike.values()])
    tolerance = max(scenario.feasibility.tolerance_s, LEAST_S)
    found: dict[tuple[str, str], list[tuple[Declared, Section]]] = {}
    for members, passed in zip(alike.values(), times, strict=True):
        for item in members:
            for part in () if passed is None else _short(sections(item.run, *passed), tolerance):
                found.setdefault(ends_of(item, part), []).append((item, part))
    number = {item.path: k for k, item in enumerate(timed)}
    first = {ends: min((number[item.path], part.call) for item, part in rows) for ends, rows in found.items()}
    return [_tell(found[ends]) for ends in sorted(found, key=lambda ends: first[ends])]


def _planned(run: TrainRun) -> Iterator[float]:
    """Yield when a run starts, and the planned times of its calls but the first."""
    yield start_time(run)
    yield from (time for call in run.calls[1:] for time in (call.arrival, call.departure) if time is not None)


def what_counts(run: TrainRun) -> Any:
    """Return all that the shortest running times of a run depend on."""
    calls = tuple((call.station, call.stops) for call in run.calls)
    speed = run.start.speed_kmh if run.start is not None else 0.0
    own = (run.train, run.vehicles, run.category, run.end, run.max_current_a, run.max_power_kw)
    return run.route, calls, speed, *own


def shortest_times(scenario: Scenario, runs: Sequence[TrainRun], *, by_plan: bool = False) -> list[Passed]:
    """Return for each run when it comes to its calls from 0 s on without any dwell [s], and where they are [m].

    Parameters
    ----------
    scenario, runs
        Line and trains, and the runs.
    by_plan
        Whether they are driven by their own plans; otherwise flat out.

    Returns
    -------
    Nothing for one that does not come to its end.
    """
    width = len(str(len(runs)))
    bare = tuple(_without_times(run, f"{k:0{width}d}", by_plan) for k, run in enumerate(runs))
    alone = scenario.model_copy(update={"timetable": Timetable.model_construct(trains=bare), "day": None})
    movement = compile_driven(alone) if by_plan else compile_trains(alone)
    state, tables = new_train_state(movement.tables), movement.tables
    voltage, rows = np.array([(0.0, movement.voltages.u_n)], POINT), np.zeros(LONGEST_STEPS, TRAIN_ROW)
    found: list[Passed] = []
    for k, planned in enumerate(movement.runs):
        _, end, _ = run_journey(tables, state, k, (0.0, STEP_S), voltage, rows)
        first = int(tables.trains[k]["first_stop"])
        arrived = state.arrived_s[first : first + len(planned.calls)].tolist()
        found.append((arrived, [call.at_m for call in planned.calls]) if end == ARRIVED else None)
    return found


def _without_times(run: TrainRun, name: str, by_plan: bool) -> TrainRun:
    speed = run.start.speed_kmh if run.start is not None else 0.0
    calls = tuple(Call(station=call.station, stops=call.stops) for call in run.calls)
    start = Start(time=0.0, speed_kmh=speed)
    driving = run.driving if by_plan else None
    return run.model_copy(update={"id": name, "start": start, "calls": calls, "driving": driving, "days": None})


def sections(run: TrainRun, arrived_s: Sequence[float], at_m: Sequence[float]) -> Iterator[Section]:
    """Yield the sections of a run between planned times.

    Parameters
    ----------
    run
        The run.
    arrived_s, at_m
        When it comes to its calls if it runs from 0 s on and nowhere waits [s], and where they are on the route [m].
    """
    since, left_s, passed_s, dwells_s = -1, start_time(run), 0.0, 0.0
    for k, (call, arrived, at) in enumerate(zip(run.calls, arrived_s, at_m, strict=True)):
        dwell = call.min_dwell_s if call.stops and at > AT_START_M else 0.0
        key = "arrival" if call.arrival is not None else "departure"
        due = call.arrival if call.arrival is not None or call.departure is None else call.departure - dwell
        if due is not None and at > AT_START_M:
            yield Section(since, k, key, due - left_s, arrived - passed_s + dwells_s)
        leaves = call.departure if call.departure is not None else None if due is None else due + dwell
        if leaves is None or not call.stops:  # it may pass earlier than planned
            dwells_s += dwell
        else:
            since, left_s, passed_s, dwells_s = k, leaves, arrived, 0.0


def _short(parts: Iterable[Section], tolerance_s: float) -> list[Section]:
    """Return the sections that lack more than is tolerated; of those that begin at the same call the one that lacks most."""
    short: dict[int, Section] = {}
    for part in parts:
        if part.missing_s > max(tolerance_s, short[part.since].missing_s if part.since in short else 0.0):
            short[part.since] = part
    return list(short.values())


def _tell(lacking: Sequence[tuple[Declared, Section]]) -> Problem:
    """Return the warning of a section for those that lack time on it: the worst in full, then all with their seconds."""
    ranked = sorted(lacking, key=lambda row: (-round(row[1].missing_s, 1), row[0].path))
    worst, part = ranked[0]
    found = (
        f"faster than {named(worst)} can: from {' to '.join(ends_of(worst, part))} it takes"
        f" {format_time(round(part.shortest_s, 1))} flat out at nominal voltage, planned are"
        f" {format_time(max(part.planned_s, 0.0))}: {part.missing_s:.1f} s are missing"
    )
    if len(ranked) > 1:
        others = ", ".join(f"{named(item)} ({other.missing_s:.1f} s)" for item, other in ranked[1:])
        found += f"; likewise {others}"
    remedy = "give it more time, a stronger train or fewer stops; it will be late"
    return doubt("faster_than_train", f"{worst.path}.calls[{part.call}].{part.key}", found, remedy=remedy)


def named(item: Declared) -> str:
    """Return the kind and the name of what a timetable declares."""
    return f"{'service' if item.is_service else 'train'} {item.run.id}"


def ends_of(item: Declared, part: Section) -> tuple[str, str]:
    """Return between which stations a section lies."""
    calls = item.run.calls
    return "the start" if part.since < 0 else calls[part.since].station, calls[part.call].station
