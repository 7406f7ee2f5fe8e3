"""Table ``sharing``: how neighbouring substations share what the feeding zone between them takes."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.results.extremes import Extremes
from tractionpower.studies.ratings.counted import counted
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import sums_of_columns
from tractionpower.supply.merging import Merger
from tractionpower.supply.topology import Link

Floats = NDArray[np.float64]

Zone = dict[str, list[int]]
"""The feeders that lead into a zone, by substation, in the order of the line."""

_HERE_KM = 1e-3


def find_zones(supply: SupplyTables, line: Line) -> dict[str, Zone]:
    """Return the feeding zones between substations, by name, with the numbers of the feeders that lead into them.

    A zone reaches from substation to substation; tracks between the same two are one zone, and where tracks are joined on
    their way (by connections, section cabins, closed switches) it may have three ends or more. What a single substation feeds
    is no zone. A substation that is bypassed from the start ends none.
    """
    bypassed = {station.id for station in supply.substations if station.state == "bypassed"}
    feeders = [k for k, link in enumerate(supply.links) if link.kind == "feeder" and link.station not in bypassed]
    pieces = _Pieces([supply.links[k] for k in feeders], line, _joined_places(supply, line))
    groups: dict[int, list[int]] = defaultdict(list)
    for k in feeders:
        groups[pieces.of_feeder(supply.links[k])].append(k)
    zones: dict[str, Zone] = {}
    for members in groups.values():
        first: dict[str, float] = {}
        for k in members:
            link = supply.links[k]
            first[link.station] = min(first.get(link.station, math.inf), link.km)
        order = sorted(first, key=lambda station: (first[station], station))
        if len(order) > 1:
            zone = zones.setdefault("–".join(order), {station: [] for station in order})
            for k in members:
                zone[supply.links[k].station].append(k)
    return dict(sorted(zones.items()))


Place = tuple[str, float]
"""Track and kilometre."""


def _joined_places(supply: SupplyTables, line: Line) -> Iterator[tuple[Place, Place]]:
    """Yield places that are one electrically."""
    for connection in line.connections:
        yield (connection.from_.track, connection.from_.km), (connection.to.track, connection.to.km)
    cabins: dict[str, Place] = {}
    for link in supply.links:
        if link.kind == "cabin" and link.closed:
            yield cabins.setdefault(link.station, (link.track, link.km)), (link.track, link.km)
    for switch in supply.supply.switches:
        ends = [(end.track, end.km) for end in (switch.from_, switch.to) if end.track is not None and end.km is not None]
        if switch.state == "closed" and len(ends) > 1:
            yield ends[0], ends[1]


class _Pieces:
    """Tracks cut at the feeders of substations; pieces that are connected are one."""

    def __init__(self, feeders: list[Link], line: Line, joined: Iterable[tuple[Place, Place]]) -> None:
        cuts: dict[str, set[float]] = defaultdict(set)
        for link in feeders:
            cuts[link.track].add(link.km)
        self._cuts = {track.id: np.array(sorted(cuts[track.id])) for track in line.tracks}
        counts = [len(self._cuts[track.id]) + 1 for track in line.tracks]
        self._first = dict(zip(self._cuts, np.cumsum([0, *counts]).tolist(), strict=False))
        self._merger = Merger(sum(counts))
        for places in joined:
            one, other = (self._at(*place) for place in places)
            if one is not None and other is not None:
                self._merger.join(one, other)

    def of_feeder(self, link: Link) -> int:
        """Return the piece that a feeder leads into."""
        at = int(np.searchsorted(self._cuts[link.track], link.km))
        return self._merger.find(self._first[link.track] + at + (link.side == "high_km"))

    def _at(self, track: str, km: float) -> int | None:
        """Return the piece at a place, None where a substation is."""
        cuts = self._cuts[track]
        if len(cuts) and np.abs(cuts - km).min() < _HERE_KM:
            return None
        return int(self._first[track] + np.searchsorted(cuts, km))


class SharingWatch:
    """Sums up what substations feed into their zones.

    Parameters
    ----------
    scenario
        What runs.
    supply
        Its supply, with all devices in their normal states.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        self._from_s, self._zones = scenario.clock.counts_from_s, find_zones(supply, scenario.line)
        self._feeders = [links for zone in self._zones.values() for links in zone.values()]
        self._sums = Extremes(len(self._feeders))

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        time_s, rows = counted(self._from_s, time_s, rows)
        self._sums.add(time_s, sums_of_columns(rows.link_a, self._feeders))

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the rows of table ``sharing``: zones by their substations."""
        means, column = self._sums.mean, 0
        for name, zone in self._zones.items():
            total = float(means[column : column + len(zone)].sum())
            for station in zone:
                mean, highest = float(means[column]), float(self._sums.highest[column])
                yield {
                    "zone": name, "substation": station, "mean_current_a": mean,
                    "share_percent": 100.0 * mean / total if total > 1e-6 else math.nan,
                    "highest_current_a": highest if self._sums.count else math.nan,
                }  # fmt: skip
                column += 1
