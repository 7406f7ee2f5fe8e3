"""The times of trips: what is impossible or doubtful in them, and what can be mended when asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.trips import StopTime, Trip, listed
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted, printable
from tractionpower.model.base import DAY_S, format_time

MINUTE_S = 60.0

ROUNDED_S = 0.5 * MINUTE_S
"""By so much times of whole minutes may be off [s]."""

_LATEST_START_S = 36 * 3600.0
"""A trip that starts after noon of the day after its service day is doubted."""

_LONGEST_SECTION_S = 12 * 3600.0
"""Longer between two calls is taken as a slip."""


def mend_times(trips: list[Trip], options: GtfsOptions, notes: Notes) -> None:
    """Check the times of trips, and mend them in place where repair is asked for; problems and repairs are told by trip."""
    for trip in trips:
        _fill_single(trip)
        if options.repair:
            _repair(trip, notes)
        notes.problems += _check(trip)
    _tell_doubles(trips, options, notes)


def rounding_s(trips: Sequence[Trip]) -> float:
    """Return the step of the published times [s]: `MINUTE_S` for whole minutes, else 1."""
    times = [time for trip in trips for stop in trip.stops for time in (stop.arrival, stop.departure) if time is not None]
    return MINUTE_S if times and all(time % MINUTE_S == 0.0 for time in times) else 1.0


def without_times(trip: Trip) -> list[int]:
    """Return the calls of a trip that have no time."""
    return [k for k, stop in enumerate(trip.stops) if stop.arrival is None and stop.departure is None]


def _fill_single(trip: Trip) -> None:
    for stop in trip.stops:  # one time stands for both
        stop.departure = stop.departure if stop.departure is not None else stop.arrival
        stop.arrival = stop.arrival if stop.arrival is not None else stop.departure


def _times(trip: Trip) -> Iterator[tuple[int, str, float]]:
    # What is driven by: the arrival at the first stop and the departure from the last one are none of the run.
    for k, stop in enumerate(trip.stops):
        if stop.arrival is not None and k > 0:
            yield k, "arrival", stop.arrival
        if stop.departure is not None and k < len(trip.stops) - 1:
            yield k, "departure", stop.departure


def _shift(trip: Trip, first: int, by_s: float) -> None:
    for stop in trip.stops[first:]:
        stop.arrival = None if stop.arrival is None else stop.arrival + by_s
        stop.departure = None if stop.departure is None else stop.departure + by_s


def _repair(trip: Trip, notes: Notes) -> None:
    """Mend the times of a trip and tell it; what cannot be mended as a whole stays as it is in the feed."""
    given, mended = [replace(stop) for stop in trip.stops], Notes()
    _leave_out_late(trip, mended)
    _repair_days(trip, mended)
    _repair_order(trip, mended)
    if any(problem.severity == "error" for problem in _check(trip)):
        trip.stops[:] = given
    else:
        notes.repaired += mended.repaired


def _leave_out_late(trip: Trip, notes: Notes) -> None:
    """Leave out times that lie about a day after those on both sides and would, a day earlier, still be out of order."""
    last = trip.stops[0].departure
    for k, stop in enumerate(trip.stops[1:-1], start=1):
        late = [time for time in (stop.arrival, stop.departure) if time is not None]
        if last is None or not late:
            continue
        after = next((each.arrival for each in trip.stops[k + 1 :] if each.arrival is not None), None)
        if after is None or not last <= after < min(late) - 0.5 * DAY_S:
            last = stop.departure
        elif not last <= min(late) - DAY_S <= max(late) - DAY_S <= after:
            stop.arrival = stop.departure = None
            notes.repaired.append(
                f"trip {printable(trip.id)}, stop {printable(stop.stop)}: {format_time(late[0])} is neither between"
                f" {format_time(last)} and {format_time(after)} nor a day after that, and was left out"
            )


def _repair_days(trip: Trip, notes: Notes) -> None:
    """Put times onto the day on which the train runs: those that restart at midnight, and those a day too late."""
    start = trip.stops[0].departure
    if start is not None and start >= _LATEST_START_S:
        _shift(trip, 0, -DAY_S)
        notes.repaired.append(f"trip {printable(trip.id)} starts at {format_time(start)}: 24 h taken off")
    last = trip.stops[0].departure
    for k, stop in enumerate(trip.stops[1:], start=1):
        for name in ("arrival", "departure"):
            time = getattr(stop, name)
            if time is None or last is None:
                continue
            if time - last >= DAY_S - _LONGEST_SECTION_S and time - DAY_S >= last:
                setattr(stop, name, time - DAY_S)
                what = f"trip {printable(trip.id)}, stop {printable(stop.stop)}: {format_time(time)}"
                notes.repaired.append(f"{what} is a day late, 24 h taken off")
            elif last - time > 0.5 * DAY_S:
                setattr(stop, name, time + DAY_S)
                if name == "arrival" or stop.arrival is None:
                    notes.repaired.append(f"trip {printable(trip.id)} runs over midnight at stop {k + 1}: 24 h added")
            last = getattr(stop, name)


def _repair_order(trip: Trip, notes: Notes) -> None:
    """Leave out times that lie before the ones before them, and tell it; they are put between their neighbours later."""
    latest = trip.stops[0].departure
    for k, name, time in list(_times(trip)):
        if latest is not None and time < latest:
            ends = k in (0, len(trip.stops) - 1)
            if not ends:
                setattr(trip.stops[k], name, None)
                notes.repaired.append(
                    f"trip {printable(trip.id)}, stop {trip.stops[k].stop}: the {name} {format_time(time)} lies before"
                    f" {format_time(latest)} and was left out"
                )
        else:
            latest = time


def _check(trip: Trip) -> Iterator[Problem]:
    place = f"stop_times.txt:{trip.stops[0].line}"
    if trip.stops[0].departure is None or trip.stops[-1].arrival is None:
        end = "first" if trip.stops[0].departure is None else "last"
        found = f"trip {printable(trip.id)} has no time at its {end} stop"
        yield Problem("no_time", "", found, "a time at the first and the last stop", place=place)
    times = list(_times(trip))
    for (_, before, earlier), (k, name, time) in pairwise(times):
        stop = trip.stops[k]
        where = f"stop_times.txt:{stop.line}"
        if time < earlier:
            found = (
                f"trip {printable(trip.id)} runs backwards in time: {name} {format_time(time)} at {printable(stop.stop)},"
                f" after {before} {format_time(earlier)}"
            )
            remedy = "times after midnight go on beyond 24:00:00; with repair they do, or the time is left out"
            yield Problem("times_backwards", "", found, f"from {format_time(earlier)} on", remedy, place=where)
            return
        if time - earlier > _LONGEST_SECTION_S:
            what = f"the {name} {format_time(time)} at {printable(stop.stop)}"
            found = f"trip {printable(trip.id)} takes {(time - earlier) / 3600.0:.1f} h to {what}"
            remedy = "correct the hour; with repair a day is taken off where that fits"
            yield Problem("implausible_time", "", found, "at most 12 h between two times", remedy, place=where)
            return
    start = trip.stops[0].departure
    if start is not None and start >= _LATEST_START_S:
        found = f"trip {printable(trip.id)} starts at {format_time(start)}, which is {format_time(start % DAY_S)} a day later"
        remedy = "it is read as it stands; with repair 24 h are taken off"
        yield Problem("late_in_the_day", "", found, "", remedy, "warning", place=place)


def _tell_doubles(trips: list[Trip], options: GtfsOptions, notes: Notes) -> None:
    """Tell trips that have the same stops at the same times as another one; with repair one of each is kept."""
    seen: dict[tuple[object, ...], str] = {}
    doubles = []
    for trip in trips:
        calls = tuple((stop.stop, stop.arrival, stop.departure) for stop in trip.stops)
        runs = tuple((each.first, each.before, each.headway_s) for each in trip.frequencies)
        if (calls, runs) in seen:
            doubles.append((seen[calls, runs], trip.id))
        else:
            seen[calls, runs] = trip.id
    if not doubles:
        return
    pairs = listed(f"{second} as {first}" for first, second in doubles)
    if options.repair:
        gone = {second for _, second in doubles}
        trips[:] = [trip for trip in trips if trip.id not in gone]
        notes.repaired.append(f"{counted(len(doubles), 'trip')} with the stops and times of another one left out: {pairs}")
    else:
        found = f"{counted(len(doubles), 'trip')} with the stops and times of another one: {pairs}"
        remedy = "they are read as trains of their own; with repair they are left out"
        notes.problems.append(Problem("doubled_trip", "", found, "", remedy, "warning", place="trips.txt"))


def fill_times(trip: Trip, metres: Sequence[float]) -> list[str]:
    """Put times to calls that have none, in proportion to the distance, and return their stops.

    Parameters
    ----------
    trip
        The trip, with times at its ends.
    metres
        Distances of its stops along its way [m].
    """
    filled = []
    known = [k for k, stop in enumerate(trip.stops) if stop.arrival is not None or stop.departure is not None]
    for before, after in pairwise(known):
        leaves, comes = _leaves(trip.stops[before]), _comes(trip.stops[after])
        for k in range(before + 1, after):
            way = metres[after] - metres[before]
            share = (metres[k] - metres[before]) / way if way > 0.0 else (k - before) / (after - before)
            trip.stops[k].arrival = trip.stops[k].departure = round(leaves + share * (comes - leaves))
            filled.append(trip.stops[k].stop)
    return filled


def _leaves(stop: StopTime) -> float:
    time = stop.departure if stop.departure is not None else stop.arrival
    return 0.0 if time is None else time


def _comes(stop: StopTime) -> float:
    time = stop.arrival if stop.arrival is not None else stop.departure
    return 0.0 if time is None else time
