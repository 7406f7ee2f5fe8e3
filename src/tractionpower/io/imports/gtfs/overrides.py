"""The table of stops that a user gives beside a feed: kilometres in place of those found on the shape."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.network import Axis, Network, Place
from tractionpower.io.imports.gtfs.patterns import Stops
from tractionpower.io.imports.gtfs.shapes import Polyline
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted, did_you_mean, printable, shown


@dataclass(frozen=True, slots=True)
class Override:
    """Where a stop lies: kilometre, number of the line from 0 where it is given, file and line that say so."""

    km: float
    axis: int | None
    place: str


def read_overrides(file: Path | None, known: set[str], notes: Notes) -> dict[str, Override]:
    """Read the table of stops: columns stop_id, km, and track for a line other than the one that the shape tells."""
    if file is None:
        return {}
    place = printable(Path(file).name)
    try:
        rows = pd.read_csv(
            file, dtype=str, keep_default_na=False, skipinitialspace=True, encoding="utf-8-sig", sep=None, engine="python"
        )
    except (OSError, ValueError, csv.Error) as error:
        found = f"the table of stops cannot be read: {printable(str(error))}"
        notes.problems.append(Problem("unreadable_file", "", found, "CSV with stop_id, km, track", place=place))
        return {}
    rows.columns = [column.strip() for column in rows.columns]
    if not {"stop_id", "km"} <= set(rows.columns):
        found = f"columns {', '.join(map(printable, rows.columns))}"
        notes.problems.append(Problem("missing_column", "", found, "stop_id, km, and perhaps track", place=place))
        return {}
    overrides: dict[str, Override] = {}
    for k, row in enumerate(rows.to_dict("records"), start=2):
        stop, km, axis = row["stop_id"].strip(), _number(row["km"]), _number(row.get("track", "") or "0")
        where = f"{place}:{k}"
        if stop not in known:
            found = f"the stop {shown(stop)} is not in the feed"
            notes.problems.append(Problem("unknown_stop", "", found, remedy=did_you_mean(stop, known), place=where))
        elif km is None or axis is None or axis < 0 or axis != int(axis):
            found = f"km {shown(row['km'])}, track {shown(row.get('track', ''))}"
            notes.problems.append(Problem("bad_place", "", found, "numbers", place=where))
        elif stop in overrides:
            notes.problems.append(Problem("doubled_stop", "", f"the stop {shown(stop)} twice", "each once", place=where))
        else:
            overrides[stop] = Override(km, int(axis) - 1 if axis else None, where)
    return overrides


def _number(text: str) -> float | None:
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def apply_overrides(overrides: dict[str, Override], stops: Stops, network: Network, notes: Notes) -> None:
    """Put stations where the table has them; axes grow as far as they must."""
    used = {name: override for name, override in overrides.items() if stops.station.get(name) in network.stations}
    for name, override in used.items():
        station = stops.station[name]
        axis = network.stations[station].axis if override.axis is None else override.axis
        if axis >= len(network.axes):
            found = f"stop {printable(name)} is to be on track {axis + 1}"
            allowed = f"lines 1 to {len(network.axes)}"
            notes.problems.append(Problem("bad_place", "", found, allowed, place=override.place))
            continue
        network.stations[station] = Place(axis, round(override.km, 3))
    for number, axis_ in enumerate(network.axes):
        _fit(axis_, number, network, {stops.station[name] for name in used})
    if used:
        notes.read.append(f"{counted(len(used), 'stop')} at the kilometres of the table of stops")
    if len(used) < len(overrides):
        notes.ignored.append(
            f"{counted(len(overrides) - len(used), 'row')} of the table of stops, where no train of the day stops"
        )


def check_order(
    overrides: dict[str, Override],
    stops: Stops,
    network: Network,
    before: dict[str, Place],
    ways: Sequence[tuple[Sequence[str], int]],
    notes: Notes,
) -> None:
    """Tell rows of the table of stops that put a station where trains would have to turn round.

    `before` are the places without the table, `ways` the stations of trains and how often they turned round there.
    """
    blamed: set[str] = set()
    for stations, turns in ways:
        if network.turns(stations) <= turns:
            continue
        mine = {name: each for name, each in overrides.items() if stops.station.get(name) in stations}
        # the row whose station trains would turn at fewest without it
        without = {name: _turns_without(stops.station[name], stations, network, before) for name in mine}
        culprits = [name for name in mine if without[name] == min(without.values())] if min(without.values()) <= turns else mine
        for name in culprits:
            if name in blamed:
                continue
            blamed.add(name)
            k = list(stations).index(stops.station[name])
            beside = [other for other in (*stations[max(k - 1, 0) : k], *stations[k + 1 : k + 2])]
            told = " and ".join(f"{printable(other)} (km {network.stations[other].km:g})" for other in beside)
            found = f"stop {printable(name)} at km {mine[name].km:g}, out of the order in which trains come to it, beside {told}"
            notes.problems.append(Problem("order_of_stops", "", found, remedy="correct its km", place=mine[name].place))


def _turns_without(station: str, stations: Sequence[str], network: Network, before: dict[str, Place]) -> int:
    """Return how often trains turn round if a station is where it was without the table."""
    moved = network.stations[station]
    network.stations[station] = before[station]
    turns = network.turns(stations)
    network.stations[station] = moved
    return turns


def _fit(axis: Axis, number: int, network: Network, moved: set[str]) -> None:
    """Let an axis reach from its first to its last station or junction; its drawing on the ground is stretched to that."""
    if not any(place.axis == number and name in moved for name, place in network.stations.items()):
        return
    kms = [place.km for place in network.stations.values() if place.axis == number]
    kms += [place.km for pair in network.junctions for place in pair if place.axis == number]
    low, high = min(kms), max(kms)
    if high > low and axis.line.length_m > 0.0:
        stretch = (high - low) * 1000.0 / axis.line.length_m
        axis.line, axis.from_km = Polyline(axis.line.lat, axis.line.lon, axis.line.along_m * stretch), low
