"""Where things stand, for the dense reference: what exists at a kilometre, how far apart, where conductors are cut.

Written from the declared rows alone; nothing of `tractionpower.alignment` or of the topology is used.
"""

from itertools import pairwise

SHARED_KM = 0.001
"""Devices closer than this share a node."""


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


class Places:
    """The tracks with their conductors, and the cuts that devices make in them.

    Attributes
    ----------
    ends
        First and last kilometre of each track.
    contact_rows
        Track, from, to, resistance [ohm/km] of each contact line.
    rail_rows
        Tracks (sorted), from, to, resistance [ohm/km], leakage [S/km] of each return conductor.
    cuts
        By track, the kilometres where something happens on it or on a track that shares its rails.
    pieces
        By track, the stretches (from, to) between neighbouring cuts where it has a contact line.
    """

    def __init__(self, supply, line):
        self.supply, self.line = supply, line
        self.ends = {track.id: (track.from_km, track.to_km) for track in line.tracks}
        self.jumps = {track: self._jumps(track) for track in self.ends}
        self.contact_rows = [
            (track, max(row.from_km, self.ends[track][0]), min(row.to_km, self.ends[track][1]), row.resistance_ohm_per_km)
            for row in supply.contact_lines
            for track in (row.tracks or self.ends)
            if max(row.from_km, self.ends[track][0]) < min(row.to_km, self.ends[track][1])
        ]
        self.rail_rows = [self._rail_row(row) for row in supply.return_circuit]
        bundle = Groups()
        for tracks, *_ in self.rail_rows:
            for track in tracks:
                bundle.join(tracks[0], track)
        self.bundle = {track: bundle.find(track) for track in self.ends}
        self.cuts = self._cuts()
        self.pieces = {track: self._pieces(track) for track in self.ends}

    # -- kilometres and metres

    def _jumps(self, track):
        low, high = self.ends[track]
        return sorted(
            (jump.at_km, jump.continues_as_km)
            for jump in self.line.chainage_breaks
            if (low < jump.at_km < high if jump.tracks is None else track in jump.tracks)
        )

    def exists(self, track, km):
        """Tell whether a kilometre is on a track; those that a jump leaves out are not."""
        low, high = self.ends[track]
        return low - 1e-9 <= km <= high + 1e-9 and all(not at + 1e-9 < km < on - 1e-9 for at, on in self.jumps[track])

    def way_km(self, track, low, high):
        """Return the length of a track between two kilometres: a jump forward shortens it, one back lengthens it."""
        length = high - low
        for at, on in self.jumps[track]:
            length += (min(max(at, low), high) - min(max(on, low), high)) if on > at else (at - on) * (low <= at < high)
        return length

    def _rail_row(self, row):
        tracks = sorted(row.tracks or self.ends)
        low = max(row.from_km, min(self.ends[track][0] for track in tracks))
        high = min(row.to_km, max(self.ends[track][1] for track in tracks))
        return tracks, low, high, row.resistance_ohm_per_km, row.leakage_s_per_km

    # -- what is there

    def tracks_of(self, station):
        """Return the tracks of a substation or cabin, by default all that exist at its place."""
        return [track for track in (station.tracks or self.ends) if self.exists(track, station.km)]

    def fed(self, station):
        """Return the places (track, km) where a station meets the contact lines: its own and those of distant feeders."""
        own = [(track, station.km) for track in self.tracks_of(station)]
        far = sorted({(row.track, row.km) for row in self.supply.feeders if row.at == station.id and row.km is not None})
        return own + [place for place in far if place not in own]

    def rails(self, track, km):
        """Return the numbers of the return conductors of a track at a kilometre, two where one follows the other."""
        return [
            number
            for number, (tracks, low, high, *_) in enumerate(self.rail_rows)
            if track in tracks and low - SHARED_KM < km < high + SHARED_KM
        ]

    def bonded(self):
        """Yield resistance and places (track, km) of every row of cross bonds, of one track or more."""
        for row in self.supply.bonds:
            for k in range(int((row.to_km - row.from_km + SHARED_KM) / row.every_km + 1e-9) + 1):
                km = row.from_km + k * row.every_km
                here = [track for track in sorted(row.tracks or self.ends) if self.exists(track, km) and self.rails(track, km)]
                yield row.resistance_ohm, [(track, km) for track in here]

    # -- cuts

    def _events(self):
        supply = self.supply
        for station in (*supply.substations, *supply.section_cabins):
            yield from self.fed(station)
        for device in (*supply.section_points, *supply.voltage_limiting_devices, *supply.earthing):
            if device.track is not None:
                yield device.track, device.km
        for switch in supply.switches:
            for end in (switch.from_, switch.to):
                if end.track is not None:
                    yield end.track, end.km
        for connection in self.line.connections:
            for end in (connection.from_, connection.to):
                yield end.track, end.km
        for _, places in self.bonded():
            yield from places
        for track, low, high, _ in self.contact_rows:
            yield from ((track, low), (track, high))
        for tracks, low, high, *_ in self.rail_rows:
            yield from ((tracks[0], low), (tracks[0], high))

    def _cuts(self):
        kms = {}
        for track, km in self._events():
            kms.setdefault(self.bundle[track], set()).add(km)
        cuts = {}
        for bundle, found in kms.items():
            kept = []
            for km in sorted(found):
                if not kept or km - kept[-1] >= SHARED_KM:
                    kept.append(km)
            cuts[bundle] = kept
        return {track: cuts.get(self.bundle[track], []) for track in self.ends}

    def cut(self, track, km):
        """Return the cut at a place; where there is one closer than a metre, that one."""
        return min(self.cuts[track], key=lambda cut: abs(cut - km))

    def contact_ohm(self, track, km):
        """Return the resistance of the contact line of a track [ohm/km], None where there is none."""
        return next((ohm for name, low, high, ohm in self.contact_rows if name == track and low < km < high), None)

    def _pieces(self, track):
        low, high = self.ends[track]
        cuts = [cut for cut in self.cuts[track] if low - SHARED_KM <= cut <= high + SHARED_KM]
        return [piece for piece in pairwise(cuts) if self.contact_ohm(track, 0.5 * sum(piece)) is not None]

    def piece(self, track, km):
        """Return the piece that carries a place; at a cut that of lower kilometres."""
        found = [p for beyond in (0.0, SHARED_KM) for p in self.pieces[track] if p[0] - beyond <= km <= p[1] + beyond]
        return found[0]

    def sides(self, track, km):
        """Return the nodes of the contact line just below and just above a place, where it exists."""
        cut = self.cut(track, km)
        low = [("low_km", track, cut) for piece in self.pieces[track] if piece[1] == cut]
        return low + [("high_km", track, cut) for piece in self.pieces[track] if piece[0] == cut]
