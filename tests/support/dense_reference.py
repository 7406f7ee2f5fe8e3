"""An independent solver for small DC networks: dense nodal analysis straight from the declared model.

Nothing of `tractionpower.kernels` or of the topology is used: nodes are numbered by a simple walk over the declared
rows, the nodal matrix is dense, the currents of the ports are plain formulas and the method is a descent with modified
eigenvalues. It is slow and simple; what it finds, the solver must find.

Like the solver, it lets devices less than 1 m apart share a node: a load next to a fixed cross-section, and loads next
to the first of a group of loads on the same conductor.
"""

from itertools import pairwise

import numpy as np

from tractionpower.model.limits import system_voltages

SHARED_KM = 0.001
BLOCKED_S = 1e-9
CEILING_RAMP_V = 1e-3
STEP_V = 300.0
ROUNDING = 64.0 * np.finfo(float).eps
"""Share of the absolute currents of a node that may be left over by rounding."""


class NoSolutionError(Exception):
    """The reference found no solution."""


class Groups:
    """Sets of things that turn out to be one."""

    def __init__(self):
        self.label = {}

    def find(self, thing):
        while (above := self.label.setdefault(thing, thing)) != thing:
            thing = above
        return thing

    def join(self, first, second):
        self.label[self.find(second)] = self.find(first)


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
    """

    def __init__(self, supply, line, limits):
        self.voltages = system_voltages(limits, supply.system)
        self.supply = supply
        self.ends = {track.id: (track.from_km, track.to_km) for track in line.tracks}
        self.one = Groups()
        self.wires = []
        self.contact_rows = [
            (track, max(row.from_km, self.ends[track][0]), min(row.to_km, self.ends[track][1]), row.resistance_ohm_per_km)
            for row in supply.contact_lines
            for track in (row.tracks or self.ends)
        ]
        self.rail_rows = [
            (set(row.tracks or self.ends), row.from_km, row.to_km, row.resistance_ohm_per_km) for row in supply.return_circuit
        ]
        self._find_cuts()
        self._find_separations()
        self._string_contact_lines()
        self._lay_rails()
        self._connect_devices()
        self._number()

    # -- places

    def _exists(self, track, km):
        low, high = self.ends[track]
        return low <= km <= high

    def _tracks_of(self, device):
        if hasattr(device, "track"):
            return [device.track]
        return [track for track in (device.tracks or self.ends) if self._exists(track, device.km)]

    def _find_cuts(self):
        """Places where something happens on a track or on one that shares its rails."""
        bundle = Groups()
        for tracks, *_ in self.rail_rows:
            for track in tracks:
                bundle.join(min(tracks), track)
        kms = {track: set() for track in self.ends}
        supply = self.supply
        for device in (*supply.substations, *supply.section_cabins, *supply.section_points):
            for track in self._tracks_of(device):
                kms[track].add(device.km)
        for track, low, high, _ in self.contact_rows:
            kms[track] |= {low, high}
        for tracks, low, high, _ in self.rail_rows:
            first = min(tracks)
            kms[first].add(max(low, min(self.ends[track][0] for track in tracks)))
            kms[first].add(min(high, max(self.ends[track][1] for track in tracks)))
        self.cuts = {
            track: sorted(set().union(*(kms[other] for other in kms if bundle.find(other) == bundle.find(track))))
            for track in self.ends
        }

    def _contact_ohm(self, track, km):
        return next((ohm for name, low, high, ohm in self.contact_rows if name == track and low < km < high), None)

    def _sides(self, track, km):
        """Nodes of the contact line just below and just above a cut, where it exists."""
        cuts = [cut for cut in self.cuts[track] if self._exists(track, cut)]
        at = cuts.index(km)
        sides = []
        if at > 0 and self._contact_ohm(track, 0.5 * (cuts[at - 1] + km)) is not None:
            sides.append(("low", track, km))
        if at + 1 < len(cuts) and self._contact_ohm(track, 0.5 * (km + cuts[at + 1])) is not None:
            sides.append(("high", track, km))
        return sides

    def _find_separations(self):
        self.separated = set()
        supply = self.supply
        for device in (*supply.substations, *supply.section_cabins, *supply.section_points):
            if device.state in {"in_service", "rectifiers_out"} or device.state == "open":
                self.separated |= {(track, device.km) for track in self._tracks_of(device)}

    def load_node(self, load):
        """Return the nodes of a load on contact line and rail as left behind by `_string_contact_lines`, `_lay_rails`."""
        return self.contact_at[load.id], self.rail_at[load.id]

    # -- wires

    def _wire(self, first, second, ohm):
        if ohm < 1e-6:
            self.one.join(first, second)
        else:
            self.wires.append((first, second, 1.0 / ohm))

    def _string(self, low, high, ohm_per_km, loads, names):
        """Lay one conductor between two cuts with its loads; return the node of each load."""
        at, last, last_km = {}, names[0], low
        for load in sorted(loads, key=lambda load: load.km):
            if load.km - low < SHARED_KM:
                at[load.id] = names[0]
            elif high - load.km < SHARED_KM:
                at[load.id] = names[1]
            else:
                if last == names[0] or load.km - last_km >= SHARED_KM:
                    node = ("load", names, load.id)
                    self._wire(last, node, ohm_per_km * (load.km - last_km))
                    last, last_km = node, load.km
                at[load.id] = last
        self._wire(last, names[1], ohm_per_km * (high - last_km))
        return at

    def _pieces(self, track):
        cuts = [cut for cut in self.cuts[track] if self._exists(track, cut)]
        return [piece for piece in pairwise(cuts) if self._contact_ohm(track, 0.5 * sum(piece)) is not None]

    def _string_contact_lines(self):
        self.contact_at, self.piece = {}, {}
        for track in self.ends:
            loads = [load for load in self.supply.loads if load.track == track]
            for cut in self.cuts[track]:
                if self._exists(track, cut):
                    sides = self._sides(track, cut)
                    if len(sides) == 2 and (track, cut) not in self.separated:
                        self.one.join(*sides)
            for low, high in self._pieces(track):
                ohm = self._contact_ohm(track, 0.5 * (low + high))
                here = [load for load in loads if load.id not in self.contact_at and low <= load.km <= high]
                self.piece |= {load.id: (low, high) for load in here}
                self.contact_at |= self._string(low, high, ohm, here, (("high", track, low), ("low", track, high)))

    def _lay_rails(self):
        self.rail_at = {}
        for number, (tracks, first, last, ohm) in enumerate(self.rail_rows):
            start = max(first, min(self.ends[t][0] for t in tracks))
            end = min(last, max(self.ends[t][1] for t in tracks))
            cuts = [cut for cut in self.cuts[min(tracks)] if start <= cut <= end]
            for low, high in pairwise(cuts):
                here = [load for load in self.supply.loads if load.track in tracks and self.piece[load.id] == (low, high)]
                names = ("rail", number, low), ("rail", number, high)
                self.rail_at |= self._string(low, high, ohm, here, names)

    def _rails(self, tracks, km):
        return [
            ("rail", number, km)
            for number, (members, low, high, _) in enumerate(self.rail_rows)
            if members & set(tracks) and low <= km <= high
        ]

    # -- devices

    def _connect_devices(self):
        for track in self.ends:
            for cut in self.cuts[track]:
                if self._exists(track, cut):
                    rails = self._rails([track], cut)
                    for rail in rails:
                        self.one.join(rails[0], rail)
        self._connect_substations()
        for cabin in self.supply.section_cabins:
            if cabin.state == "closed":
                for track in self._tracks_of(cabin):
                    for side in self._sides(track, cabin.km):
                        self.one.join(("cabin", cabin.id), side)

    def _connect_substations(self):
        self.busbar = {}
        for station in self.supply.substations:
            tracks = self._tracks_of(station)
            for rail in self._rails(tracks, station.km):
                self.one.join(("return", station.id), rail)
            if station.state not in {"in_service", "rectifiers_out"}:
                continue
            positive, negative = ("positive", station.id), ("negative", station.id)
            self.busbar[station.id] = positive, negative
            self._wire(negative, ("return", station.id), station.return_resistance_ohm)
            for track in tracks:
                for side in self._sides(track, station.km):
                    self._wire(positive, side, station.feeder_resistance_ohm)

    def _number(self):
        supply, find = self.supply, self.one.find
        self.sources = sorted((s for s in supply.substations if s.state == "in_service"), key=lambda s: s.id)
        self.loads = sorted(supply.loads, key=lambda load: load.id)
        ports = [self.busbar[s.id] for s in self.sources] + [self.load_node(load) for load in self.loads]
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
        part = [powered.find(k) for k in range(n)]
        self.fed = np.isin(part, [part[i] for i, _ in self.source])
        self.wire_part = [whole.find(k) for k in range(n)]
        busbars = [(self.wire_part[i], s) for s, (i, _) in zip(self.sources, self.source, strict=True)]
        self.no_load = np.array([
            max([s.no_load_voltage_v * s.grid_voltage_pu for p, s in busbars if p == mine], default=0.0)
            for mine in self.wire_part
        ])  # fmt: skip
        self.part = part

    def node(self, name):
        """Return the number of a node by its name, -1 if no wire and no port touches it."""
        return self.index.get(self.one.find(name), -1)


class Ports:
    """Currents that the ports take, by the formulas of the physics document; sources first."""

    def __init__(self, network):
        voltages, loads = network.voltages, network.loads
        self.e = np.array([s.no_load_voltage_v * s.grid_voltage_pu for s in network.sources])
        self.r = np.array([s.internal_resistance_ohm for s in network.sources])
        self.both = np.array([s.conducts == "both" for s in network.sources], bool)
        self.p = np.array([0.0 if load.power_kw is None else 1e3 * load.power_kw for load in loads])
        self.i = np.array([load.current_a or 0.0 for load in loads])
        self.free = np.array([load.limits == "none" for load in loads], bool)
        self.low = np.where(self.free, 0.05 * voltages.u_n, voltages.u_min2)
        self.high = np.where(self.free | (self.p + self.i > 0.0), np.inf, voltages.u_max2)
        self.fold = np.array([min(load.fold_back_from_v or voltages.u_max1, voltages.u_max2 - CEILING_RAMP_V) for load in loads])
        self.fold = np.where(np.isinf(self.high), np.inf, self.fold)
        self.ceiling = 5.0 * voltages.u_max2

    def sources(self, u):
        """Return currents taken (negative: given) and slopes."""
        conducting = self.both | (u <= self.e)
        slope = np.where(conducting, 1.0 / self.r, BLOCKED_S)
        return slope * (u - self.e), slope

    def demands(self, u):
        """Return currents taken and slopes of the loads."""
        safe = np.maximum(u, self.low)
        i, slope = self.i + self.p / safe, -self.p / safe**2
        taking = self.p + self.i > 0.0
        below = (u < self.low) | (taking & (u <= self.low))
        at_low = (self.i + self.p / self.low) / self.low
        with np.errstate(invalid="ignore"):
            share = np.where(u >= self.fold, (self.high - u) / (self.high - self.fold), 1.0)
            bend = np.where(u >= self.fold, -1.0 / (self.high - self.fold), 0.0)
        i, slope = i * share, slope * share + i * bend
        i, slope = np.where(below, at_low * u, i), np.where(below, at_low, slope)
        off = (u <= 0.0) & ~((u == 0.0) & taking) | (u > self.high)
        return np.where(off, 0.0, i), np.where(off, 0.0, slope)


class DenseSolver:
    """Finds the potentials of the part of a network that sources feed."""

    def __init__(self, network):
        self.network, self.ports = network, Ports(network)
        n = len(network.index)
        ground = {}
        for p, (_, j) in zip([network.part[i] for i, _ in network.source], network.source, strict=True):
            ground.setdefault(p, int(j))
        self.free = np.array([k for k in range(n) if network.fed[k] and ground[network.part[k]] != k], int)
        pairs = [*network.source, *network.load[network.live]]
        incidence = np.zeros((len(pairs), n))
        for k, (i, j) in enumerate(pairs):
            incidence[k, i] += 1.0
            incidence[k, j] -= 1.0
        self.a = incidence[:, self.free]
        self.g = network.g[np.ix_(self.free, self.free)]
        self.start = network.no_load[self.free]

    def currents(self, u, factor):
        """Return currents and slopes of all live ports, the demand multiplied by `factor`."""
        sources = len(self.ports.e)
        everywhere = np.zeros(len(self.network.load))
        everywhere[self.network.live] = u[sources:]
        i, g = self.ports.demands(everywhere)
        live = self.network.live
        source_i, source_g = self.ports.sources(u[:sources])
        return np.concatenate([source_i, factor * i[live]]), np.concatenate([source_g, factor * g[live]])

    def _gradient(self, v, factor):
        return self.g @ v + self.a.T @ self.currents(self.a @ v, factor)[0]

    def _direction(self, f, slopes):
        h = self.g + (self.a.T * slopes) @ self.a
        try:
            np.linalg.cholesky(h)
            return np.linalg.solve(h, -f)
        except np.linalg.LinAlgError:
            values, vectors = np.linalg.eigh(h)
            values = np.maximum(np.abs(values), 1e-6 * np.max(np.diag(self.g), initial=1e-3))
            return -vectors @ ((vectors.T @ f) / values)

    def descend(self, v, factor, most=400):
        """Return the potentials where the descent from `v` ends; they balance to rounding."""
        best, stalled = np.inf, 0
        absolute, weights = np.abs(self.g), np.abs(self.a.T)
        for _ in range(most):
            u = self.a @ v
            i, slopes = self.currents(u, factor)
            f = self.g @ v + self.a.T @ i
            worst = np.max(np.abs(f), initial=0.0)
            stalled = 0 if worst < 0.5 * best else stalled + 1
            best = min(best, worst)
            if worst <= 1e-8:
                return v
            if stalled > 2 and np.all(np.abs(f) <= 1e-6 + ROUNDING * (absolute @ np.abs(v) + weights @ np.abs(slopes * u))):
                return v
            d = self._direction(f, slopes)
            longest = np.max(np.abs(d))
            v = v + self._length(v, d, min(1.0, STEP_V / longest), float(d @ f), factor) * d
        raise NoSolutionError(f"{worst} A are left")

    def _length(self, v, d, high, start, factor):
        """Return a length where the potential no longer falls steeply, by bisection on its derivative."""
        if float(d @ self._gradient(v + high * d, factor)) <= -0.5 * start:
            return high
        low = 0.0
        for _ in range(60):
            t = 0.5 * (low + high)
            fall = float(d @ self._gradient(v + t * d, factor))
            if abs(fall) <= -0.5 * start:
                break
            low, high = (t, high) if fall < 0.0 else (low, t)
        return t

    def solve(self):
        """Solve from no load at once, and along a rising common load factor; return the port voltages of both.

        Where only one of the two ends anywhere, the other is None.
        """
        found = []
        for factors in ((1.0,), (0.0, 0.3, 0.6, 0.8, 0.9, 1.0)):
            v = self.start
            try:
                for factor in factors:
                    v = self.descend(v, factor)
                found.append(self.a @ v)
            except NoSolutionError:
                found.append(None)
        return found

    def servable(self, u):
        """Tell whether all loads without limits sit at voltages where they are what they say."""
        network, ports = self.network, self.ports
        demand, live = u[len(ports.e) :], network.live
        free = ports.free[live]
        return bool(np.all(demand[free] >= ports.low[live][free]) and np.all(demand[free] <= ports.ceiling))


def balance(network, v, u):
    """Return what is left over in every node at the potentials `v` of all nodes and the voltages `u` of all ports [A]."""
    ports = Ports(network)
    left = network.g @ v
    sources = len(network.source)
    for pairs, i in ((network.source, ports.sources(u[:sources])[0]), (network.load, ports.demands(u[sources:])[0])):
        np.add.at(left, pairs[:, 0], i)
        np.subtract.at(left, pairs[:, 1], i)
    return left
