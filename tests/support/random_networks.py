"""Random supply systems, all of them valid, for the laws."""

import numpy as np
from dense_network import DenseNetwork
from random_lines import RandomLine
from random_switchgear import RandomSwitchgear

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.line import Line
from tractionpower.model.loads import Load
from tractionpower.model.supply import SectionCabin, SectionPoint, Substation, Supply

U_N = {"dc3000": 3000.0, "dc1500": 1500.0}
LIMITS = shipped_limits()


class Draw:
    """One random network with its supply, a function of the seed alone.

    A trunk of one to four tracks, in some draws with branches of their own kilometres: islands, trees, rings. Devices that
    cut conductors stand on a grid or at free places between, so that they coincide or lie well apart; loads stand anywhere,
    at the same place, less than 1 m from each other or from a device.
    """

    def __init__(self, *seed):
        self.rng = np.random.default_rng(seed)
        rng = self.rng
        self.system = "dc1500" if rng.random() < 0.15 else "dc3000"
        self.u_n = U_N[self.system]
        self.scale = self.u_n / 3000.0
        leaky, branched = rng.random() < 0.5, rng.random() < 0.4
        self.parts = [RandomLine(rng, 0, self.scale, leaky=leaky)]
        if branched:
            self.parts += [RandomLine(rng, k + 1, self.scale, leaky=leaky) for k in range(rng.integers(1, 4))]
        self.breaks = tuple(item for part in self.parts for item in part.breaks)
        self.connections = self._connections()
        tracks = tuple(track for part in self.parts for track in part.line_tracks)
        self.line = Line(tracks=tracks, connections=self.connections, chainage_breaks=self.breaks)

    def _connections(self):
        """Join each branch with the parts before it at no, one or two places; some tracks with a neighbour."""
        rng, found = self.rng, []
        for number, part in enumerate(self.parts):
            joints = int(rng.choice(3, p=[0.2, 0.5, 0.3])) if number else 0
            for k in range(joints):
                other = self.parts[rng.integers(number)]
                own, end = str(rng.choice(part.tracks)), (part.grid[0], part.grid[-1])[k]
                here = (own, end) if rng.random() < 0.7 and part.exists(own, end) else part.free_place(own)
                found.append((here, other.free_place()))
            if len(part.tracks) > 1 and rng.random() < 0.1:
                track, km = part.free_place()
                found += [((track, km), (t, km)) for t in part.tracks_at(km) if t != track][:1]
        return tuple(
            {"from": {"track": a, "km": x}, "to": {"track": b, "km": y}}
            for (a, x), (b, y) in found
        )  # fmt: skip

    def supply(self, loads=()):
        """Return the supply; it is drawn anew at every call."""
        rng, parts, self.taken = self.rng, self.parts, set()
        counts = [(rng.integers(1, 7), rng.integers(0, 5), rng.integers(0, 4))]
        counts += [(rng.integers(0, 3), rng.integers(0, 2), rng.integers(0, 2)) for _ in parts[1:]]
        where = [
            [part for part, count in zip(parts, row, strict=True) for _ in range(count)] for row in zip(*counts, strict=True)
        ]
        stations = tuple(self._substation(k, part) for k, part in enumerate(where[0]))
        cabins = tuple(self._cabin(k, part) for k, part in enumerate(where[1]))
        points = tuple(point for k, part in enumerate(where[2]) if (point := self._point(k, part)))
        gear = RandomSwitchgear(rng, parts, self.scale, stations, cabins, points)
        supply = Supply(
            system=self.system,
            substations=stations,
            section_cabins=cabins,
            section_points=points,
            contact_lines=tuple(row for part in parts for row in part.contact),
            return_circuit=tuple(row for part in parts for row in part.returns),
            bonds=tuple(row for part in parts for row in part.bonds),
            feeders=gear.feeders,
            switches=gear.switches,
            earthing=gear.earthing,
            voltage_limiting_devices=gear.limiters,
            loads=tuple(loads),
        )
        return without_short_loops(supply, self.line)

    # -- devices

    def _some_ohm(self, high):
        return 0.0 if self.rng.random() < 0.5 else float(self.rng.uniform(0.001, high))

    def _station_place(self, part):
        """Return a place without a busbar: feeders of two at one place could close a loop of no resistance."""
        km = part.grid_place()
        while km in self.taken:
            km = part.grid_place()
        self.taken.add(km)
        return km

    def _substation(self, k, part):
        rng = self.rng
        km = self._station_place(part)
        others = ["rectifiers_out", "bypassed", "open"]
        ohm, units = float(rng.uniform(0.02, 0.3) * self.scale), int(rng.choice([1, 1, 2, 4]))
        return Substation(
            id=f"S{k}",
            km=km,
            no_load_voltage_v=float(rng.choice([1.2, rng.uniform(1.05, 1.25)])) * self.u_n,
            internal_resistance_ohm=ohm,
            units=units,
            units_in_service=None if k == 0 or rng.random() < 0.6 else int(rng.integers(0, units + 1)),
            grid_resistance_ohm=ohm * float(rng.uniform(0.0, 0.5)) if rng.random() < 0.3 else 0.0,
            conducts="both" if rng.random() < 0.25 else "forward",
            state="in_service" if k == 0 or rng.random() < 0.7 else str(rng.choice(others)),
            feeder_resistance_ohm=self._some_ohm(0.05),
            return_resistance_ohm=self._some_ohm(0.03),
            grid_voltage_pu=1.0 if rng.random() < 0.8 else rng.uniform(0.95, 1.03),
            tracks=part.some_tracks(km),
        )

    def _cabin(self, k, part):
        km = self._station_place(part)
        state = str(self.rng.choice(["closed", "closed", "bypassed", "open"]))
        return SectionCabin(
            id=f"C{k}", km=km, state=state, tracks=part.some_tracks(km), feeder_resistance_ohm=self._some_ohm(0.02)
        )

    def _point(self, k, part):
        track = str(self.rng.choice(part.tracks))
        km = part.grid_place()
        if not part.exists(track, km):
            return None
        return SectionPoint(id=f"P{k}", track=track, km=km, state=str(self.rng.choice(["open", "closed"])))

    # -- loads

    def loads(self):
        """Return random loads: alone, in heaps, closer than a metre, all taking, all feeding back or mixed."""
        rng = self.rng
        count = int(rng.choice([0, 1, 2, 3, 5, 10, 20, 40]))
        total = float(rng.choice([0.5, 5.0, 20.0, 60.0])) * 1e3 * self.scale
        mode = rng.choice(["taking", "feeding", "mixed"])
        free = rng.random() < 0.2
        shares = rng.dirichlet(np.ones(count)) if count else ()
        places, loads = {part.number: [] for part in self.parts}, []
        for k, share in enumerate(shares):
            part = self.parts[0 if rng.random() < 0.6 else rng.integers(len(self.parts))]
            track, km = self._place(part, places[part.number])
            places[part.number].append(km)
            sign = {"taking": 1.0, "feeding": -1.0, "mixed": float(rng.choice([-1.0, 1.0]))}[mode]
            power = sign * total * float(share)
            kind = {"power_kw": power} if rng.random() < 0.8 else {"current_a": power * 1e3 / self.u_n}
            limits = "none" if free and rng.random() < 0.5 else "range"
            fold = None
            if limits == "range" and sign < 0.0 and rng.random() < 0.6:
                fold = self.u_n * float(rng.choice([1.3, rng.uniform(1.1, 1.29)]))
            loads.append(Load(id=f"L{k:02}", track=track, km=km, limits=limits, fold_back_from_v=fold, **kind))
        return tuple(loads)

    def _place(self, part, places):
        rng = self.rng
        row = part.contact[rng.integers(len(part.contact))]
        track = str(rng.choice(row.tracks or part.tracks))
        low, high = row.from_km, row.to_km
        how = rng.random()
        fixed = [km for km in (*part.grid, *(km for _, km in part.used)) if low <= km <= high]
        near = float(rng.choice(fixed))
        if how < 0.15 and places:
            near = float(rng.choice(places))
        elif how < 0.25 and places:
            near = float(rng.choice(places)) + rng.uniform(-0.0012, 0.0012)
        elif how < 0.35:
            near += rng.uniform(-0.0012, 0.0012)
        elif how > 0.4:
            near = rng.uniform(low, high)
        near = float(min(max(near, low), high))
        return track, near if part.is_place(near) else low


