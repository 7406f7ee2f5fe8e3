"""Which running times a plan has to meet: the groups of legs of a run, and the time of each of their parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tractionpower.model.driving import Eco, Reserve
from tractionpower.movement.compile import AT_START_M, PlannedCall, PlannedRun


@dataclass(frozen=True)
class Group:
    """Legs that share their time.

    Attributes
    ----------
    places_m
        Where the legs begin and end [m]: one more than legs.
    parts
        Ends of the parts [m], each with the running time since the end of the one before, without dwells [s]; NaN: none is
        given.
    spare_s
        Time in hand at the stop where it ends [s]: what the planned dwell is longer than the shortest.
    waits
        Whether a train that comes to its end early waits there; else it has to be slow enough.
    """

    places_m: tuple[float, ...]
    parts: tuple[tuple[float, float], ...]
    spare_s: float = 0.0
    waits: bool = True


def corrected(groups: Sequence[Group], late_s: Sequence[float]) -> list[Group]:
    """Return groups whose parts are to take less time: `late_s` says how much, in the order of all parts [s]."""
    found, at = [], 0
    for group in groups:
        less = late_s[at : at + len(group.parts)]
        parts = tuple((end, round(seconds - late, 3)) for (end, seconds), late in zip(group.parts, less, strict=True))
        found.append(replace(group, parts=parts))
        at += len(group.parts)
    return found


def leg_places(item: PlannedRun) -> tuple[float, ...]:
    """Return where the legs of a run begin and end [m]: its start, its stops, its end."""
    stops = [planned.at_m for planned in item.calls if planned.call.stops and planned.at_m > AT_START_M]
    places = [0.0]
    for place in [*stops, item.route_m]:
        if place > places[-1] + AT_START_M and place <= item.route_m + AT_START_M:
            places.append(min(place, item.route_m))
    return tuple(places)


def timed_groups(item: PlannedRun) -> list[Group]:
    """Return the groups between timed calls of a run; what lies behind the last of them has no time to meet.

    The time of a part is that between two planned times, less the dwells at stops without times between them. A train is due
    at a stop as planned, and no later than its shortest dwell before the planned departure: timetables in whole minutes have
    dwells of 0 s.
    """
    groups: list[Group] = []
    places, parts, dwells = [0.0], [], 0.0
    since = item.start_s
    for planned in item.calls:
        call, at = planned.call, min(planned.at_m, item.route_m)
        if at <= AT_START_M:
            since = max(since, call.departure) if call.stops and call.departure is not None else since
            continue
        if at > item.route_m - AT_START_M and not call.stops:
            at = item.route_m
        due = _due(planned)
        if call.stops and at > places[-1] + AT_START_M:
            places.append(at)
        if due is not None:
            parts.append((at, due - since - dwells))
            since, dwells = due, 0.0
        if not call.stops:
            continue
        if due is None:
            dwells += call.min_dwell_s
            continue
        leave = due + call.min_dwell_s
        since = max(leave, call.departure) if call.departure is not None else leave
        groups.append(Group(tuple(places), tuple(parts), since - leave))
        places, parts = [at], []
    if parts:  # the last timed call is passed: the rest of its leg has no time to meet
        end = next((place for place in leg_places(item) if place >= parts[-1][0] - AT_START_M), item.route_m)
        places = [place for place in places if place < end] + [end]  # not the stops behind that
        is_rest = end > parts[-1][0] + AT_START_M
        if is_rest:
            parts.append((end, float("nan")))
        groups.append(Group(tuple(places), tuple(parts), waits=is_rest))
    return [group for group in groups if len(group.places_m) > 1]


def _due(planned: PlannedCall) -> float | None:
    """Return when a train is due at a call [s], None without a time."""
    call = planned.call
    if call.departure is None:
        return call.arrival
    latest = call.departure - (call.min_dwell_s if call.stops else 0.0)
    return latest if call.arrival is None else min(call.arrival, latest)


def spread_groups(item: PlannedRun, saving: Reserve | Eco, shortest_s: Sequence[float]) -> list[Group]:
    """Return the groups of a reserve, one for each leg, or of a time for the whole run.

    Parameters
    ----------
    shortest_s
        Shortest running time of each leg [s].
    """
    places = leg_places(item)
    if isinstance(saving, Eco):
        return [Group(places, ((places[-1], float(saving.running_time)),))]
    if saving.percent is not None:
        factor = 1.0 + saving.percent / 100.0
    else:
        assert saving.seconds is not None  # a rule of the declaration
        factor = 1.0 + saving.seconds / sum(shortest_s)
    legs = zip(places[:-1], places[1:], shortest_s, strict=True)
    return [Group((low, high), ((high, shortest * factor),)) for low, high, shortest in legs]
