"""The rail trips of the chosen day with their calls: which they are, and what is wrong with their times."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.days import services_of_the_day
from tractionpower.io.imports.gtfs.feed import Feed, first_line, rows_of
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted, did_you_mean, printable, shown

RAIL_TYPES = frozenset({"2", *map(str, range(100, 118))})
"""Rail in GTFS, and railway services in the extended route types."""

_TIME = r"^(\d{1,3}):([0-5]?\d):([0-5]?\d)$"
_SHOWN = 5


@dataclass(slots=True)
class StopTime:
    """A stop of a trip; times in seconds after midnight of the service day, or none."""

    stop: str
    arrival: float | None
    departure: float | None
    passes: bool
    line: int


@dataclass(slots=True)
class Frequency:
    """Runs at equal intervals: from a time, up to before another one [s]."""

    first: float
    before: float
    headway_s: float


@dataclass(slots=True)
class Trip:
    """A trip of the day."""

    id: str
    route: str
    shape: str
    direction: str
    block: str
    stops: list[StopTime]
    frequencies: list[Frequency] = field(default_factory=list)


def listed(names: Iterable[str]) -> str:
    """Return the first names of a list as text, and how many there are when not all are shown."""
    found = list(names)
    more = f", ... ({len(found)} in all)" if len(found) > _SHOWN else ""
    return printable(", ".join(found[:_SHOWN])) + more


def read_trips(feed: Feed, options: GtfsOptions, notes: Notes) -> list[Trip]:
    """Return the rail trips of the day in the order of their identifiers, their calls by stop_sequence."""
    chosen = _of_routes(feed, options, notes)
    if chosen.empty:
        return []
    services = services_of_the_day(feed, chosen, options, notes)
    today = chosen[chosen["service_id"].isin(services)]
    others = len(chosen) - len(today)
    if others and len(today):
        notes.ignored.append(f"{counted(others, 'trip')} by rail of other days")
    today = _once(today, options, notes)
    if today.empty:
        return []
    by_trip = _stop_times(feed, set(today["trip_id"]), options, notes)
    trips = []
    without = []
    for _, row in rows_of(today.sort_values("trip_id")):
        stops = by_trip.get(row["trip_id"], [])
        if len(stops) < 2:
            without.append(row["trip_id"])
            continue
        trips.append(Trip(row["trip_id"], row["route_id"], row["shape_id"], row["direction_id"], row["block_id"], stops))
    if without:
        found = f"{counted(len(without), 'trip')} with less than two stops in stop_times.txt, which cannot run: {listed(without)}"
        notes.problems.append(Problem("trip_without_stops", "", found, severity="warning", place="stop_times.txt"))
        notes.ignored.append(f"{counted(len(without), 'trip')} without stops: {listed(without)}")
    _add_frequencies(feed, trips, notes)
    notes.read.append(
        f"{counted(len(trips), 'trip')} by rail of the day, {counted(sum(len(trip.stops) for trip in trips), 'call')}"
    )
    return trips


def _of_routes(feed: Feed, options: GtfsOptions, notes: Notes) -> pd.DataFrame:
    """Return the trips by rail of the routes and agencies asked for; tells what else there is, by route."""
    routes, trips = feed.table("routes"), feed.table("trips")
    counts = trips["route_id"].value_counts().to_dict()
    rail = routes["route_type"].isin(RAIL_TYPES)
    for _, row in rows_of(routes[~rail]):
        name = printable(
            f"{row['route_id']} ({row['route_short_name'] or row['route_long_name']}), route_type {row['route_type']}"
        )
        notes.ignored.append(f"route {name}, is no rail: {counted(counts.get(row['route_id'], 0), 'trip')}")
    unknown = sorted(set(trips["route_id"]) - set(routes["route_id"]))
    if unknown:
        found = (
            f"{counted(sum(counts[name] for name in unknown), 'trip')} of routes that routes.txt does not have: {listed(unknown)}"
        )
        notes.problems.append(Problem("unknown_route", "", found, severity="warning", place="trips.txt"))
        notes.ignored.append(found)
    wanted = rail & _asked(routes, ("route_id", "route_short_name"), options.routes, "routes", notes)
    if options.agencies:
        agencies = feed.table("agency")
        known = _asked(agencies, ("agency_id", "agency_name"), options.agencies, "agencies", notes)
        # with one agency routes need not name it
        wanted &= routes["agency_id"].isin(set(agencies.loc[known, "agency_id"])) | ((len(agencies) == 1) & bool(known.all()))
    for _, row in rows_of(routes[rail & ~wanted]):
        notes.ignored.append(
            f"route {printable(row['route_id'])}, not asked for: {counted(counts.get(row['route_id'], 0), 'trip')} by rail"
        )
    found_trips = trips[trips["route_id"].isin(set(routes.loc[wanted, "route_id"]))]
    if found_trips.empty and not notes.problems:
        types = ", ".join(f"{kind}: {n}" for kind, n in sorted(Counter(routes["route_type"]).items()))
        allowed = "route_type 2 or 100 to 117"
        found = f"the feed has no trips by rail on the routes asked for; routes by type: {types}"
        notes.problems.append(Problem("no_rail", "", found, allowed, place="routes.txt"))
    return found_trips


def _asked(table: pd.DataFrame, columns: tuple[str, str], names: tuple[str, ...], what: str, notes: Notes) -> pd.Series[bool]:
    if not names:
        return pd.Series(True, index=table.index)
    keys = set(table[columns[0]]) | set(table[columns[1]])
    for name in names:
        if name not in keys:
            allowed = listed(sorted(keys - {""}))
            notes.problems.append(Problem(f"unknown_{what}", "", f"{shown(name)} in {what}", allowed, did_you_mean(name, keys)))
    return table[columns[0]].isin(names) | table[columns[1]].isin(names)


def _once(trips: pd.DataFrame, options: GtfsOptions, notes: Notes) -> pd.DataFrame:
    twice = trips["trip_id"].duplicated()
    if twice.any():
        names = sorted(set(trips.loc[twice, "trip_id"]))
        found = f"trips.txt has more than one row for {listed(names)}"
        if options.repair:
            notes.repaired.append(f"{found}: the first one of each is kept")
        else:
            place = f"trips.txt:{first_line(trips[twice])}"
            remedy = "keep one; with repair the first one is kept"
            notes.problems.append(Problem("doubled_trip", "", found, "each trip_id once", remedy, place=place))
    return trips[~twice]


def _stop_times(feed: Feed, wanted: set[str], options: GtfsOptions, notes: Notes) -> dict[str, list[StopTime]]:
    rows = feed.table("stop_times")
    rows = rows[rows["trip_id"].isin(wanted)].copy()
    rows["sequence"] = pd.to_numeric(rows["stop_sequence"], errors="coerce")
    _refuse(rows, rows["sequence"].isna(), "bad_sequence", lambda row: f"stop_sequence {shown(row['stop_sequence'])}", notes)
    for name in ("arrival", "departure"):
        rows[name] = seconds(rows[f"{name}_time"])
        bad = rows[name].isna() & (rows[f"{name}_time"] != "")
        if bad.any() and options.repair:
            notes.repaired.append(
                f"{counted(int(bad.sum()), 'time')} that are none, such as {_first(rows[bad], f'{name}_time')}: left out"
            )
        else:
            _refuse(rows, bad, "bad_time", partial(_no_time, f"{name}_time"), notes)
    known = rows["stop_id"].isin(set(feed.table("stops")["stop_id"]))
    _refuse(rows, ~known, "unknown_stop", lambda row: f"the stop {shown(row['stop_id'])} is not in stops.txt", notes)
    doubled = rows.duplicated(["trip_id", "sequence"])
    if doubled.any() and options.repair:
        notes.repaired.append(f"{counted(int(doubled.sum()), 'call')} with a stop_sequence that their trip has already: left out")
        rows = rows[~doubled]
    else:
        _refuse(rows, doubled, "doubled_call", lambda row: f"stop_sequence {shown(row['stop_sequence'])} twice in a trip", notes)
    rows = rows[known.reindex(rows.index) & rows["sequence"].notna()].sort_values(["trip_id", "sequence"], kind="stable")
    by_trip: dict[str, list[StopTime]] = {}
    for line, row in rows_of(rows):
        arrival, departure = (None if np.isnan(time) else float(time) for time in (row["arrival"], row["departure"]))
        passes = row["pickup_type"] == "1" and row["drop_off_type"] == "1" and arrival == departure
        by_trip.setdefault(row["trip_id"], []).append(StopTime(row["stop_id"], arrival, departure, passes, line))
    return by_trip


def seconds(texts: pd.Series[str]) -> pd.Series[float]:
    """Return times of GTFS, such as 24:05:00, in seconds after midnight; NaN for what is none."""
    parts = texts.str.extract(_TIME).astype(float)
    return parts[0] * 3600.0 + parts[1] * 60.0 + parts[2]


def _no_time(column: str, row: dict[str, Any]) -> str:
    return f"{column} {shown(row[column])} is no time HH:MM:SS"


def _first(rows: pd.DataFrame, column: str) -> str:
    return shown(str(rows.iloc[0][column]))


def _refuse(rows: pd.DataFrame, bad: pd.Series[bool], code: str, words: Callable[[dict[str, Any]], str], notes: Notes) -> None:
    """Tell rows that cannot be used: the first one, and how many there are."""
    if not bad.any():
        return
    line, first = next(rows_of(rows[bad]))
    more = f" (trip {first['trip_id']}); {int(bad.sum())} such rows" if bad.sum() > 1 else f" (trip {first['trip_id']})"
    remedy = "correct it" if code == "unknown_stop" else "correct it; with repair it is left out"
    notes.problems.append(Problem(code, "", printable(words(first) + more), remedy=remedy, place=f"stop_times.txt:{line}"))


def _add_frequencies(feed: Feed, trips: list[Trip], notes: Notes) -> None:
    rows = feed.table("frequencies")
    by_id = {trip.id: trip for trip in trips}
    rows = rows[rows["trip_id"].isin(by_id)]
    first, before = seconds(rows["start_time"]), seconds(rows["end_time"])
    headway = pd.to_numeric(rows["headway_secs"], errors="coerce")
    bad = ~((before > first) & headway.between(1.0, 1e6))
    if bad.any():
        found = f"{counted(int(bad.sum()), 'row')} whose start_time, end_time or headway_secs make no sense"
        place = f"frequencies.txt:{first_line(rows[bad])}"
        allowed = "times HH:MM:SS, start before end, a headway of 1 s or more"
        notes.problems.append(Problem("bad_frequency", "", found, allowed, place=place))
    rows = rows.assign(first=first, before=before, headway=headway)[~bad]
    for _, row in rows_of(rows):
        runs = Frequency(row["first"], row["before"], row["headway"])
        by_id[row["trip_id"]].frequencies.append(runs)
    if len(rows):
        loose = int((rows["exact_times"] != "1").sum())
        notes.read.append(f"{counted(len(rows), 'row')} of frequencies.txt as periodic services")
        if loose:
            notes.assumed.append(
                f"{loose} of them promise an interval only (exact_times is not 1): runs start at equal intervals"
            )
