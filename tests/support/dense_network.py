"""The nodal matrix of a supply, straight from the declared rows, for the dense reference.

Nothing of `tractionpower.kernels` or of the topology is used: nodes are named by a simple walk over the rows, every piece
of leaky rail is a two-port whose chain matrix comes from doubling a very short one.

Like the solver, it lets devices less than 1 m apart share a node: a load next to a fixed cross-section, and loads next
to the first of a group of loads on the same conductor.
"""

from itertools import pairwise

import numpy as np
from dense_places import SHARED_KM, Groups, Places

from tractionpower.model.limits import system_voltages

EARTH = ("earth",)
TIES = {"in_service", "rectifiers_out", "closed"}
"""States of substations and cabins in which their busbar is in the network."""

SHORT_OHM = 1e-6
DOUBLINGS = 14


def two_port(ohm, siemens):
    """Return series conductance and shunt conductance of each end of a leaky conductor [S].

    The chain matrix [[1 + a, b], [c, 1 + a]] of its 2**14th part, by its series, is doubled fourteen times; the unit matrix
    is kept apart, so that a short piece keeps all its digits. Without resistance the series conductance is infinite.
    """
    if ohm < SHORT_OHM:
        return np.inf, 0.5 * siemens
    if siemens == 0.0:
        return 1.0 / ohm, 0.0
    part = 0.5**DOUBLINGS
    b, c = ohm * part, siemens * part
    a = 0.5 * b * c
    b, c = b * (1.0 + a / 3.0), c * (1.0 + a / 3.0)
    for _ in range(DOUBLINGS):
        a, b, c = 2.0 * a + a * a + b * c, 2.0 * b * (1.0 + a), 2.0 * c * (1.0 + a)
    return 1.0 / b, a / b


