"""The part of the clock around the late trains, for a search that need not run the whole study each time."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tractionpower.model.scenario import Clock, Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.studies.remedies.candidate import Candidate
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import linked, planned_times, start_of

BEFORE_S = 1800.0
"""The window begins this long before the first late train starts [s]."""

AFTER_S = 600.0
"""It ends this long after the last planned time of a late train, and after what the bounds may add to it [s]."""

NEAR_S = 1800.0
"""A train acts on another one if no more than this lies between their runs [s]."""

WORTHWHILE = 0.8
"""A window that takes more than this share of the clock is not used."""


def window(scenario: Scenario, late: Mapping[str, float]) -> Scenario:
    """Return the study with its clock narrowed to the late trains, or as it is where that would not help.

    Trains that start before the clock have run at nominal voltage until then, and switch events before it are past: so a
    study with switch events keeps its start, and what is found in a window is verified by a run of the whole study.
    """
    clock, bounds = scenario.clock, scenario.remedies
    runs = [run for run in scenario.runs if run.id in late]
    if not runs:
        return scenario
    start = clock.start
    if not scenario.supply.switch_events:
        wished = min(start_of(run) for run in runs) - BEFORE_S - bounds.greatest_shift_s
        start += clock.step_s * max(0, math.floor((wished - clock.start) / clock.step_s))
    more = max(bounds.greatest_shift_s, bounds.greatest_reserve_s, *(late[run.id] for run in runs), 0.0)
    last = max(time for run in runs for time in [start_of(run), *planned_times(run.calls)])
    end = min(clock.end, last + AFTER_S + more)
    if end <= start or end - start > WORTHWHILE * (clock.end - clock.start):
        return scenario
    narrow = Clock.model_validate({"start": round(start, 6), "end": round(end, 6), "step_s": clock.step_s})
    return scenario.model_copy(update={"clock": narrow})


def reaches_all(case: Case, candidate: Candidate) -> bool:
    """Tell whether for each late train something that a candidate changes runs, or is taken over by what runs, near its time."""
    changes = candidate.change(candidate.size(1))
    changed = {item for item in case.known.values() if any(text.startswith(f"{item.path}.") for text in changes)}
    runs = {run.id: run for run in case.scenario.runs}
    names = {run.id for item in changed for run in item.runs}
    names |= {name for own in names for name in linked(case.scenario.timetable, own, onwards=True) if name in runs}
    times = [_span(runs[name]) for name in names]
    return all(
        any(begin <= until + NEAR_S and end >= since - NEAR_S for begin, end in times)
        for since, until in (_span(runs[name]) for name in case.late)
    )


def _span(run: TrainRun) -> tuple[float, float]:
    """Return from when to when a run is planned [s]; one without planned times may last for long."""
    times = [start_of(run), *planned_times(run.calls)]
    return min(times), max(times) if len(times) > 1 else math.inf
