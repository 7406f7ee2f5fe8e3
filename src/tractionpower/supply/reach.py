"""What hangs together over the contact lines: a graph of stretches, busbars and what ties them, before anything is solved.

Stretches end where the contact line ends or where it is cut: at a substation or section cabin that is not bypassed, and
at an open section point. Feeders tie stretches to busbars; switches and connections of the line tie whatever they join.
A stretch is live if closed ties lead from it to the busbar of a substation whose rectifiers are in service.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

from tractionpower.alignment.intervals import cut, merge
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.supply import Substation
from tractionpower.model.switchgear import Feeder, Side, SwitchEnd
from tractionpower.supply.site import HIGH, Place, Site, Station, rows_by_side

TYING = ("in_service", "rectifiers_out", "closed")
"""States in which the busbar of a station ties the contact lines."""


@dataclass(frozen=True, slots=True)
class LineStretch:
    """An electrically continuous piece of one track's contact line [m]."""

    track: str
    start_m: float
    end_m: float
    live: bool

    def touches(self, place: Place) -> bool:
        """Tell whether a place lies on the stretch, or so close to it that they share a node."""
        track, metre = place
        return track == self.track and self.start_m - SHARED_NODE_M < metre < self.end_m + SHARED_NODE_M


@dataclass(frozen=True, slots=True)
class LinePoint:
    """A place of a contact line; where it is cut, its side."""

    track: str
    metre: float
    side: Side | None = None


Point = LinePoint | str
"""A place of a contact line, or the busbar of the station with this identifier."""


@dataclass(frozen=True, slots=True)
class Tie:
    """Something closed that joins two points.

    Attributes
    ----------
    kind
        feeder, switch, or connection of the line.
    name
        How messages call it.
    path
        Its place in the model.
    ohm
        Its resistance; a cable counts as some [ohm].
    first, second
        What it joins.
    """

    kind: str
    name: str
    path: str
    ohm: float
    first: Point
    second: Point


