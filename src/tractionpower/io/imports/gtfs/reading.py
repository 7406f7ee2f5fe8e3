"""GTFS to a study: the rail trips of one day as trains on the line that their shapes draw."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.days import check_day
from tractionpower.io.imports.gtfs.feed import Feed, read_feed
from tractionpower.io.imports.gtfs.network import Leg, Network, Place
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.overrides import Override, apply_overrides, check_order, read_overrides
from tractionpower.io.imports.gtfs.pace import told_pace
from tractionpower.io.imports.gtfs.patterns import Pattern, Stops, check_places, find_patterns, merge_calls, read_stops
from tractionpower.io.imports.gtfs.shapes import OFF_SHAPE_M
from tractionpower.io.imports.gtfs.texts import line_text, readme_text, study_text, supply_text, timetable_text
from tractionpower.io.imports.gtfs.times import MINUTE_S, ROUNDED_S, fill_times, mend_times, rounding_s, without_times
from tractionpower.io.imports.gtfs.tracks import Tracks, lay_tracks
from tractionpower.io.imports.gtfs.trains import Timed, rotations_of, train_rows
from tractionpower.io.imports.gtfs.trips import Trip, listed, read_trips
from tractionpower.io.imports.imported import Imported, Notes
from tractionpower.io.stock_finder import find_rolling_stock, not_found
from tractionpower.io.wording import counted, printable

_DIFFERS_M = 300.0
_DIFFERS = 0.2


def read_gtfs(source: str | Path, **options: Any) -> Imported:
    """Read the rail trips of one day from a GTFS feed.

    Parameters
    ----------
    source
        A folder with the files of the feed, or a zip of them.
    options
        Fields of `GtfsOptions`.

    Returns
    -------
    The files of a study, none of them if there are errors; and what was read, assumed, repaired, ignored, with all problems.

    Raises
    ------
    UsageError
        If the date or the day of the week that is asked for is none.
    """
    choices, notes = GtfsOptions(**options), Notes()
    check_day(choices)
    return Imported(_texts(Path(source), choices, notes) if _are_good(choices, notes) else {}, notes)


def _are_good(options: GtfsOptions, notes: Notes) -> bool:
    for name, above in (("min_dwell_s", -1e-9), ("speed_kmh", 0.0), ("stop_tolerance_m", 0.0)):
        value = getattr(options, name)
        if not (math.isfinite(value) and value > above):
            notes.problems.append(Problem("bad_option", "", f"{name} is {value:g}", "a number above zero"))
    if find_rolling_stock("trains", options.train, options.folder) is None:
        notes.problems.append(not_found("trains", options.train, options.folder, "", "--train"))
    return not notes.problems


def _failed(notes: Notes) -> bool:
    return any(problem.severity == "error" for problem in notes.problems)


def _texts(source: Path, options: GtfsOptions, notes: Notes) -> dict[str, str]:
    feed = read_feed(source, notes, repair=options.repair)
    if _failed(notes):
        return {}
    trips = read_trips(feed, options, notes)
    overrides = read_overrides(options.stops, set(feed.table("stops")["stop_id"]), notes)
    if not trips:
        if not _failed(notes):
            notes.problems.append(Problem("no_trips", "", "no trip of the day is left that can run"))
        return {}
    mend_times(trips, options, notes)
    stops = read_stops(feed, {stop.stop for trip in trips for stop in trip.stops}, notes)
    merge_calls(trips, stops, notes)
    short = [trip.id for trip in trips if len(trip.stops) < 2]
    if short:
        found = f"{counted(len(short), 'trip')} with all calls at one station, which cannot run: {listed(short)}"
        notes.problems.append(Problem("no_way", "", found, severity="warning", place="stop_times.txt"))
        notes.ignored.append(found)
        trips = [trip for trip in trips if len(trip.stops) > 1]
    check_places(trips, stops, set(overrides), options, notes)
    if _failed(notes):
        return {}
    patterns = find_patterns(feed, trips, stops, options, notes)
    _check_distances(patterns, stops, overrides, options, notes)
    network = _network(patterns, notes)
    if _failed(notes):
        return {}
    turns = [network.turns(pattern.stations) for pattern in patterns]
    before = dict(network.stations)
    apply_overrides(overrides, stops, network, notes)
    check_order(overrides, stops, network, before, [(each.stations, n) for each, n in zip(patterns, turns, strict=True)], notes)
    tracks = lay_tracks(network, options.double, notes.problems)
    _check_ways(patterns, network, overrides, notes)
    if _failed(notes):
        return {}
    return _written(trips, stops, tracks, _name(feed, options), options, notes)


def _name(feed: Feed, options: GtfsOptions) -> str:
    agencies = feed.table("agency")["agency_name"]
    return options.name or (printable(str(agencies.iloc[0])) if len(agencies) else "Line from a GTFS feed")


def _network(patterns: Sequence[Pattern], notes: Notes) -> Network:
    network = Network()
    for pattern in _from_one_end(patterns):
        network.add(pattern)
    notes.problems += network.problems
    trees = len({axis.tree for axis in network.axes})
    lengths = ", ".join(f"{axis.to_km - axis.from_km:.3f} km" for axis in network.axes)
    notes.read.append(f"{len(network.stations)} stations; lines, the longest way and its branches: {lengths}")
    if trees > 1:
        notes.assumed.append(f"the lines form {trees} networks that do not touch: routes can be chosen to import one of them")
    return network


def _from_one_end(patterns: Sequence[Pattern]) -> list[Pattern]:
    """Return patterns, the longest first; of those about as long as the longest, direction 0 begins: it sets where km 0 is."""
    longest = [each for each in patterns if _length(each) >= 0.99 * _length(patterns[0])]
    first = min(longest, key=lambda each: (each.direction or "0", -_length(each)), default=None)
    return [first, *(each for each in patterns if each is not first)] if first is not None else []


def _length(pattern: Pattern) -> float:
    return float(pattern.along_m[-1] - pattern.along_m[0])


def _check_distances(
    patterns: Sequence[Pattern], stops: Stops, overrides: dict[str, Override], options: GtfsOptions, notes: Notes
) -> None:
    """Tell stops off the shape, each once with its greatest distance."""
    least = min(options.stop_tolerance_m, OFF_SHAPE_M)
    away: dict[str, tuple[float, str]] = {}
    for pattern in patterns:
        for k, (stop, distance) in enumerate(zip(pattern.stops, pattern.away_m.tolist(), strict=True)):
            if distance > least and distance > away.get(stop, (0.0, ""))[0]:
                neighbours = [printable(other) for other in (*pattern.stops[max(k - 1, 0) : k], *pattern.stops[k + 1 : k + 2])]
                beside = ("beside " if len(neighbours) == 1 else "between ") + " and ".join(neighbours)
                away[stop] = distance, f"shape {printable(pattern.shape)} {beside}"
    for stop, (distance, where) in sorted(away.items()):
        found = f"stop {printable(stop)} ({stops.names.get(stop, '')}) lies {distance:.0f} m from {where}"
        put = "at the nearest place there, or halfway between them" if distance > OFF_SHAPE_M else "at the nearest place there"
        if stop in overrides:
            notes.read.append(f"{found}: its place is that of the table of stops")
        elif distance <= options.stop_tolerance_m:
            notes.assumed.append(f"{found}, within the tolerance of {options.stop_tolerance_m:g} m: put {put}")
        elif options.repair:
            notes.repaired.append(f"{found}: put {put}")
        else:
            allowed = f"at most {options.stop_tolerance_m:g} m"
            remedy = f"correct its coordinates, or give its km in the table of stops; with repair it is put {put}"
            notes.problems.append(Problem("stop_off_shape", "", found, allowed, remedy, place=stops.at(stop)))


def _check_ways(patterns: Sequence[Pattern], network: Network, overrides: dict[str, Override], notes: Notes) -> None:
    """Tell trips whose way over the axes is not that of their shape: rings, and stations that are passed twice."""
    for pattern in patterns:
        off = pattern.away_m > OFF_SHAPE_M  # their place depends on which trains stop beside them
        for k, (a, b) in enumerate(pairwise(pattern.stations)):
            if a in overrides or b in overrides or off[k] or off[k + 1]:
                continue
            shape_m = float(pattern.along_m[k + 1] - pattern.along_m[k])
            line_m = sum(abs(leg.to_km - leg.from_km) for leg in network.way((a, b))) * 1000.0
            if abs(line_m - shape_m) > max(_DIFFERS_M, _DIFFERS * shape_m):
                ways = f"{shape_m / 1000.0:.2f} km, on the line it is {line_m / 1000.0:.2f} km"
                found = f"from {printable(a)} to {printable(b)} trips run {ways}"
                remedy = "a ring, or two ways between these stations: choose other routes, or give their km in the table of stops"
                notes.problems.append(Problem("way_differs", "", found, "about the same", remedy, place="shapes.txt"))
                return


def _written(
    trips: Sequence[Trip], stops: Stops, tracks: Tracks, name: str, options: GtfsOptions, notes: Notes
) -> dict[str, str]:
    network = tracks.network
    ids = identifiers(network.stations)
    run_ids = identifiers([trip.id for trip in trips])
    timed = [Timed(trip, run_ids[trip.id], _legs(trip, stops, network)) for trip in trips]
    still = [each for each in timed if not each.legs]
    for each in still:
        found = f"trip {printable(each.trip.id)} stays at one place"
        notes.problems.append(Problem("no_way", "", found, "stops at different places", place="trips.txt"))
    if still:
        return {}
    tolerance_s = ROUNDED_S if rounding_s(trips) == MINUTE_S else 0.0
    pace = told_pace(trips, stops.station, network, options, tolerance_s)
    _fill(timed, stops, tracks, options, notes)
    trains, services = train_rows(timed, tracks, stops, ids, options)
    rotations = rotations_of(timed, stops, notes)
    _tell_assumed(trips, tracks, options, tolerance_s, notes)
    notes.assumed += [pace] if pace else []
    times = [time for each in timed for time in each.span()]
    parts = {"trains": trains, "services": services, "rotations": rotations}
    texts = {
        "line.yaml": line_text(name, tracks, stops.names, ids, options),
        "supply.yaml": supply_text(tracks),
        "timetable.yaml": timetable_text(parts),
    }
    return {"README.md": readme_text(name, notes), **texts, "study.yaml": study_text(name, min(times), max(times), tolerance_s)}


def _legs(trip: Trip, stops: Stops, network: Network) -> list[Leg]:
    return network.way([stops.station[stop.stop] for stop in trip.stops])


def _fill(timed: Sequence[Timed], stops: Stops, tracks: Tracks, options: GtfsOptions, notes: Notes) -> None:
    """Put times to calls that have none if repair is asked for, else tell them."""
    filled = 0
    open_: dict[str, int] = {}
    for each in timed:
        lacking = without_times(each.trip)
        if lacking and options.repair:
            names = [stops.station[stop.stop] for stop in each.trip.stops]
            steps = [sum(abs(leg.to_km - leg.from_km) for leg in tracks.network.way(pair)) for pair in pairwise(names)]
            filled += len(fill_times(each.trip, [0.0, *np.cumsum(steps).tolist()]))
        elif lacking:
            open_[each.trip.id] = len(lacking)
    if filled:
        notes.repaired.append(
            f"{counted(filled, 'call')} without times: put between their neighbours, in proportion to the distance"
        )
    if open_:
        notes.assumed.append(
            f"{counted(sum(open_.values()), 'call')} of {counted(len(open_), 'trip')} without times ({listed(open_)}):"
            " the trains stop there without any; with repair they get some in proportion to the distance"
        )


def _tell_assumed(trips: Sequence[Trip], tracks: Tracks, options: GtfsOptions, tolerance_s: float, notes: Notes) -> None:
    once = sum(stop.arrival == stop.departure for trip in trips for stop in trip.stops[1:-1] if not stop.passes)
    if once:
        notes.assumed.append(
            f"{counted(once, 'call')} on the way with one time for arrival and departure: it is the departure, the arrival"
            f" is not planned; every stop lasts {options.min_dwell_s:g} s at least"
        )
    else:
        notes.assumed.append(f"every stop on the way lasts {options.min_dwell_s:g} s at least, or as planned if that is less")
    if tolerance_s:
        notes.assumed.append(
            f"times are whole minutes, rounded: a train less than {tolerance_s:g} s late may be on time (study.yaml:"
            f" feasibility: {{tolerance_s: {tolerance_s:g}}})"
        )
    double = ", ".join(f"{each.track} (km {each.from_km:g} to {each.to_km:g})" for each in tracks.seconds) or "none"
    notes.assumed += [
        f"second tracks, for trains with falling kilometres: {double}; trains do not see each other",
        f"speed limit {options.speed_kmh:g} km/h everywhere; level and straight; all trips are run by the train {options.train}",
        "the whole supply: substations at equal distances, contact line, rails",
    ]


def identifiers(names: Sequence[str] | dict[str, Place]) -> dict[str, str]:
    """Return for each name an identifier that the files allow, no two equal."""
    found: dict[str, str] = {}
    taken: dict[str, int] = defaultdict(int)
    for name in names:
        plain = printable(name).replace("[", "(").replace("]", ")").strip()[:280] or "-"
        taken[plain] += 1
        found[name] = plain if taken[plain] == 1 else f"{plain} ({taken[plain]})"
    return found
