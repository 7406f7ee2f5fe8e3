"""Checks of driving plans: whether their marks lie on the route, and whether the train and its timetable can follow them."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.errors import Problem
from tractionpower.model.drive import InverterDrive
from tractionpower.model.driving import Driving, Rules, ToTime
from tractionpower.movement.compile import PlannedRun
from tractionpower.movement.driving.dues import planned_arrival
from tractionpower.movement.driving.rules import mark_places, stops_of
from tractionpower.movement.formation import KMH
from tractionpower.movement.telling import doubt


def check_driving(path: str, planned: PlannedRun, common: Driving | None) -> Iterator[Problem]:
    """Yield what is wrong or doubtful with how a run is driven; `common` is how all trains are driven that do not say it."""
    run = planned.run
    yield from _check_power_cap(f"{path}.max_power_kw", planned)
    own = run.driving
    if isinstance(own, Rules):
        yield from _check_marks(f"{path}.driving", planned, own)
        if own.coast_before_stops_km is not None and not stops_of(planned):
            found = "the train never stops behind its start: it does not coast"
            yield doubt(
                "no_stop_to_coast_to", f"{path}.driving.coast_before_stops_km", found, remedy="leave it out, or name marks"
            )
    how = own if own is not None else common
    if isinstance(how, ToTime) and not _has_timed_section(planned):
        where = f"{path}.driving" if own is not None else path
        found = "no section of the run has a planned time at both ends: it is driven flat out"
        yield doubt("nothing_to_drive_to", where, found, remedy="plan arrivals, or drive by `reserve` or `rules`")


def _check_power_cap(path: str, planned: PlannedRun) -> Iterator[Problem]:
    driver = planned.formation.driver
    if planned.run.max_power_kw is None or driver is None or isinstance(driver.drive, InverterDrive):
        return
    found = f"the power of {driver.id} cannot be capped: its drive is not an inverter drive"
    yield Problem("power_cap", path, found, remedy="cap the current by max_current_a")


def _check_marks(path: str, planned: PlannedRun, rules: Rules) -> Iterator[Problem]:
    for k, mark in enumerate(rules.coast_from):
        start, end = mark_places(planned, mark)
        where = f"km {mark.km:g}" + (f" of track {mark.track}" if mark.track is not None else "")
        if start is None:
            remedy = "correct the mark, or its track"
            yield Problem("off_route", f"{path}.coast_from[{k}].km", f"the route does not come to {where}", remedy=remedy)
        elif mark.to_km is not None and end is None:
            found = f"the route does not come to km {mark.to_km:g} behind {where}"
            yield Problem("off_route", f"{path}.coast_from[{k}].to_km", found, remedy="correct it, or leave it out")
    floor = rules.coast_down_to_kmh / KMH
    if floor > 0.0 and floor >= planned.formation.max_mps:
        found = f"{rules.coast_down_to_kmh:g} km/h, and the train runs at {planned.formation.max_mps * KMH:g} km/h at most"
        yield doubt("never_coasts", f"{path}.coast_down_to_kmh", found, remedy="lower it")


def _has_timed_section(planned: PlannedRun) -> bool:
    """Tell whether an arrival or a passing behind the start has a planned time; the start has one always."""
    return any(planned_arrival(call) is not None and call.at_m > 0.0 for call in planned.calls)