class ContactGraph:
    """The contact lines of a supply with all devices in their states.

    Parameters
    ----------
    site
        The supply, and where it lies; what is off the tracks is passed over.

    Attributes
    ----------
    cuts
        Metres at which the contact line of each track is cut, rising.
    ties
        What is closed: connections, feeders, switches.
    stretches
        The pieces of contact line.
    """

    def __init__(self, site: Site) -> None:
        self.site = site
        self.cuts = self._cuts()
        self._pieces = {
            track: [
                ends
                for ends in cut(merge((part.start_m, part.end_m) for part in parts), self.cuts.get(track, ()))
                if ends[1] - ends[0] >= SHARED_NODE_M  # a shorter piece is one node with its neighbour
            ]
            for track, parts in site.contact.items()
        }
        self._first = {}
        count = 0
        for track, pieces in self._pieces.items():
            self._first[track] = count
            count += len(pieces)
        self.ties = [*self._connections(), *self._feeders(), *self._switches()]
        self._part = self._parts(count)
        sources = {self._part[station.id] for station in site.supply.substations if station.feeds}
        self.stretches = [
            LineStretch(track, *ends, live=self._part[self._first[track] + number] in sources)
            for track, pieces in self._pieces.items()
            for number, ends in enumerate(pieces)
        ]

    def sources_of(self, stretch: LineStretch) -> list[Substation]:
        """Return the substations that feed a stretch."""
        mine = self._part[self._piece(LinePoint(stretch.track, 0.5 * (stretch.start_m + stretch.end_m)))]
        return [station for station in self.site.supply.substations if station.feeds and self._part[station.id] == mine]

    def is_cut(self, place: Place) -> bool:
        """Tell whether the contact line has two sides at a place."""
        return self.is_separated(place) and len(self.site.line_sides(place)) == 2

    def is_separated(self, place: Place) -> bool:
        """Tell whether a device that cuts the contact line stands at a place."""
        track, metre = place
        return self.near(self.cuts.get(track, []), metre) is not None

    @staticmethod
    def near(metres: list[float], metre: float) -> float | None:
        """Return which of rising `metres` shares a node with a place, or None."""
        at = bisect_left(metres, metre - SHARED_NODE_M)
        return metres[at] if at < len(metres) and metres[at] < metre + SHARED_NODE_M else None

    # -- cuts and ties --------------------------------------------------------------------------------------------

    def _cuts(self) -> dict[str, list[float]]:
        found: dict[str, list[float]] = {}
        for station in self.site.stations:
            if station.state != "bypassed":
                for track, metre in self.site.fed[station.id].values():
                    found.setdefault(track, []).append(metre)
        for item in self.site.supply.section_points:
            place = self.site.place(item.track, item.km)
            if item.state == "open" and place is not None:
                found.setdefault(place[0], []).append(place[1])
        return {track: sorted(metres) for track, metres in found.items()}

    def _connections(self) -> Iterator[Tie]:
        """Yield the connections; a contact line that is cut there is joined by feeders only."""
        for index, item in enumerate(self.site.line.connections):
            ends = [self.site.place(end.track, end.km) for end in (item.from_, item.to)]
            places = [end for end in ends if end is not None and self.site.has_contact_line(end)]
            if len(places) < 2 or any(self.is_cut(end) for end in places) or all(self.is_separated(end) for end in places):
                continue
            points = [LinePoint(*end) for end in places]
            path = f"line.connections[{index}]"
            yield Tie("connection", f"the connection of tracks {item.from_.track} and {item.to.track}", path, 0.0, *points)

    def _feeders(self) -> Iterator[Tie]:
        rows = rows_by_side(self.site.supply.feeders)
        for station in self.site.stations:
            if station.state in TYING:
                for track, side in self.site.feeders(station):
                    place = self.site.fed[station.id][track]
                    index = rows.get((station.id, track, side))
                    row = None if index is None else self.site.supply.feeders[index]
                    if row is None or row.state == "closed":
                        path = f"supply.feeders[{index}]" if row is not None else station_path(station)
                        name = f"feeder {station.id} {track} {side}"
                        yield Tie("feeder", name, path, _feeder_ohm(station, row), station.id, LinePoint(*place, side))

    def _switches(self) -> Iterator[Tie]:
        for switch in self.site.supply.switches:
            ends = [self.point_of(end) for end in (switch.from_, switch.to)]
            if switch.state == "closed" and ends[0] is not None and ends[1] is not None:
                path = f"supply.switches[{switch.id}]"
                yield Tie("switch", f"switch {switch.id}", path, switch.resistance_ohm, ends[0], ends[1])

    def point_of(self, end: SwitchEnd) -> Point | None:
        """Return what an end of a switch is connected to, or None if there is no such thing."""
        if end.busbar is not None:
            return end.busbar if end.busbar in self.site.fed else None
        place = self.site.place(end.track, end.km)
        return LinePoint(*place, end.side) if place is not None and self.site.has_contact_line(place) else None

    # -- what hangs together --------------------------------------------------------------------------------------

    def _piece(self, point: LinePoint) -> int | None:
        """Return the number of the piece of contact line that a point lies on."""
        pieces = self._pieces[point.track]
        at = bisect_right(pieces, (point.metre, float("inf"))) - 1
        touching = [
            n
            for n in (at - 1, at, at + 1)
            if 0 <= n < len(pieces) and pieces[n][0] - SHARED_NODE_M < point.metre < pieces[n][1] + SHARED_NODE_M
        ]
        if not touching:
            return None
        return self._first[point.track] + touching[-1 if point.side == HIGH else 0]

    def _parts(self, count: int) -> dict[int | str | None, int]:
        """Return the number of its connected part for each piece and busbar."""
        neighbours: dict[int | str | None, list[int | str | None]] = {n: [] for n in range(count)}
        neighbours |= {station.id: [] for station in self.site.stations}
        for tie in self.ties:
            ends = [self._piece(end) if isinstance(end, LinePoint) else end for end in (tie.first, tie.second)]
            if None not in ends:
                neighbours[ends[0]].append(ends[1])
                neighbours[ends[1]].append(ends[0])
        part: dict[int | str | None, int] = {}
        for start in neighbours:
            waiting = [start] if start not in part else []
            while waiting:
                node = waiting.pop()
                if node not in part:
                    part[node] = len(part) if node == start else part[start]
                    waiting += neighbours[node]
        return part


def station_path(station: Station) -> str:
    """Return the model path of a substation or section cabin."""
    return f"supply.{'substations' if isinstance(station, Substation) else 'section_cabins'}[{station.id}]"


def _feeder_ohm(station: Station, row: Feeder | None) -> float:
    """Return the resistance of a feeder; that of a cable is not zero, whatever it is [ohm]."""
    if row is not None and row.cable is not None:
        return float("inf")
    return station.feeder_resistance_ohm if row is None or row.resistance_ohm is None else row.resistance_ohm
