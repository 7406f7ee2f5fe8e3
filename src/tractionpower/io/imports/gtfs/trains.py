"""Trips as trains, services and rotations of a timetable."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from tractionpower.io.imports.gtfs.network import Leg
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.patterns import Stops
from tractionpower.io.imports.gtfs.tracks import Tracks
from tractionpower.io.imports.gtfs.trips import Frequency, StopTime, Trip, listed
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted
from tractionpower.model.base import format_time


@dataclass(frozen=True, slots=True)
class Timed:
    """A trip with its identifier in the timetable and its way."""

    trip: Trip
    id: str
    legs: list[Leg]

    @property
    def starts(self) -> float:
        """Departure from its first stop [s]."""
        return self.trip.stops[0].departure or 0.0

    @property
    def ends(self) -> float:
        """Arrival at its last stop [s]."""
        return self.trip.stops[-1].arrival or 0.0

    def span(self) -> tuple[float, float]:
        """Return when its first run starts and its last one ends [s]."""
        if not self.trip.frequencies:
            return self.starts, self.ends
        firsts = [each.first for each in self.trip.frequencies]
        return min(firsts), max(map(_last, self.trip.frequencies)) + self.ends - self.starts


def _last(frequency: Frequency) -> float:
    """Return the start of the last run: before the end of the interval."""
    runs = int((frequency.before - frequency.first - 1e-6) // frequency.headway_s)
    return frequency.first + runs * frequency.headway_s


def train_rows(
    timed: Sequence[Timed], tracks: Tracks, stops: Stops, ids: dict[str, str], options: GtfsOptions
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return the rows of trains and of services, by their starts."""
    trains: list[dict[str, Any]] = []
    services: list[dict[str, Any]] = []
    for each in sorted(timed, key=lambda item: (item.starts, item.id)):
        common = {"train": options.train, "route": tracks.route(each.legs)}
        names = [ids[stops.station[stop.stop]] for stop in each.trip.stops]
        if not each.trip.frequencies:
            calls = _calls(each.trip, names, 0.0, options)
            trains.append({"id": each.id, **common, "calls": calls})
        for k, frequency in enumerate(each.trip.frequencies, start=1):
            name = each.id if len(each.trip.frequencies) == 1 else f"{each.id} ({k})"
            calls = _calls(each.trip, names, each.starts, options)
            first, last = format_time(frequency.first), format_time(_last(frequency))
            times = {"first": first, "last": last, "headway_s": frequency.headway_s}
            services.append({"id": name, **common, **times, "calls": calls})
    return trains, services


def _calls(trip: Trip, names: Sequence[str], from_s: float, options: GtfsOptions) -> list[dict[str, Any]]:
    calls = [{"station": names[0], "departure": format_time((trip.stops[0].departure or 0.0) - from_s)}]
    calls += [_call(stop, name, from_s, options) for stop, name in zip(trip.stops[1:-1], names[1:-1], strict=True)]
    return [*calls, {"station": names[-1], "arrival": format_time((trip.stops[-1].arrival or 0.0) - from_s)}]


def _call(stop: StopTime, name: str, from_s: float, options: GtfsOptions) -> dict[str, Any]:
    call: dict[str, Any] = {"station": name}
    arrival, departure = stop.arrival, stop.departure
    if stop.passes:
        return call | ({"arrival": format_time(arrival - from_s)} if arrival is not None else {}) | {"stops": False}
    dwell = options.min_dwell_s
    if arrival is not None and arrival != departure:
        call["arrival"] = format_time(arrival - from_s)
    if departure is not None:
        call["departure"] = format_time(departure - from_s)
        if arrival is not None and arrival != departure:
            dwell = min(dwell, departure - arrival)
    return call | ({"min_dwell_s": dwell} if dwell > 0.0 else {})


def rotations_of(timed: Sequence[Timed], stops: Stops, notes: Notes) -> list[dict[str, Any]]:
    """Return rotations by block_id: trips of a block, each from where the one before ends and not before it does."""
    blocks: dict[str, list[Timed]] = defaultdict(list)
    for each in timed:
        if each.trip.block and not each.trip.frequencies:
            blocks[each.trip.block].append(each)
    rotations = []
    broken = []
    for block, members in sorted(blocks.items()):
        members.sort(key=lambda each: (each.starts, each.id))
        chains: list[list[Timed]] = [members[:1]]
        for before, after in pairwise(members):
            same = stops.station[before.trip.stops[-1].stop] == stops.station[after.trip.stops[0].stop]
            if same and after.starts >= before.ends:
                chains[-1].append(after)
            else:
                broken.append(f"{before.id} to {after.id}")
                chains.append([after])
        whole = [chain for chain in chains if len(chain) > 1]
        for k, chain in enumerate(whole, start=1):
            rotations.append({"id": block if len(whole) == 1 else f"{block} ({k})", "runs": [each.id for each in chain]})
    if rotations:
        notes.read.append(f"{counted(len(rotations), 'rotation')} by block_id, without a shortest time of turning round")
    if broken:
        notes.ignored.append(
            f"{counted(len(broken), 'link')} of block_id, as the next trip starts elsewhere or before the one before ends:"
            f" {listed(broken)}"
        )
    return rotations
