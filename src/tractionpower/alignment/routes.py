"""Routes of trains: checks of their legs, where a train stops on them, and where they lack a speed limit."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise

import numpy as np

from tractionpower.alignment.checks import Axes, check_place, check_tracks
from tractionpower.alignment.intervals import TOLERANCE_M, Interval, cut, merge, name_km
from tractionpower.alignment.path import RoutePath
from tractionpower.errors import Problem
from tractionpower.model.line import Connection, Line, Station, TrackPoint
from tractionpower.model.timetable import Leg

SAME_PLACE_M = 1.0
"""Ends of legs and of connections this close [m] are one place."""

_SHOWN = 4


def check_route(path: str, route: Sequence[Leg], line: Line, axes: Axes) -> list[Problem]:
    """Return what is wrong with the legs of a route, which stands at `path` of the model."""
    problems: list[Problem] = []
    faulty: set[int] = set()
    for index, leg in enumerate(route):
        found = _check_leg(f"{path}[{index}]", leg, axes)
        problems += found
        if found:
            faulty.add(index)
    for index, (leg, after) in enumerate(pairwise(route), start=1):
        if faulty.isdisjoint({index - 1, index}):
            problems += _check_joint(f"{path}[{index}]", leg, after, line, axes)
    return problems


def stop_distance(
    path: RoutePath, station: Station, *, from_m: float = 0.0, tracks: Collection[str] | None = None
) -> float | None:
    """Return where the front of a train stops at a station [m], or None if the route does not come there.

    It is the first place of the route on one of the tracks of the station: the kilometre that its `stop_km` gives for
    track and direction, else for the track, else that of the station. `from_m` leaves out what lies before it, `tracks`
    what lies on other tracks.
    """
    stops = station.stop_km or {}
    for leg in path.legs:
        track = leg.axis.track
        if tracks is not None and track not in tracks:
            continue
        km = stops.get(f"{track} {leg.direction}", stops.get(track, station.km))
        if (station.tracks is None or track in station.tracks) and leg.axis.contains(km):
            found = leg.distance(leg.axis.metre(km))
            if found is not None and found >= from_m:
                return found
    return None


def speed_limit_gaps(path: RoutePath) -> list[Interval]:
    """Return the stretches of a route without a speed limit, as distances (from, to) [m]."""
    ends = np.append(path.limit_from_m[1:], path.length_m)
    open_ = np.isnan(path.limit_mps)
    return list(zip(path.limit_from_m[open_].tolist(), ends[open_].tolist(), strict=True))


def check_speed_limits(where: str, path: RoutePath) -> list[Problem]:
    """Return a problem, at the place `where` of the model, if a route lacks a speed limit for its train."""
    gaps = name_stretches(path, speed_limit_gaps(path))
    if not gaps:
        return []
    more = f"; ... ({len(gaps)} in all)" if len(gaps) > _SHOWN else ""
    found = f"the train finds no speed limit on {'; '.join(gaps[:_SHOWN])}{more}"
    remedy = "add a row to line.speed_limits for this direction, of the train's category or of none"
    return [Problem("no_speed_limit", where, found, remedy=remedy)]


def name_stretches(path: RoutePath, stretches: Sequence[Interval]) -> list[str]:
    """Return stretches of a route [m] as texts with track and kilometres in the direction of travel, one for each leg."""
    texts = []
    for start, end in cut(merge(stretches), [leg.start_m for leg in path.legs]):
        leg = path.legs[int(path.places(np.array([0.5 * (start + end)]))[0][0])]
        from_km, to_km = leg.axis.km(leg.track_m(np.array([start, end])))
        texts.append(f"track {leg.axis.track} from km {name_km(from_km)} to km {name_km(to_km)}")
    return texts


def _check_leg(path: str, leg: Leg, axes: Axes) -> list[Problem]:
    problems = check_tracks(f"{path}.track", (leg.track,), axes)
    problems += check_place(f"{path}.from_km", leg.from_km, (leg.track,), axes)
    problems += check_place(f"{path}.to_km", leg.to_km, (leg.track,), axes)
    if problems:
        return problems
    axis = axes[leg.track]
    if abs(axis.metre(leg.to_km) - axis.metre(leg.from_km)) > TOLERANCE_M:
        return []
    found = f"km {name_km(leg.from_km)} and km {name_km(leg.to_km)} are one place of track {leg.track}"
    return [Problem("empty_leg", path, found, remedy="give the leg a length, or leave it out")]


def _check_joint(path: str, leg: Leg, after: Leg, line: Line, axes: Axes) -> list[Problem]:
    """Return a problem if a leg does not begin where the one before ends, or turns round there."""
    end, start = TrackPoint(track=leg.track, km=leg.to_km), TrackPoint(track=after.track, km=after.from_km)
    if any(_joins(connection, end, start, axes) for connection in line.connections):
        return []
    if not _same_place(end, start, axes):
        found = (
            f"the leg begins on track {start.track} at km {name_km(start.km)},"
            f" the one before ends on track {end.track} at km {name_km(end.km)}, and no connection joins these places"
        )
        remedy = "let it begin where the one before ends, or add a row to line.connections"
        return [Problem("legs_apart", path, found, remedy=remedy)]
    if (leg.to_km > leg.from_km) != (after.to_km > after.from_km):
        found = f"the route turns round on track {leg.track} at km {name_km(end.km)}"
        remedy = "the front would become the rear: make it two runs"
        return [Problem("turns_round", path, found, remedy=remedy, severity="warning")]
    return []


def _joins(connection: Connection, end: TrackPoint, start: TrackPoint, axes: Axes) -> bool:
    ways = ((connection.from_, connection.to), (connection.to, connection.from_))
    return any(_same_place(end, one, axes) and _same_place(start, other, axes) for one, other in ways)


def _same_place(first: TrackPoint, second: TrackPoint, axes: Axes) -> bool:
    axis = axes.get(first.track)
    if axis is None or first.track != second.track or not (axis.contains(first.km) and axis.contains(second.km)):
        return False
    return abs(axis.metre(first.km) - axis.metre(second.km)) <= SAME_PLACE_M + TOLERANCE_M
