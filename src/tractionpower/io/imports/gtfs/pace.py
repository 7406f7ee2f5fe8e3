"""Are the times of a feed ones that the assumed train, dwell and speed limit allow? By the closed form of a run on the level."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tractionpower.io.imports.gtfs.network import Network
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.trips import Trip
from tractionpower.io.wording import printable

USUAL_MPS2 = 0.5
"""Mean of starting and braking, over all speeds, that older electric multiple units reach [m/s²]: assumed."""


def shortest_s(way_m: float, top_mps: float, mps2: float = USUAL_MPS2) -> float:
    """Return the shortest time from rest to rest [s], accelerating and braking alike.

    Over the whole way that is t = 2 sqrt(d/a), up to sqrt(d a); with a top speed v below that t = d/v + v/a.

    >>> shortest_s(800.0, 30.0), shortest_s(800.0, 10.0)
    (80.0, 100.0)
    """
    if math.sqrt(way_m * mps2) <= top_mps:
        return 2.0 * math.sqrt(way_m / mps2)
    return way_m / top_mps + top_mps / mps2


def told_pace(
    trips: Sequence[Trip], station: Mapping[str, str], network: Network, options: GtfsOptions, rounded_s: float
) -> str | None:
    """Return in words that the assumptions may be too slow for the timetable, or None if they need not be.

    Parameters
    ----------
    trips
        The trips.
    station, network
        Stations of stops, and where they lie.
    options
        What is assumed of train, dwell and speed limit.
    rounded_s
        Delays up to here are those of rounded times [s].
    """
    ways: dict[tuple[str, str], float] = {}
    late: list[tuple[float, str]] = []
    fastest: tuple[float, str, str] = 0.0, "", ""
    for trip in trips:
        names = [station[stop.stop] for stop in trip.stops]
        for pair in pairwise(names):
            if pair not in ways:
                ways[pair] = 1000.0 * sum(abs(leg.to_km - leg.from_km) for leg in network.way(pair))
        worst = _most_late_s(trip, [ways[pair] for pair in pairwise(names)], options)
        if worst <= rounded_s:
            continue
        late.append((worst, trip.id))
        for (before, after), (a, b) in zip(pairwise(trip.stops), pairwise(names), strict=True):
            if before.departure is not None and after.arrival is not None and after.arrival > before.departure:
                fastest = max(fastest, (3.6 * ways[a, b] / (after.arrival - before.departure), a, b))
    if not late:
        return None
    most_s, name = max(late)
    return (
        f"{len(late)} of {len(trips)} trips may be faster than the train {options.train}, a dwell of {options.min_dwell_s:g} s"
        f" and {options.speed_kmh:g} km/h allow: with {USUAL_MPS2:g} m/s² of accelerating and braking {printable(name)} would be"
        f" {most_s:.0f} s late; the fastest section is {printable(fastest[1])} to {printable(fastest[2])},"
        f" {fastest[0]:.0f} km/h on average. `check` says what the train can do; --train, --dwell and --speed change it"
    )


def _most_late_s(trip: Trip, ways_m: Sequence[float], options: GtfsOptions) -> float:
    """Return the greatest delay of a train that leaves on time, never too early, and runs as fast as `shortest_s` [s]."""
    top_mps = options.speed_kmh / 3.6
    now = trip.stops[0].departure or 0.0
    most_s = way_m = 0.0
    last = len(trip.stops) - 1
    for k, (stop, step_m) in enumerate(zip(trip.stops[1:], ways_m, strict=True), start=1):
        way_m += step_m
        if stop.passes:
            continue
        now += shortest_s(way_m, top_mps)
        way_m = 0.0
        is_planned = stop.arrival is not None and (k == last or stop.arrival != stop.departure)
        most_s = max(most_s, now - stop.arrival) if is_planned and stop.arrival is not None else most_s
        if k < last:
            now += options.min_dwell_s
            most_s = max(most_s, now - stop.departure) if stop.departure is not None else most_s
            now = max(now, stop.departure or 0.0)
    return most_s
