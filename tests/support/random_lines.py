"""Random tracks with their contact lines, rails and bonds, for the random networks."""

from itertools import pairwise

from tractionpower.model.line import ChainageBreak, Track
from tractionpower.model.supply import Bonds, ContactLine, ReturnCircuit

GRID = 40
"""Places of fixed devices on a trunk; a branch has fewer."""

BRANCH_GRID = 12

PARTS_OF_A_CELL = (0.1, 0.15, 0.2, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.85, 0.9)


class RandomLine:
    """Tracks that share their kilometres.

    Attributes
    ----------
    tracks, ends
        Identifiers, and first and last kilometre of each.
    grid
        Kilometres at which fixed devices stand: whole metres, equal cells.
    used
        Places (track, km) between them that a connection, switch or feeder has taken.
    """

    def __init__(self, rng, number, scale, *, leaky):
        self.rng, self.number, self.leaky, self.used = rng, number, leaky, []
        cells = BRANCH_GRID if number else GRID
        self.start = float(rng.choice([0.0, -3.5, 117.25])) + 500.0 * number
        self.cell = round(float(rng.uniform(4.0, 60.0) * scale) / GRID, 3)
        self.grid = [round(self.start + self.cell * k, 6) for k in range(cells + 1)]
        count = rng.integers(1, 5) if number == 0 else rng.choice([1, 1, 1, 2])
        self.tracks = [f"{k + 1}" if number == 0 else f"{'abc'[number - 1]}{k + 1}" for k in range(count)]
        self.ends = dict.fromkeys(self.tracks, (self.grid[0], self.grid[-1]))
        if count > 1 and rng.random() < 0.25:
            low, high = sorted(rng.choice(cells + 1, 2, replace=False))
            self.ends[self.tracks[-1]] = self.grid[low], self.grid[high]
        self.breaks = self._breaks(cells)
        self.line_tracks = tuple(Track(id=t, from_km=a, to_km=b) for t, (a, b) in self.ends.items())
        self.contact = self._contact_lines()
        self.returns = self._returns()
        self.bonds = self._bonds(cells)

    def exists(self, track, km):
        """Tell whether a kilometre is on a track."""
        return self.ends[track][0] <= km <= self.ends[track][1] and self.is_place(km)

    def is_place(self, km):
        """Tell whether no jump of the kilometres leaves a kilometre out."""
        return all(not item.at_km + 1e-6 < km < item.continues_as_km + 1e-6 for item in self.breaks)

    def tracks_at(self, km):
        return [track for track in self.tracks if self.exists(track, km)]

    # -- places

    def grid_place(self):
        return float(self.rng.choice(self.grid))

    def free_place(self, track=None):
        """Return a place (track, km) between the grid, off the quarters of its cells, that nothing has taken yet."""
        while True:
            name = track or str(self.rng.choice(self.tracks))
            low, high = self.ends[name]
            cells = [(a, b) for a, b in pairwise(self.grid) if low <= a and b <= high]
            a, b = cells[self.rng.integers(len(cells))]
            km = round(a + float(self.rng.choice(PARTS_OF_A_CELL)) * (b - a), 6)
            if self.is_place(km) and (name, km) not in self.used:
                self.used.append((name, km))
                return name, km

    def some_tracks(self, km):
        """Return some of the tracks at a place, mostly None: all."""
        here = self.tracks_at(km)
        if self.rng.random() < 0.75:
            return None
        return tuple(sorted(self.rng.choice(here, self.rng.integers(1, len(here) + 1), replace=False).tolist()))

    # -- conductors

    def _breaks(self, cells):
        """Return at most one jump: forward over a whole cell, whose end is no place any more, or back by a third of one."""
        if self.rng.random() > 0.15:
            return ()
        inner = [km for km in self.grid[1:-2] if all(low < km < high - self.cell for low, high in self.ends.values())]
        if not inner:
            return ()
        at = float(self.rng.choice(inner))
        back = self.rng.random() < 0.5
        on = round(at - 0.1 * self.cell if back else at + self.cell, 6)
        if not back:
            if any(on in pair for pair in self.ends.values()):
                return ()
            self.grid = [km for km in self.grid if km != on]
        return (ChainageBreak(at_km=at, continues_as_km=on, tracks=tuple(self.tracks)),)

    def _parts(self, ends, breaks, more=()):
        inside = [km for km in self.grid if ends[0] < km < ends[1]]
        count = min(self.rng.integers(0, breaks + 1), len(inside))
        chosen = self.rng.choice(inside, count, replace=False).tolist() if count else []
        return list(pairwise(sorted({*ends, *chosen, *more})))

    def _contact_lines(self):
        rng, rows = self.rng, []
        if rng.random() < 0.3:
            for low, high in self._parts((self.grid[0], self.grid[-1]), 2):
                rows.append(ContactLine(tracks=tuple(self.tracks), from_km=low, to_km=high, resistance_ohm_per_km=self._ohm()))
            if len(set(self.ends.values())) == 1:
                return tuple(rows)
            rows = []
        for track in self.tracks:
            parts = self._parts(self.ends[track], 2)
            kept = [part for part in parts if len(parts) == 1 or rng.random() > 0.08] or parts
            rows += [
                ContactLine(tracks=(track,), from_km=low, to_km=high, resistance_ohm_per_km=self._ohm()) for low, high in kept
            ]
        return tuple(rows)

    def _ohm(self):
        return float(self.rng.uniform(0.02, 0.1))

    def _returns(self):
        rng, rows = self.rng, []
        for low, high in self._parts((self.grid[0], self.grid[-1]), 1, self.ends[self.tracks[-1]]):
            kind = rng.choice(["common", "single", "mixed"])
            labels = {"common": [0] * 4, "single": [0, 1, 2, 3], "mixed": rng.integers(0, 2, 4).tolist()}[kind]
            for label in sorted(set(labels)):
                members = [t for t, mine in zip(self.tracks, labels, strict=False) if mine == label]
                members = [t for t in members if self.ends[t][0] <= low and high <= self.ends[t][1]]
                if members:
                    ohm = 0.0 if rng.random() < 0.15 else float(rng.uniform(0.003, 0.03))
                    leak = float(10.0 ** rng.uniform(-2.0, 0.7)) if self.leaky and rng.random() < 0.8 else 0.0
                    row = {"from_km": low, "to_km": high, "resistance_ohm_per_km": ohm, "leakage_s_per_km": leak}
                    rows.append(ReturnCircuit(tracks=tuple(members), **row))
        return tuple(rows)

    def _bonds(self, cells):
        """Return cross bonds at a quarter of every so many cells, or on the grid."""
        rng = self.rng
        if len(self.tracks) < 2 or rng.random() < 0.5:
            return ()
        step, first = int(rng.integers(cells // 8, cells // 2)), int(rng.integers(0, 3))
        shift = 0.25 * self.cell if rng.random() < 0.7 else 0.0
        low = round(self.start + first * self.cell + shift, 6)
        high = (
            round(self.start + self.cell * int(rng.integers(first + step + 1, cells)), 6) if rng.random() < 0.5 else self.grid[-1]
        )
        tracks = None if rng.random() < 0.5 or len(set(self.ends.values())) > 1 else tuple(self.tracks)
        ohm = 0.0 if rng.random() < 0.3 else float(rng.uniform(1e-4, 0.05))
        every = round(step * self.cell, 6)
        if any(not self.is_place(low + k * every) for k in range(int((high - low) / every) + 1)):
            return ()
        return (Bonds(tracks=tracks, from_km=low, to_km=high, every_km=every, resistance_ohm=ohm),)
