"""Driving plans with reserve for the trains that draw the most and are on time: they take less power."""

from __future__ import annotations

import json
from collections.abc import Iterator

from tractionpower.studies.remedies.candidate import Candidate, steps_within
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import Declared


def drivings(case: Case) -> Iterator[Candidate]:
    """Yield driving plans with a reserve, of trains that are flat out now and not late."""
    most = steps_within(case.bounds.greatest_driving_percent, case.bounds.driving_step_percent)
    if most == 0:
        return
    for item in case.foremost:
        driving = item.trip.driving or case.scenario.timetable.driving
        if (driving is None or driving.kind == "flat_out") and not any(run.id in case.late for run in item.runs):
            yield _candidate(case, item, most)


def _candidate(case: Case, item: Declared, most: int) -> Candidate:
    cost, runs = case.bounds.costs.driving, len(item.runs)

    def change(size: float) -> tuple[str, ...]:
        return (f"{item.path}.driving={json.dumps({'kind': 'reserve', 'percent': size})}",)

    def tell(size: float) -> str:
        return f"{item.words[0].upper() + item.words[1:]} is driven with {size:g} % of reserve."

    return Candidate(
        "driving", item.name, "%", case.bounds.driving_step_percent, most, change, tell, lambda size: cost * size * runs
    )  # fmt: skip
