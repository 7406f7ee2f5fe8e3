"""Random feeders, switches, earthings and voltage-limiting devices, for the random networks."""

from dense_network import TIES
from dense_places import SHARED_KM

from tractionpower.model.earthing import Earthing, VoltageLimitingDevice
from tractionpower.model.switchgear import Feeder, Switch


class RandomSwitchgear:
    """What switches and earths the supply of some random lines.

    Attributes
    ----------
    feeders, switches, earthing, limiters
        The rows of a supply.
    """

    def __init__(self, rng, parts, scale, substations, cabins, points):
        self.rng, self.parts, self.scale = rng, parts, scale
        self.stations = (*substations, *cabins)
        self.substations, self.dead = substations, set()
        self.cut = {(t, s.km) for s in self.stations if s.state != "bypassed" for t in self.tracks_of(s)}
        self.cut |= {(point.track, point.km) for point in points if point.state == "open"}
        self.feeders = self._feeders() if rng.random() < 0.5 else ()
        self.switches = tuple(row for k in range(rng.integers(0, 4)) if (row := self._switch(k)))
        earthed = any(part.leaky for part in parts) or rng.random() < 0.3
        self.earthing = tuple(self._earthing(k) for k in range(rng.integers(0, 3))) if earthed else ()
        self.limiters = tuple(row for k in range(rng.integers(0, 3)) if (row := self._limiter(k)))

    def among(self, rows):
        return rows[self.rng.integers(len(rows))]

    def some_ohm(self, high):
        return 0.0 if self.rng.random() < 0.3 else float(self.rng.uniform(0.001, high))

    def part_at(self, km):
        return min(self.parts, key=lambda part: min(abs(km - other) for other in part.grid))

    def tracks_of(self, station):
        part = self.part_at(station.km)
        return list(station.tracks or part.tracks_at(station.km))

    def sides(self, track, km):
        """Return the sides of a place on which its track has a contact line."""
        rows = [row for row in self.part_at(km).contact if track in row.tracks]
        low = [max(row.from_km, self.part_at(km).ends[track][0]) for row in rows]
        high = [min(row.to_km, self.part_at(km).ends[track][1]) for row in rows]
        spans = list(zip(low, high, strict=True))
        found = ["low_km"] if any(a < km - SHARED_KM and km <= b for a, b in spans) else []
        return found + (["high_km"] if any(a <= km and km + SHARED_KM < b for a, b in spans) else [])

    # -- feeders

    def _state(self, open_share=0.3):
        return "open" if self.rng.random() < open_share else "closed"

    def _feeders(self):
        rng, rows = self.rng, []
        for station in self.stations:
            for track in self.tracks_of(station):
                for side in self.sides(track, station.km):
                    if rng.random() < 0.2:
                        ohm = None if rng.random() < 0.3 else self.some_ohm(0.06)
                        rows.append(Feeder(at=station.id, track=track, side=side, state=self._state(), resistance_ohm=ohm))
            if station in self.substations:
                rows += [self._return(station, track) for track in self.tracks_of(station) if rng.random() < 0.15]
        if rng.random() < 0.4:
            rows += self._distant(self.among(self.stations))
        return tuple(rows)

    def _return(self, station, track, km=None):
        ohm = float(self.rng.uniform(0.002, 0.05))
        return Feeder(at=station.id, track=track, side="return", resistance_ohm=ohm, km=km, state=self._state(0.15))

    def _distant(self, station):
        """Feed a track of other kilometres, to both sides; either breaker may be open."""
        home = self.part_at(station.km)
        others = [part for part in self.parts if part is not home]
        if not others:
            return []
        track, km = self.among(others).free_place()
        self.cut |= {(track, km)} if station.state != "bypassed" else set()
        rows = [
            Feeder(at=station.id, track=track, side=side, km=km, resistance_ohm=self.some_ohm(0.1), state=self._state())
            for side in self.sides(track, km)
        ]
        if rows and station in self.substations and self.rng.random() < 0.5:
            rows.append(self._return(station, track, km))
        return rows

    # -- switches

    def _end(self, place=None):
        """Return an end of a switch: a busbar, or a place on a track with its side where the line is cut there."""
        rng = self.rng
        if place is None and rng.random() < 0.3:
            station = self.among(self.stations)
            if station.state not in TIES:  # one switch at most to a busbar without feeders: it leads nowhere
                if station.id in self.dead:
                    return None
                self.dead.add(station.id)
            return {"busbar": station.id}
        track, km = place or self.among(self.parts).free_place()
        sides = self.sides(track, km)
        if not sides:
            return None
        cut = (track, km) in self.cut and len(sides) == 2
        return {"track": track, "km": km} | ({"side": str(rng.choice(sides))} if cut or rng.random() < 0.2 else {})

    def _switch(self, k):
        kind = self.rng.random()
        if kind < 0.25 and self.cut:  # across a cut
            track, km = self.among(sorted(self.cut))
            ends = [{"track": track, "km": km, "side": side} for side in self.sides(track, km)]
        elif kind < 0.5:  # a cross tie
            part = self.among(self.parts)
            track, km = part.free_place()
            ends = [self._end((other, km)) for other in part.tracks_at(km)[:2]]
        else:
            ends = [self._end(), self._end()]
        if len(ends) < 2 or None in ends or ends[0] == ends[1]:
            return None
        ohm = self.some_ohm(0.05)
        return Switch.model_validate(
            {"id": f"W{k}", "from": ends[0], "to": ends[1], "resistance_ohm": ohm, "state": self._state(0.4)}
        )

    # -- earth

    def _rail_place(self):
        part = self.among(self.parts)
        track = str(self.rng.choice(part.tracks))
        if self.rng.random() < 0.5:
            return part.free_place(track)
        return track, float(self.rng.choice([km for km in part.grid if part.exists(track, km)]))

    def _earthing(self, k):
        ohm = float(10.0 ** self.rng.uniform(-1.3, 1.3))
        if self.rng.random() < 0.3:
            return Earthing(id=f"E{k}", substation=self.among(self.substations).id, resistance_ohm=ohm)
        track, km = self._rail_place()
        return Earthing(id=f"E{k}", track=track, km=km, resistance_ohm=ohm)

    def _limiter(self, k):
        """Return a device on rails of a track that knows remote earth somewhere, None if none was found."""
        track, km = self._rail_place()
        leaking = [row for part in self.parts for row in part.returns if row.leakage_s_per_km > 0.0]
        if not any(track in row.tracks for row in leaking) and track not in [row.track for row in self.earthing]:
            return None
        ohm = float(10.0 ** self.rng.uniform(-1.5, 0.0))
        return VoltageLimitingDevice.model_validate(
            {"id": f"V{k}", "track": track, "km": km, "closes": [{"above_v": 120.0}], "closed_resistance_ohm": ohm}
            | {"state": self._state(0.5)}
        )
