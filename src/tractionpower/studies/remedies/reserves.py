"""Plans with more reserve: the late trains are planned later, where they lose their time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from tractionpower.model.base import format_time
from tractionpower.model.timetable import Call
from tractionpower.movement.telling import listed
from tractionpower.studies.remedies.candidate import Candidate, steps_within
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import Declared

SHOWN = 12
"""Names of trains that a proposal shows."""


def reserves(case: Case) -> Iterator[Candidate]:
    """Yield later planned times of all late trains together.

    The size is the greatest time by which a call is planned later; others move in proportion to their delay, so that each
    section gets what its train loses there.
    """
    items = dict.fromkeys(case.known[run] for run in sorted(case.late) if run in case.known)
    profiles = {item: delays_at_calls(case, item) for item in items}
    profiles = {item: delays for item, delays in profiles.items() if max(map(max, delays), default=0.0) > case.tolerance_s}
    most = steps_within(case.bounds.greatest_reserve_s, case.bounds.reserve_step_s)
    if not profiles or most == 0:
        return
    greatest = max(delay for delays in profiles.values() for pair in delays for delay in pair)
    cost = case.bounds.costs.reserve
    shares = [max(max(pair) for pair in delays) / greatest * max(len(item.runs), 1) for item, delays in profiles.items()]

    def change(size: float) -> tuple[str, ...]:
        factor = size / greatest
        return tuple(text for item, delays in profiles.items() for text in later_calls(item, delays, factor))

    def tell(size: float) -> str:
        names = listed((item.name for item in profiles), SHOWN)
        return f"{names} {'is' if len(profiles) == 1 else 'are'} planned up to {size:g} s later, where the time is lost."

    subject = next(iter(profiles)).name if len(profiles) == 1 else "late trains"
    yield Candidate(
        "reserve", subject, "s", case.bounds.reserve_step_s, most, change, tell, lambda size: cost * size * sum(shares)
    )  # fmt: skip


def delays_at_calls(case: Case, item: Declared) -> list[tuple[float, float]]:
    """Return the delay at arrival and departure of each call, the greatest of all runs of a service [s]."""
    counts: dict[tuple[str, str], int] = {}
    found = []
    for call in item.trip.calls:
        pair = []
        for kind, planned in (("arrival", call.arrival), ("departure", call.departure)):
            if planned is None:
                pair.append(0.0)
                continue
            name = (call.station, kind if call.stops else "pass")
            turn = counts.get(name, 0)
            if call.stops or kind == "departure" or call.departure is None:  # a passing has one delay, whatever is planned of it
                counts[name] = turn + 1
            pair.append(max((_delay(case, run.id, *name, turn) for run in item.runs), default=0.0))
        found.append((pair[0], pair[1]))
    return found


def _delay(case: Case, run: str, station: str, kind: str, turn: int) -> float:
    delays = case.delays.get((run, station, kind), ())
    delay = delays[turn] if turn < len(delays) else 0.0
    return max(0.0, delay) if math.isfinite(delay) else 0.0


def later_calls(item: Declared, delays: Sequence[tuple[float, float]], factor: float) -> Iterator[str]:
    """Yield the changes by path that plan each call later, by its delay times `factor`, to whole seconds.

    Planned times stay in order, and no planned dwell becomes shorter than the shortest dwell unless it was.
    """
    last = -math.inf
    for index, (call, (at_arrival, at_departure)) in enumerate(zip(item.trip.calls, delays, strict=True)):
        arrival, departure = call.arrival, call.departure
        if arrival is not None:
            arrival = last = max(arrival + math.ceil(at_arrival * factor - 1e-6), last)
        if departure is not None:
            least = last if arrival is None else arrival + _least_dwell(call)
            departure = last = max(departure + math.ceil(at_departure * factor - 1e-6), least)
        for name, old, new in (("arrival", call.arrival, arrival), ("departure", call.departure, departure)):
            if old is not None and new is not None and new != old:
                yield f"{item.path}.calls[{index}].{name}={format_time(new)}"


def _least_dwell(call: Call) -> float:
    return min(call.min_dwell_s, (call.departure or 0.0) - (call.arrival or 0.0))
