"""Larger headways of periodic services."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.model.timetable import Service
from tractionpower.studies.remedies.candidate import Candidate, steps_within
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import Declared, linked


def headways(case: Case) -> Iterator[Candidate]:
    """Yield headways of the services that draw the most; a service with runs in rotations is left out, for they would change."""
    bounds, timetable = case.bounds, case.scenario.timetable
    for item in case.foremost:
        service = item.trip
        if not isinstance(service, Service) or len(item.runs) < 2:
            continue
        if any(linked(timetable, run.id, onwards=onwards) for run in item.runs for onwards in (True, False)):
            continue
        most = steps_within((bounds.greatest_headway_factor - 1.0) * service.headway_s, bounds.headway_step_s)
        if most > 0:
            yield _candidate(case, item, service, most)


def _candidate(case: Case, item: Declared, service: Service, most: int) -> Candidate:
    runs, costs = len(item.runs), case.bounds.costs

    def left(size: float) -> int:
        return int((service.last - service.first) / (service.headway_s + size) + 1e-9) + 1

    def cost(size: float) -> float:
        return costs.headway * (size * left(size) + service.headway_s * max(0, runs - left(size)))

    def tell(size: float) -> str:
        return f"Service {item.name}: a run every {service.headway_s + size:g} s, {left(size)} in place of {runs}."

    def change(size: float) -> tuple[str, ...]:
        return (f"{item.path}.headway_s={service.headway_s + size:g}",)

    return Candidate("headway", item.name, "s", case.bounds.headway_step_s, most, change, tell, cost)