class DenseNetwork:
    """Nodal matrix and ports of a supply.

    Attributes
    ----------
    g
        Nodal matrix of all wires [S], singular: every row sums to zero.
    source, load
        Positive and negative node of each port, by identifier; shape (n, 2).
    live
        Whether wires and sources connect both sides of a load. What hangs elsewhere floats: its voltage means nothing.
    part, earthed
        Number of the part of the network of each node, and whether that part is referred to remote earth.
    """

    def __init__(self, supply, line, limits):
        self.voltages = system_voltages(limits, supply.system)
        self.supply, self.line = supply, line
        self.places = Places(supply, line)
        self.one = Groups()
        self.wires, self.joins, self.links = [], [], {}
        self.rows = {(row.at, row.track, row.side): row for row in supply.feeders}
        self._find_separations()
        self._string_contact_lines()
        self._lay_rails()
        self._connect_stations()
        self._connect_switches()
        self._connect_rails()
        self._number()

    # -- wires

    def _wire(self, first, second, ohm):
        if ohm < SHORT_OHM:
            self._join(first, second)
        else:
            self.wires.append((first, second, 1.0 / ohm))

    def _join(self, first, second):
        self.one.join(first, second)
        self.joins.append((first, second))

    def _link(self, name, first, second, ohm):
        """Connect two nodes by what has a breaker or a switch; its current is counted from the first to the second."""
        self.links[name] = first, second, ohm
        self._wire(first, second, ohm)

    def _leaky_wire(self, first, second, ohm, siemens):
        series, shunt = two_port(ohm, siemens)
        self._wire(first, second, 1.0 / series)
        if siemens > 0.0:
            self.wires += [(first, EARTH, shunt), (second, EARTH, shunt)]

    def _find_separations(self):
        places, self.separated, self.isolated = self.places, set(), set()
        for station in (*self.supply.substations, *self.supply.section_cabins):
            if station.state != "bypassed":
                cuts = {(track, places.cut(track, km)) for track, km in places.fed(station)}
                self.separated |= cuts
                self.isolated |= cuts if station.state == "open" else set()
        for point in self.supply.section_points:
            if point.state == "open":
                self.separated.add((point.track, places.cut(point.track, point.km)))
                self.isolated.add((point.track, places.cut(point.track, point.km)))

    def _string(self, track, piece, constants, loads, names):
        """Lay one conductor between two cuts with its loads; return the node of each load."""
        way, low, high = self.places.way_km, *piece
        at, last, last_km = {}, names[0], low
        for load in sorted(loads, key=lambda load: load.km):
            if way(track, low, load.km) < SHARED_KM:
                at[load.id] = names[0]
            elif way(track, load.km, high) < SHARED_KM:
                at[load.id] = names[1]
            else:
                if last == names[0] or way(track, last_km, load.km) >= SHARED_KM:
                    node = ("load", names, load.id)
                    self._leaky_wire(last, node, *(x * way(track, last_km, load.km) for x in constants))
                    last, last_km = node, load.km
                at[load.id] = last
        self._leaky_wire(last, names[1], *(x * way(track, last_km, high) for x in constants))
        return at

    def _string_contact_lines(self):
        self.contact_at, places = {}, self.places
        self.piece = {load.id: places.piece(load.track, load.km) for load in self.supply.loads}
        for track, pieces in places.pieces.items():
            for km in places.cuts[track]:
                sides = places.sides(track, km)
                if len(sides) == 2 and (track, km) not in self.separated:
                    self._join(*sides)
            for low, high in pieces:
                ohm = places.contact_ohm(track, 0.5 * (low + high))
                here = [load for load in self.supply.loads if load.track == track and self.piece[load.id] == (low, high)]
                names = ("high_km", track, low), ("low_km", track, high)
                self.contact_at |= self._string(track, (low, high), (ohm, 0.0), here, names)

    def _lay_rails(self):
        self.rail_at = {}
        for number, (tracks, start, end, ohm, siemens) in enumerate(self.places.rail_rows):
            first, last = (self.places.cut(tracks[0], km) for km in (start, end))
            cuts = [cut for cut in self.places.cuts[tracks[0]] if first <= cut <= last]
            for low, high in pairwise(cuts):
                here = [load for load in self.supply.loads if load.track in tracks and self.piece[load.id] == (low, high)]
                names = ("rail", number, low), ("rail", number, high)
                self.rail_at |= self._string(tracks[0], (low, high), (ohm, siemens), here, names)

    def rail(self, track, km):
        """Return a node of the rails of a track at a place, None where it has no rails."""
        numbers = self.places.rails(track, km)
        return ("rail", numbers[0], self.places.cut(track, km)) if numbers else None

    # -- stations, feeders, switches

    def busbar(self, name):
        """Return the positive busbar of a substation or cabin, None where it is not in the network."""
        stations = (*self.supply.substations, *self.supply.section_cabins)
        return ("positive", name) if any(s.id == name and s.state in TIES for s in stations) else None

    def _connect_stations(self):
        for station in (*self.supply.substations, *self.supply.section_cabins):
            for track, km in self.places.fed(station):
                if station.state in TIES:
                    self._connect_feeders(station, track, km)
        for station in self.supply.substations:
            self._connect_return(station)

    def _connect_feeders(self, station, track, km):
        distant = km != station.km or track not in self.places.tracks_of(station)
        for node in self.places.sides(track, km):
            row = self.rows.get((station.id, track, node[0]))
            if (row is None and distant) or (row is not None and row.state == "open"):
                continue
            given = row is not None and row.resistance_ohm is not None
            ohm = row.resistance_ohm if given else station.feeder_resistance_ohm
            self._link(f"{station.id} {track} {node[0]}", ("positive", station.id), node, ohm)

    def _connect_return(self, station):
        """Join the rails with the negative busbar; what is switched in the contact lines leaves them as they are."""
        common, negative = ("return", station.id), ("negative", station.id)
        for track, km in self.places.fed(station):
            row, rail = self.rows.get((station.id, track, "return")), self.rail(track, km)
            if rail is None:
                continue
            if row is None:
                self._join(common, rail)
            elif row.state == "closed":
                ohm = station.return_resistance_ohm if row.resistance_ohm is None else row.resistance_ohm
                self._link(f"{station.id} {track} return", rail, negative, ohm)
        self._wire(negative, common, station.return_resistance_ohm)

    def switch_node(self, end):
        """Return what an end of a switch is connected to, None where there is nothing."""
        if end.busbar is not None:
            return self.busbar(end.busbar)
        sides = self.places.sides(end.track, end.km)
        return next((node for node in sides if end.side in (None, node[0])), None)

    def _connect_switches(self):
        for switch in self.supply.switches:
            first, second = self.switch_node(switch.from_), self.switch_node(switch.to)
            if switch.state == "closed" and first is not None and second is not None:
                self._link(switch.id, first, second, switch.resistance_ohm)
        for connection in self.line.connections:
            self._connect_tracks(connection.from_, connection.to)

    def _connect_tracks(self, *ends):
        """Join rails, and contact lines but where one is cut on its way, one ends at what is open, or both end at devices."""
        rails = [self.rail(end.track, end.km) for end in ends]
        if None not in rails:
            self._join(*rails)
        sides = [self.places.sides(end.track, end.km) for end in ends]
        cuts = [(end.track, self.places.cut(end.track, end.km)) for end in ends]
        on_the_way = any(len(found) == 2 and cut in self.separated for found, cut in zip(sides, cuts, strict=True))
        if all(sides) and not on_the_way and not self.isolated & {*cuts} and not {*cuts} <= self.separated:
            self._join(sides[0][0], sides[1][0])

    # -- rails and earth

    def _connect_rails(self):
        for track, cuts in self.places.cuts.items():
            for km in cuts:
                numbers = self.places.rails(track, km) if self.places.exists(track, km) else ()
                for number in numbers:
                    self._join(("rail", numbers[0], km), ("rail", number, km))
        for ohm, places in self.places.bonded():
            for first, second in pairwise(places):
                self._wire(self.rail(*first), self.rail(*second), ohm)
        for item in self.supply.earthing:
            node = ("negative", item.substation) if item.substation else self.rail(item.track, item.km)
            self.wires.append((node, EARTH, 1.0 / item.resistance_ohm))
        for device in self.supply.voltage_limiting_devices:
            if device.state == "closed":
                self.wires.append((self.rail(device.track, device.km), EARTH, 1.0 / device.closed_resistance_ohm))

    # -- nodes and ports

    def load_node(self, load):
        """Return the nodes of a load on contact line and rail."""
        return self.contact_at[load.id], self.rail_at[load.id]

    def _number(self):
        supply, find = self.supply, self.one.find
        self.sources = sorted((s for s in supply.substations if s.feeds and self._has_return(s)), key=lambda s: s.id)
        self.loads = sorted(supply.loads, key=lambda load: load.id)
        ports = [(("positive", s.id), ("negative", s.id)) for s in self.sources] + [self.load_node(load) for load in self.loads]
        names = {find(node) for wire in self.wires for node in wire[:2]} | {find(node) for port in ports for node in port}
        self.index = {name: k for k, name in enumerate(sorted(names, key=repr))}
        n = len(self.index)
        self.g = np.zeros((n, n))
        whole, powered = Groups(), Groups()
        for first, second, s in self.wires:
            i, j = self.node(first), self.node(second)
            self.g[[i, j, i, j], [i, j, j, i]] += [s, s, -s, -s] if i != j else 0.0
            whole.join(i, j)
            powered.join(i, j)
        port = np.array([[self.node(a), self.node(b)] for a, b in ports], int).reshape(-1, 2)
        self.source, self.load = port[: len(self.sources)], port[len(self.sources) :]
        for i, j in self.source:
            powered.join(int(i), int(j))
        self.live = np.array([powered.find(int(i)) == powered.find(int(j)) for i, j in self.load], bool)
        self.part = [powered.find(k) for k in range(n)]
        self.fed = np.isin(self.part, [self.part[i] for i, _ in self.source])
        self.wire_part = [whole.find(k) for k in range(n)]
        self.earth = self.node(EARTH)
        self.earthed = np.array([self.earth >= 0 and p == self.part[self.earth] for p in self.part], bool)
        busbars = [(self.wire_part[i], s) for s, (i, _) in zip(self.sources, self.source, strict=True)]
        self.no_load = np.array([
            max([s.no_load_voltage_v * s.grid_voltage_pu for p, s in busbars if p == mine], default=0.0)
            for mine in self.wire_part
        ])  # fmt: skip

    def _has_return(self, station):
        """Tell whether wires join the negative busbar with rails."""
        joined = Groups()
        for first, second, _ in self.wires:
            joined.join(self.one.find(first), self.one.find(second))
        rails = {joined.find(self.one.find(name)) for name in self.one.label if name[0] == "rail"}
        rails |= {joined.find(self.one.find(node)) for wire in self.wires for node in wire[:2] if node[0] == "rail"}
        return joined.find(self.one.find(("negative", station.id))) in rails

    def node(self, name):
        """Return the number of a node by its name, -1 if no wire and no port touches it."""
        return self.index.get(self.one.find(name), -1)

    def link_a(self, name, v, load_a):
        """Return the current of a feeder or switch at the potentials `v` [A], None where it is not to be told.

        Without a resistance of its own, a feeder carries what the contact line and the loads behind it take.
        """
        first, second, ohm = self.links[name]
        if ohm >= SHORT_OHM:
            return (v[self.node(first)] - v[self.node(second)]) / ohm
        if first[0] != "positive" or second[0] not in {"low_km", "high_km"} or sum(second in pair for pair in self.joins) > 1:
            return None
        ends = [(a, b, s) if a == second else (b, a, s) for a, b, s in self.wires if second in (a, b)]
        line_a = sum(s * (v[self.node(a)] - v[self.node(b)]) for a, b, s in ends)
        return line_a + sum(i for load, i in zip(self.loads, load_a, strict=True) if self.contact_at[load.id] == second)
