"""Stations of a feed, and the ways between them: each kind of trip with its stations and its shape."""

from __future__ import annotations

import heapq
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.feed import Feed, first_line, rows_of
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.shapes import OFF_SHAPE_M, Floats, Polyline, distance_m, place_in_order
from tractionpower.io.imports.gtfs.trips import Trip, listed
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted, printable

_SAME_STATION_M = 300.0
_DETOUR = 1.25
"""Stations that a fast train passes are known by a way that is at most this much longer than the straight line."""


@dataclass(frozen=True, eq=False)
class Pattern:
    """A way that trips have in common.

    Attributes
    ----------
    stops
        The stops as the feed names them.
    stations
        Their stations; longer than `stops` where there is no shape and passed stations were put in.
    line
        The way on the ground.
    along_m, away_m
        Where the stations lie on it, and how far from it [m].
    direction
        `direction_id`.
    trips
        How many trips have it.
    shape
        Its shape, empty if it was made of straight lines.
    """

    stops: tuple[str, ...]
    stations: tuple[str, ...]
    line: Polyline
    along_m: Floats
    away_m: Floats
    direction: str
    trips: int
    shape: str


@dataclass(frozen=True, slots=True)
class Stops:
    """Stops of the feed: places [degrees], names, the station that each belongs to, and their lines in ``stops.txt``."""

    places: dict[str, tuple[float, float]]
    names: dict[str, str]
    station: dict[str, str]
    lines: dict[str, int]

    def at(self, name: str) -> str:
        """Return where a stop stands in the feed."""
        return f"stops.txt:{self.lines[name]}" if name in self.lines else "stops.txt"


def read_stops(feed: Feed, used: set[str], notes: Notes) -> Stops:
    """Return the stops that trips use; platforms of one station become one, by parent_station or by name and place."""
    rows = feed.table("stops").drop_duplicates("stop_id")
    lines = {row["stop_id"]: line for line, row in rows_of(rows)}
    rows = rows.set_index("stop_id")
    lat, lon = (pd.to_numeric(rows[name], errors="coerce") for name in ("stop_lat", "stop_lon"))
    good = lat.between(-90.0, 90.0) & lon.between(-180.0, 180.0) & ~((lat == 0.0) & (lon == 0.0))
    places = {str(name): (float(lat[name]), float(lon[name])) for name in rows.index[good]}
    names = {str(name): printable(str(text)) for name, text in rows["stop_name"].items()}
    station = {}
    for name in sorted(used):
        parent = str(rows.at[name, "parent_station"])
        station[name] = parent if parent in rows.index else name
    merged = _merge_by_name(station, places, names)
    if merged:
        notes.assumed.append(f"stops with one name within {_SAME_STATION_M:g} m are one station: {listed(sorted(merged))}")
    return Stops(places, names, station, lines)


def _merge_by_name(station: dict[str, str], places: dict[str, tuple[float, float]], names: dict[str, str]) -> set[str]:
    by_name = defaultdict(list)
    for name in sorted(set(station.values())):
        if names.get(name) and name in places:
            by_name[names[name]].append(name)
    merged = {}
    for same in by_name.values():
        for other in same[1:]:
            if distance_m(*places[same[0]], *places[other]) <= _SAME_STATION_M:
                merged[other] = same[0]
    for stop, name in station.items():
        station[stop] = merged.get(name, name)
    return {names[name] for name in merged}


def merge_calls(trips: Sequence[Trip], stops: Stops, notes: Notes) -> None:
    """Make one call of neighbouring ones at one station, such as at two of its platforms; tells how many."""
    merged = 0
    for trip in trips:
        kept = trip.stops[:1]
        for stop in trip.stops[1:]:
            if stops.station[stop.stop] == stops.station[kept[-1].stop]:
                kept[-1].departure = stop.departure if stop.departure is not None else kept[-1].departure
                kept[-1].passes = kept[-1].passes and stop.passes and kept[-1].arrival == kept[-1].departure
                merged += 1
            else:
                kept.append(stop)
        trip.stops[:] = kept
    if merged:
        notes.assumed.append(f"{counted(merged, 'call')} at the same station as the call before: made one call with it")


def find_patterns(feed: Feed, trips: Sequence[Trip], stops: Stops, options: GtfsOptions, notes: Notes) -> list[Pattern]:
    """Return the ways of all trips, the longest first; stops off their shape go to the problems, or are told as repaired."""
    keys = Counter((trip.shape, tuple(stop.stop for stop in trip.stops), trip.direction) for trip in trips)
    shapes = _shapes(feed, {shape for shape, _, _ in keys}, notes)
    missing = [key for key in keys if key[0] not in shapes]
    if missing:
        count = sum(keys[key] for key in missing)
        notes.assumed.append(
            f"{counted(count, 'trip')} without a shape: straight lines from stop to stop, shorter than the real line"
        )
    chains = _with_passed([key[1] for key in missing], stops)
    patterns = []
    for (shape, called, direction), count in sorted(keys.items()):
        chain = called if shape in shapes else chains[called]
        points = np.array([stops.places[stop] for stop in chain])
        line = shapes[shape] if shape in shapes else Polyline.through(points[:, 0], points[:, 1])
        if len(line.lat) < 2:
            found = f"the stops {listed(called)} of a trip lie at one place"
            notes.problems.append(Problem("no_way", "", found, "stops at different places", place="stops.txt"))
            continue
        along, away = place_in_order(line, points[:, 0], points[:, 1])
        back_along, back_away = place_in_order(line.reversed(), points[:, 0], points[:, 1])
        worse, better = (float(np.sum(np.minimum(each, OFF_SHAPE_M) ** 2)) for each in (away, back_away))
        if better < 0.25 * worse and away.max() > min(options.stop_tolerance_m, OFF_SHAPE_M):
            notes.assumed.append(f"shape {printable(shape)} runs against its trips and was turned round")
            line, along, away = line.reversed(), back_along, back_away
        stations = tuple(stops.station[stop] for stop in chain)
        patterns.append(Pattern(chain, stations, line, along, away, direction, count, shape if shape in shapes else ""))
    patterns.sort(key=lambda each: (-(each.along_m[-1] - each.along_m[0]), each.direction, -each.trips, each.stops))
    return patterns


