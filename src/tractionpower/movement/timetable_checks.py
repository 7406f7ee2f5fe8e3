"""Checks of the times of a run: what goes backwards, what is too short, what never begins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tractionpower.errors import Problem
from tractionpower.model.base import DAY_S, format_time
from tractionpower.model.scenario import Clock
from tractionpower.model.timetable import Call, TrainRun
from tractionpower.movement.compile import start_time
from tractionpower.movement.declared import Declared
from tractionpower.movement.telling import doubt, listed


def check_times(path: str, run: TrainRun) -> Iterator[Problem]:
    """Yield times of a run that go backwards, and departures before the shortest dwell is over."""
    last, where = (run.start.time, "the start") if run.start is not None else (None, "")
    for k, call in enumerate(run.calls):
        for name in ("arrival", "departure"):
            time = getattr(call, name)
            if time is None:
                continue
            if last is not None and time < last:
                yield _backwards(f"{path}.calls[{k}].{name}", time, last, where)
            else:  # later times are held against the last one that is in order, so that one slip is told once
                last, where = time, f"the {name if call.stops else 'passing'} at {call.station}"
        yield from _check_dwell(f"{path}.calls[{k}]", call)


def _backwards(path: str, time: float, last: float, where: str) -> Problem:
    remedy = "correct one of them"
    if last - time > 0.5 * DAY_S:
        remedy = f"times of the next day go on beyond 24:00:00: write {format_time(time + DAY_S)}"
    found = f"{format_time(time)}, before {where}, {format_time(last)}"
    return Problem("times_backwards", path, found, f"from {format_time(last)} on", remedy)


def _check_dwell(path: str, call: Call) -> Iterator[Problem]:
    if not call.stops and call.min_dwell_s > 0.0:
        found = f"{call.min_dwell_s:g} s at a station that the train passes"
        yield Problem("dwell_of_passing", f"{path}.min_dwell_s", found, "0", "leave it out, or let the train stop there")
    elif call.arrival is not None and call.departure is not None and 0.0 <= call.departure - call.arrival < call.min_dwell_s:
        found = f"{call.departure - call.arrival:g} s planned, min_dwell_s is {call.min_dwell_s:g} s: the train leaves late"
        remedy = "let it depart later, or shorten min_dwell_s"
        yield doubt("short_dwell", f"{path}.departure", found, remedy=remedy)


def check_clock(items: Sequence[Declared], clock: Clock) -> list[Problem]:
    """Return one warning for all that begins when the simulated time is over, and one for all that ends before it.

    Of a service no run must be left. What the day before has left counts nowhere.
    """
    late = [(item, item.runs[0]) for item in items if item.runs and start_time(item.runs[0]) >= clock.end]
    early = [(item, item.runs[-1]) for item in items if item.runs and all(_is_early(run, clock) for run in item.runs)]
    problems = []
    if late:
        found = f"the clock ends at {format_time(clock.end)}: the co-simulation (`run`) leaves it out, `journey` runs it"
        problems.append(_never_begins("begins_after_end", late, found, "let the clock end later, or leave it out"))
    if early:
        next_day = start_time(early[0][1]) + DAY_S
        remedy = "let the clock start earlier, or leave it out"
        if clock.start <= next_day < clock.end:
            remedy = f"times of the next day go on beyond 24:00:00: write {format_time(next_day)}"
        found = f"the clock starts at {format_time(clock.start)}: the run should be over by then"
        problems.append(_never_begins("begins_before_clock", early, found, remedy))
    return problems


def _is_early(run: TrainRun, clock: Clock) -> bool:
    """Return whether a run begins more than half a day before the clock, or its last planned time lies before it.

    When a run ends that has no planned time behind its start is not known.
    """
    start = start_time(run)
    times = [time for call in run.calls for time in (call.arrival, call.departure) if time is not None and time > start]
    return start < clock.start - 0.5 * DAY_S or max(times, default=clock.start) < clock.start


def _never_begins(code: str, placed: Sequence[tuple[Declared, TrainRun]], why: str, remedy: str) -> Problem:
    item, first = placed[0]
    where = item.at("start.time" if item.run.start is not None else "calls[0].departure")
    found = f"begins at {format_time(start_time(first))}, {why}"
    if len(placed) > 1:
        found += f"; likewise {listed(sorted(each.run.id for each, _ in placed[1:]))}"
    return doubt(code, where, found, remedy=remedy)
