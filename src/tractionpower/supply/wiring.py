"""How devices join the conductors: substations, section cabins, feeders, switches, bonds, connections, earth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from tractionpower.alignment.axis import compile_axes, tracks_at
from tractionpower.model.conductors import Conductor as ConductorRow
from tractionpower.model.line import Line
from tractionpower.model.supply import SectionCabin, Substation, Supply
from tractionpower.model.switchgear import Feeder, SwitchEnd, feeder_id
from tractionpower.supply.bundles import HIGH, LOW, SHARED_KM, Bundle
from tractionpower.supply.conductors import cable_resistance
from tractionpower.supply.topology import EARTH, SHORT_OHM, Busbar, EarthLink, Link, Section, Topology, lay_spans

Station = Substation | SectionCabin

_TIES = ("in_service", "rectifiers_out", "closed")
"""States in which a busbar ties the contact lines."""


def build_topology(supply: Supply, line: Line, conductors: Sequence[ConductorRow] = ()) -> Topology:
    """Return the graph of a supply that has passed `supply.checks`."""
    return _Wiring(supply, line, conductors).build()


class _Wiring:
    def __init__(self, supply: Supply, line: Line, conductors: Sequence[ConductorRow]) -> None:
        self.supply, self.line, self.conductors = supply, line, conductors
        self.axes = compile_axes(line)
        self.substations = sorted(supply.substations, key=lambda station: station.id)
        self.stations: list[Station] = [*self.substations, *sorted(supply.section_cabins, key=lambda cabin: cabin.id)]
        self.rows: dict[str, list[Feeder]] = {}
        for row in sorted(supply.feeders, key=lambda row: row.id):
            self.rows.setdefault(row.at, []).append(row)
        self.feeds = {station.id: self._fed_places(station) for station in self.stations}
        self.drains = {station.id: self._drained_places(station) for station in self.substations}
        self.bonds = [*self._bond_places()]

    def build(self) -> Topology:
        self.topology = lay_spans(self.supply, self.line, self.conductors, [*self._places()])
        self.nodes, self.joins = self.topology.nodes, self.topology.joins
        self.bundle_of = {track: bundle for bundle in self.topology.bundles for track in bundle.tracks}
        self._find_cut_sides()
        self._join_contact_lines()
        for station in self.stations:
            self._add_station(station)
        self._add_switches()
        self._add_connections()
        self._add_bonds()
        self._add_earth()
        self._note_sections()
        return self.topology

    # -- places ---------------------------------------------------------------------------------------------------

    def _fed_places(self, station: Station) -> dict[str, float]:
        """Return the kilometre at which a station meets the contact line of each of its tracks."""
        places = dict.fromkeys(tracks_at(self.axes, station.km, station.tracks), station.km)
        for row in self.rows.get(station.id, ()):
            if row.km is not None and row.track in self.axes and row.side != "return":
                places[row.track] = row.km
        return dict(sorted(places.items()))

    def _drained_places(self, station: Substation) -> dict[str, float]:
        """Return the kilometre at which a substation meets the rails of each of its tracks: where it feeds, if no row says."""
        places = dict(self.feeds[station.id])
        for row in self.rows.get(station.id, ()):
            if row.km is not None and row.track in self.axes and row.side == "return":
                places[row.track] = row.km
        return dict(sorted(places.items()))

    def _bond_places(self) -> Iterator[tuple[float, tuple[str, ...], float]]:
        for bonds in self.supply.bonds:
            count = int((bonds.to_km - bonds.from_km + SHARED_KM) / bonds.every_km)
            for k in range(count + 1):
                km = bonds.from_km + k * bonds.every_km
                yield km, tuple(sorted(tracks_at(self.axes, km, bonds.tracks))), bonds.resistance_ohm

    def _places(self) -> Iterator[tuple[str, float]]:
        """Yield the places of all devices."""
        supply = self.supply
        for places in (*self.feeds.values(), *self.drains.values()):
            yield from places.items()
        for point in supply.section_points:
            yield point.track, point.km
        for switch in supply.switches:
            for end in (switch.from_, switch.to):
                if end.track is not None and end.km is not None:
                    yield end.track, end.km
        for connection in self.line.connections:
            for place in (connection.from_, connection.to):
                yield place.track, place.km
        for km, tracks, _ in self.bonds:
            yield from ((track, km) for track in tracks)
        yield from ((item.track, item.km) for item in supply.earthing if item.track is not None and item.km is not None)
        yield from ((device.track, device.km) for device in supply.voltage_limiting_devices)

    def _cut(self, track: str, km: float) -> tuple[Bundle, int]:
        bundle = self.bundle_of[track]
        return bundle, bundle.cut(km)

    def _sides(self, track: str, km: float) -> dict[str, int]:
        """Return the ends of the contact line at a place by their side."""
        bundle, cut = self._cut(track, km)
        return {side: self.nodes(side, track, cut) for side in bundle.sides(track, cut)}

    def _rails(self, track: str, km: float) -> int | None:
        """Return a node of the rails of a track at a place."""
        bundle, cut = self._cut(track, km)
        found = bundle.rails_at(track, cut)
        return self.nodes("rail", found[0].number, bundle.tracks, cut) if found else None

    # -- contact lines --------------------------------------------------------------------------------------------

    def _find_cut_sides(self) -> None:
        """Find where contact lines are cut, and where they may be cut in another state."""
        self.separated: set[tuple[str, int]] = set()
        self.isolated: set[tuple[str, int]] = set()  # cut, and not by feeders that join both sides
        self.separable: set[tuple[str, int]] = set()
        for station in self.stations:
            for track, km in self.feeds[station.id].items():
                self._separate(track, km, station.state != "bypassed", station.state == "open")
        for point in self.supply.section_points:
            self._separate(point.track, point.km, point.state == "open", point.state == "open")

    def _separate(self, track: str, km: float, now: bool, isolates: bool) -> None:
        place = track, self._cut(track, km)[1]
        self.separable.add(place)
        if now:
            self.separated.add(place)
        if isolates:
            self.isolated.add(place)

    def _join_contact_lines(self) -> None:
        for bundle in self.topology.bundles:
            for track in bundle.tracks:
                for cut in range(len(bundle.cuts)):
                    if len(bundle.sides(track, cut)) == 2 and (track, cut) not in self.separated:
                        self.joins.append((self.nodes(LOW, track, cut), self.nodes(HIGH, track, cut)))

    # -- substations and section cabins ---------------------------------------------------------------------------

    def _add_station(self, station: Station) -> None:
        in_network = station.state in _TIES
        positive = self.nodes("positive", station.id)
        kind = "feeder" if isinstance(station, Substation) else "cabin"
        rows: dict[tuple[str, str], Feeder] = {(row.track, row.side): row for row in self.rows.get(station.id, ())}
        own = tracks_at(self.axes, station.km, station.tracks)
        for track, km in self.feeds[station.id].items():
            for side, node in self._sides(track, km).items():
                row = rows.get((track, side))
                if row is None and track not in own:  # to another line lead the feeders that are named
                    continue
                ohm = station.feeder_resistance_ohm
                closed = in_network
                if row is not None:
                    ohm, closed = cable_resistance(row, self.conductors, ohm), in_network and row.state == "closed"
                name = feeder_id(station.id, track, side)
                self.topology.links.append(Link(kind, name, station.id, track, side, km, positive, node, ohm, closed))
        if isinstance(station, Substation):
            self._add_return(station, rows, in_network)

    def _add_return(self, station: Substation, rows: dict[tuple[str, str], Feeder], in_network: bool) -> None:
        """Join the rails with the negative busbar; they stay joined whatever the state of the contact lines."""
        positive, negative = self.nodes("positive", station.id), self.nodes("negative", station.id)
        common = self.nodes("return", station.id)
        if in_network:
            self.topology.busbars[station.id] = Busbar(positive, negative)
        if station.return_resistance_ohm < SHORT_OHM:
            self.joins.append((common, negative))
        else:
            self.topology.returns.append((common, negative, station.return_resistance_ohm))
        for track, km in self.drains[station.id].items():
            rail, row = self._rails(track, km), rows.get((track, "return"))
            if rail is None:
                continue
            if row is None:
                self.joins.append((common, rail))
            else:
                ohm, closed = cable_resistance(row, self.conductors, station.return_resistance_ohm), row.state == "closed"
                self.topology.links.append(Link("return", row.id, station.id, track, "return", km, rail, negative, ohm, closed))

    # -- switches, junctions, bonds, earth ------------------------------------------------------------------------

    def _add_switches(self) -> None:
        for switch in sorted(self.supply.switches, key=lambda switch: switch.id):
            ends = self._switch_end(switch.from_), self._switch_end(switch.to)
            track, km = switch.from_.track or "", switch.from_.km or 0.0
            closed = switch.state == "closed"
            self.topology.links.append(Link("switch", switch.id, "", track, "", km, *ends, switch.resistance_ohm, closed))

    def _switch_end(self, end: SwitchEnd) -> int:
        if end.busbar is not None:
            return self.nodes("positive", end.busbar)
        assert end.track is not None  # the model allows no other end
        assert end.km is not None
        sides = self._sides(end.track, end.km)
        return sides[end.side] if end.side in sides else next(iter(sides.values()))

    def _add_connections(self) -> None:
        """Join what lies on both sides of each connection; a contact line that is cut there is joined by feeders only."""
        for connection in self.line.connections:
            ends = [(place.track, place.km) for place in (connection.from_, connection.to)]
            rails = [self._rails(*end) for end in ends]
            if rails[0] is not None and rails[1] is not None:
                self.joins.append((rails[0], rails[1]))
            sides = [[*self._sides(*end).values()] for end in ends]
            if all(sides) and not self._is_cut(ends, sides):
                self.joins.append((sides[0][0], sides[1][0]))

    def _is_cut(self, ends: list[tuple[str, float]], sides: list[list[int]]) -> bool:
        """Tell whether a device cuts the contact line at a connection: on the way of a track, or between two ends of tracks.

        A substation or cabin that ties one end only has its feeder to both; what is open there separates them.
        """
        places = [(track, self._cut(track, km)[1]) for track, km in ends]
        separated = [place in self.separated for place in places]
        on_the_way = any(cut and len(found) > 1 for cut, found in zip(separated, sides, strict=True))
        return on_the_way or all(separated) or not self.isolated.isdisjoint(places)

    def _add_bonds(self) -> None:
        for km, tracks, ohm in self.bonds:
            rails = [rail for track in tracks if (rail := self._rails(track, km)) is not None]
            for first, second in pairwise(rails):
                if ohm < SHORT_OHM:
                    self.joins.append((first, second))
                elif first != second:
                    self.topology.bonds.append((first, second, ohm))

    def _add_earth(self) -> None:
        for item in sorted(self.supply.earthing, key=lambda item: item.id):
            if item.substation is not None:
                node: int | None = self.nodes("negative", item.substation)
            else:
                assert item.track is not None  # the model allows no other earthing
                assert item.km is not None
                node = self._rails(item.track, item.km)
            if node is not None:
                self.nodes(EARTH)
                self.topology.earth_links.append(EarthLink(item.id, node, item.resistance_ohm, True))
        for device in sorted(self.supply.voltage_limiting_devices, key=lambda device: device.id):
            node = self._rails(device.track, device.km)
            if node is not None:
                self.nodes(EARTH)
                ohm, closed = device.closed_resistance_ohm, device.state == "closed"
                self.topology.earth_links.append(EarthLink(device.id, node, ohm, closed))

    def _note_sections(self) -> None:
        """Note the places between which the voltage runs straight: both sides of a cut where they can differ."""
        for bundle in self.topology.bundles:
            for track in bundle.tracks:
                for cut, km in enumerate(bundle.cuts):
                    sides, rails = bundle.sides(track, cut), bundle.rails_at(track, cut)
                    if len(sides) == 2 and (track, cut) not in self.separable:
                        sides = sides[:1]
                    for side in sides:
                        beside = rails[0] if side == LOW else rails[-1]
                        rail = self.nodes("rail", beside.number, bundle.tracks, cut)
                        self.topology.sections.append(Section(track, km, self.nodes(side, track, cut), rail))
