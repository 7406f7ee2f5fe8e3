"""Random supply systems, all of them valid, for the laws."""

from itertools import pairwise

import numpy as np

from tractionpower.model.line import Line, Track
from tractionpower.model.supply import ContactLine, Load, ReturnCircuit, SectionCabin, SectionPoint, Substation, Supply

U_N = {"dc3000": 3000.0, "dc1500": 1500.0}
GRID = 40
"""Places of fixed devices per line."""


class Draw:
    """One random line with its supply, a function of the seed alone.

    Fixed devices stand on a grid, so that they coincide or lie well apart; loads stand anywhere, at the same place, less
    than 1 m from each other or from a device. `live` tells which loads a network reaches; the others only take, within
    limits, since what feeds back into a dead part has no place to go.
    """

    def __init__(self, *seed):
        self.rng = np.random.default_rng(seed)
        rng = self.rng
        self.system = "dc1500" if rng.random() < 0.15 else "dc3000"
        self.u_n = U_N[self.system]
        self.scale = self.u_n / 3000.0
        start = float(rng.choice([0.0, -3.5, 117.25]))
        length = float(rng.uniform(4.0, 60.0) * self.scale)
        self.grid = [round(start + length * k / GRID, 6) for k in range(GRID + 1)]
        self.tracks = [str(k + 1) for k in range(rng.integers(1, 5))]
        self.ends = dict.fromkeys(self.tracks, (self.grid[0], self.grid[-1]))
        if len(self.tracks) > 1 and rng.random() < 0.25:
            low, high = sorted(rng.choice(GRID + 1, 2, replace=False))
            self.ends[self.tracks[-1]] = self.grid[low], self.grid[high]
        self.line = Line(tracks=tuple(Track(id=t, from_km=a, to_km=b) for t, (a, b) in self.ends.items()))
        self.contact = self._contact_lines()
        self.returns = self._returns()

    def supply(self, loads=()):
        rng = self.rng
        substations = tuple(self._substation(k) for k in range(rng.integers(1, 7)))
        cabins = tuple(self._cabin(k) for k in range(rng.integers(0, 5)))
        substations, cabins = without_loops(substations, cabins)
        return Supply(
            system=self.system,
            substations=substations,
            section_cabins=cabins,
            section_points=tuple(point for k in range(rng.integers(0, 4)) if (point := self._point(k))),
            contact_lines=self.contact,
            return_circuit=self.returns,
            loads=tuple(loads),
        )

    # -- conductors

    def _parts(self, ends, breaks, more=()):
        inside = [km for km in self.grid if ends[0] < km < ends[1]]
        count = min(self.rng.integers(0, breaks + 1), len(inside))
        chosen = self.rng.choice(inside, count, replace=False).tolist() if count else []
        return list(pairwise(sorted({*ends, *chosen, *more})))

    def _contact_lines(self):
        rng, rows = self.rng, []
        if rng.random() < 0.3:
            for low, high in self._parts((self.grid[0], self.grid[-1]), 2):
                rows.append(ContactLine(from_km=low, to_km=high, resistance_ohm_per_km=rng.uniform(0.02, 0.1)))
            if len({self.ends[track] for track in self.tracks}) == 1:
                return tuple(rows)
            rows = []
        for track in self.tracks:
            parts = self._parts(self.ends[track], 2)
            kept = [part for part in parts if len(parts) == 1 or rng.random() > 0.08] or parts
            rows += [
                ContactLine(tracks=(track,), from_km=low, to_km=high, resistance_ohm_per_km=rng.uniform(0.02, 0.1))
                for low, high in kept
            ]
        return tuple(rows)

    def _returns(self):
        rng, rows = self.rng, []
        for low, high in self._parts((self.grid[0], self.grid[-1]), 1, self.ends[self.tracks[-1]]):
            kind = rng.choice(["common", "single", "mixed"])
            labels = {"common": [0] * 4, "single": [0, 1, 2, 3], "mixed": rng.integers(0, 2, 4).tolist()}[kind]
            for label in sorted(set(labels)):
                members = [t for t, mine in zip(self.tracks, labels, strict=False) if mine == label]
                members = [t for t in members if self.ends[t][0] <= low and high <= self.ends[t][1]]
                if members:
                    ohm = 0.0 if rng.random() < 0.15 else rng.uniform(0.003, 0.03)
                    rows.append(ReturnCircuit(tracks=tuple(members), from_km=low, to_km=high, resistance_ohm_per_km=ohm))
        return tuple(rows)

    # -- devices

    def _some_tracks(self, km):
        here = [t for t in self.tracks if self.ends[t][0] <= km <= self.ends[t][1]]
        if self.rng.random() < 0.75:
            return None
        return tuple(sorted(self.rng.choice(here, self.rng.integers(1, len(here) + 1), replace=False).tolist()))

    def _some_ohm(self, high):
        return 0.0 if self.rng.random() < 0.5 else float(self.rng.uniform(0.001, high))

    def _substation(self, k):
        rng = self.rng
        km = float(rng.choice(self.grid))
        others = ["rectifiers_out", "bypassed", "open"]
        return Substation(
            id=f"S{k}",
            km=km,
            no_load_voltage_v=float(rng.choice([1.2, rng.uniform(1.05, 1.25)])) * self.u_n,
            internal_resistance_ohm=rng.uniform(0.02, 0.3) * self.scale,
            conducts="both" if rng.random() < 0.25 else "forward",
            state="in_service" if k == 0 or rng.random() < 0.7 else str(rng.choice(others)),
            feeder_resistance_ohm=self._some_ohm(0.05),
            return_resistance_ohm=self._some_ohm(0.03),
            grid_voltage_pu=1.0 if rng.random() < 0.8 else rng.uniform(0.95, 1.03),
            tracks=self._some_tracks(km),
        )

    def _cabin(self, k):
        km = float(self.rng.choice(self.grid))
        state = str(self.rng.choice(["closed", "closed", "bypassed", "open"]))
        return SectionCabin(id=f"C{k}", km=km, state=state, tracks=self._some_tracks(km))

    def _point(self, k):
        track = str(self.rng.choice(self.tracks))
        km = float(self.rng.choice(self.grid))
        if not self.ends[track][0] <= km <= self.ends[track][1]:
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
        places, loads = [], []
        for k, share in enumerate(shares):
            track, km = self._place(places)
            places.append(km)
            sign = {"taking": 1.0, "feeding": -1.0, "mixed": float(rng.choice([-1.0, 1.0]))}[mode]
            power = sign * total * float(share)
            kind = {"power_kw": power} if rng.random() < 0.8 else {"current_a": power * 1e3 / self.u_n}
            limits = "none" if free and rng.random() < 0.5 else "range"
            fold = None
            if limits == "range" and sign < 0.0 and rng.random() < 0.6:
                fold = self.u_n * float(rng.choice([1.3, rng.uniform(1.1, 1.29)]))
            loads.append(Load(id=f"L{k:02}", track=track, km=km, limits=limits, fold_back_from_v=fold, **kind))
        return tuple(loads)

    def _place(self, places):
        rng = self.rng
        row = self.contact[rng.integers(len(self.contact))]
        track = str(rng.choice(row.tracks or self.tracks))
        low, high = row.from_km, row.to_km
        how = rng.random()
        near = float(rng.choice([km for km in self.grid if low <= km <= high]))
        if how < 0.15 and places:
            near = float(rng.choice(places))
        elif how < 0.25 and places:
            near = float(rng.choice(places)) + rng.uniform(-0.0012, 0.0012)
        elif how < 0.35:
            near += rng.uniform(-0.0012, 0.0012)
        elif how > 0.4:
            near = rng.uniform(low, high)
        return track, float(min(max(near, low), high))


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