def without_short_loops(supply, line):
    """Return the supply with a resistance in every switch and bond that would close a loop of no resistance."""
    rows = {"switches": [], "bonds": []}
    for name, kept in rows.items():
        for row in getattr(supply, name):
            rest = supply.model_copy(update={"switches": (), "bonds": ()} | {key: tuple(done) for key, done in rows.items()})
            loop = row.resistance_ohm == 0.0 and closes_short_loop(DenseNetwork(rest, line, LIMITS), name, row)
            kept.append(row.model_copy(update={"resistance_ohm": 0.01}) if loop else row)
    return supply.model_copy(update={name: tuple(kept) for name, kept in rows.items()})


def closes_short_loop(network, name, row):
    """Tell whether nodes that a switch or bonds would merge are one already."""
    if name == "bonds":
        return any(r[3] == 0.0 for r in network.places.rail_rows) or len(network.places.rail_rows) < 2
    ends = [network.switch_node(end) for end in (row.from_, row.to)]
    return None in ends or network.one.find(ends[0]) == network.one.find(ends[1])


def without_loops(substations, cabins):
    """Return stations without loops of no resistance between those at one place, as the checks demand.

    Substations there have feeders with resistance; of cabins only the first stays.
    """
    kept = []
    for cabin in cabins:
        if not any(_shares(cabin, other) for other in kept):
            kept.append(cabin)
    loose = []
    for station in substations:
        shared = any(other is not station and _shares(station, other) for other in (*substations, *kept))
        ohm = max(station.feeder_resistance_ohm, 0.003) if shared else station.feeder_resistance_ohm
        loose.append(station.model_copy(update={"feeder_resistance_ohm": ohm}))
    return tuple(loose), tuple(kept)


def _shares(station, other):
    return abs(station.km - other.km) < 0.003


def tame_dead_loads(supply, live):
    """Return `supply` with the loads that no source reaches made to take within limits."""
    reached = dict(zip(sorted(load.id for load in supply.loads), live, strict=True))
    loads = []
    for load in supply.loads:
        change = {}
        if not reached[load.id]:
            kw, ampere = load.power_kw, load.current_a
            change = {"limits": "range", "power_kw": kw and abs(kw), "current_a": ampere and abs(ampere)}
        loads.append(load.model_copy(update=change))
    return supply.model_copy(update={"loads": tuple(loads)})


def draw_network(*seed):
    """Return a supply with loads, its line and its dense network."""
    draw = Draw(*seed)
    supply = draw.supply(draw.loads())
    network = DenseNetwork(supply, draw.line, LIMITS)
    if not network.live.all():
        supply = tame_dead_loads(supply, network.live)
        network = DenseNetwork(supply, draw.line, LIMITS)
    return supply, draw.line, network