def check_places(trips: Sequence[Trip], stops: Stops, fixed: set[str], options: GtfsOptions, notes: Notes) -> None:
    """Tell stops without a place; with repair, or where the override table has them, they get one between their neighbours."""
    used = {stop.stop for trip in trips for stop in trip.stops}
    lost = sorted(used - set(stops.places))
    for name in lost:
        if options.repair or name in fixed:
            near = _between(name, trips, stops)
            if near is not None:
                stops.places[name] = near
                if name not in fixed:
                    notes.repaired.append(f"stop {printable(name)} has no coordinates and was put between its neighbours")
                continue
        found = f"stop {printable(name)} ({stops.names.get(name, '')}) has no coordinates"
        remedy = "give them, or its km in the table of stops; with repair it is put between its neighbours"
        notes.problems.append(Problem("stop_without_place", "", found, "latitude and longitude", remedy, place=stops.at(name)))


def _between(name: str, trips: Sequence[Trip], stops: Stops) -> tuple[float, float] | None:
    for trip in trips:
        called = [stop.stop for stop in trip.stops]
        if name in called:
            k = called.index(name)
            before = [stops.places[other] for other in called[:k] if other in stops.places][-1:]
            after = [stops.places[other] for other in called[k + 1 :] if other in stops.places][:1]
            if before and after:
                return 0.5 * (before[0][0] + after[0][0]), 0.5 * (before[0][1] + after[0][1])
    return None


def _shapes(feed: Feed, wanted: set[str], notes: Notes) -> dict[str, Polyline]:
    rows = feed.table("shapes")
    rows = rows[rows["shape_id"].isin(wanted - {""})]
    numbers = rows[["shape_pt_sequence", "shape_pt_lat", "shape_pt_lon"]].apply(pd.to_numeric, errors="coerce").astype(float)
    on_earth = numbers["shape_pt_lat"].between(-90.0, 90.0) & numbers["shape_pt_lon"].between(-180.0, 180.0)
    bad = ~on_earth | ~np.isfinite(numbers["shape_pt_sequence"])
    if bad.any():
        place = f"shapes.txt:{first_line(rows[bad])}"
        found = f"{counted(int(bad.sum()), 'point')} without number or coordinates: left out"
        notes.problems.append(Problem("bad_shape", "", found, severity="warning", place=place))
        notes.ignored.append(f"shapes.txt: {found}")
    numbers = numbers[~bad].assign(shape_id=rows.loc[~bad, "shape_id"])
    numbers = numbers.sort_values(["shape_id", "shape_pt_sequence"], kind="stable")
    found_shapes = {}
    for name, points in numbers.groupby("shape_id"):
        line = Polyline.through(points["shape_pt_lat"].to_numpy(), points["shape_pt_lon"].to_numpy())
        if len(line.lat) > 1:
            found_shapes[str(name)] = line
    return found_shapes


def _with_passed(chains: Sequence[tuple[str, ...]], stops: Stops) -> dict[tuple[str, ...], tuple[str, ...]]:
    """Return each chain of stops with those put in that a train passes by what other trains show."""
    edges: dict[str, dict[str, float]] = defaultdict(dict)
    for chain in chains:
        for a, b in pairwise(chain):
            if a != b:
                edges[a][b] = edges[b][a] = distance_m(*stops.places[a], *stops.places[b])
    longer = {}
    for a in sorted(edges):
        for b, direct in sorted(edges[a].items()):
            longer[a, b] = _way(edges, a, b, _DETOUR * direct, direct)
    return {chain: (*(stop for a, b in pairwise(chain) for stop in longer.get((a, b), (a,))), chain[-1]) for chain in chains}


def _way(edges: dict[str, dict[str, float]], start: str, end: str, most_m: float, direct_m: float) -> tuple[str, ...]:
    """Return the stops from `start` up to before `end` by the shortest way of short edges; only `start` if there is none."""
    queue: list[tuple[float, tuple[str, ...]]] = [(0.0, (start,))]
    done = set()
    while queue:
        length, way = heapq.heappop(queue)
        if way[-1] == end:
            return way[:-1]
        if way[-1] in done:
            continue
        done.add(way[-1])
        for other, step in edges[way[-1]].items():
            if step < direct_m and length + step <= most_m and other not in done:
                heapq.heappush(queue, (length + step, (*way, other)))
    return (start,)
