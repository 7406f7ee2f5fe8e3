"""Where conductors lie along the tracks: bundles of tracks, cut wherever something happens on one of them.

Tracks that share a return conductor form a *bundle*. Between two neighbouring cuts of a bundle nothing happens: there lie
spans. At a cut every contact line has a low and a high side, and the rails one node for each of their rows.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import TrackAxis
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.conductors import Conductor
from tractionpower.model.line import Line, Stretch
from tractionpower.model.supply import ReturnCircuit, Supply
from tractionpower.supply.conductors import contact_line_resistance, return_resistance

SHARED_KM = SHARED_NODE_M / 1000.0
LOW, HIGH = "low_km", "high_km"


@dataclass(frozen=True, slots=True)
class Rails:
    """A row of the return circuit within a bundle."""

    number: int
    tracks: tuple[str, ...]
    ohm_per_m: float
    siemens_per_m: float


class Bundle:
    """Tracks that share return conductors, and what lies between the cuts.

    Attributes
    ----------
    tracks
        Identifiers, sorted.
    cuts
        Kilometres of the cuts, rising; of two kilometres at one place, beside a chainage break, the first.
    pieces
        From where to where each piece between two cuts runs [km].
    contacts
        For each piece between two cuts the resistance of the contact line of each track that has one [ohm/m].
    rails
        For each piece the return conductors.
    """

    def __init__(
        self, tracks: Sequence[str], supply: Supply, line: Line, axes: Mapping[str, TrackAxis], conductors: Sequence[Conductor]
    ) -> None:
        self.tracks = tuple(tracks)
        self._axes = axes
        self.ends = {track.id: (track.from_km, track.to_km) for track in line.tracks if track.id in tracks}
        self._contact_rows = [
            (row, track) for row in supply.contact_lines for track in self.tracks if row.tracks is None or track in row.tracks
        ]
        self._rail_rows = [
            (number, row, tuple(track for track in self.tracks if track in members))
            for number, row in enumerate(supply.return_circuit)
            if (members := return_tracks(row, line)).intersection(self.tracks)
        ]
        self._conductors = conductors
        self.cuts: list[float] = []
        self.pieces: list[tuple[float, float]] = []
        self._kms: list[float] = []  # of all that makes cuts, with the cut of each
        self._cut_of: list[int] = []
        self.contacts: list[dict[str, float]] = []
        self.rails: list[list[Rails]] = []

    def cut_at(self, kms: Iterable[float]) -> None:
        """Cut the bundle at places of devices, and where conductors begin, end or change."""
        every = [*kms]
        rows: list[tuple[float, float, tuple[str, ...]]]
        rows = [(row.from_km, row.to_km, (track,)) for row, track in self._contact_rows]
        rows += [(row.from_km, row.to_km, tracks) for _, row, tracks in self._rail_rows]
        for from_km, to_km, tracks in rows:
            low, high = min(self.ends[track][0] for track in tracks), max(self.ends[track][1] for track in tracks)
            every += [max(from_km, low), min(to_km, high)]
        for km in sorted(every):
            self._kms.append(km)
        metres = np.array([self._metres(track) for track in self.tracks])
        first: list[int] = []  # where the kilometres of each cut begin
        for n in range(len(self._kms)):
            if not first or (metres[:, n] - metres[:, first[-1]]).max() >= SHARED_NODE_M:
                first.append(n)
            self._cut_of.append(len(first) - 1)
        self.cuts = [self._kms[n] for n in first]
        self.pieces = [(self._kms[high - 1], self._kms[high]) for high in first[1:]]
        middles = [0.5 * (low + high) for low, high in self.pieces]
        self.contacts = [{} for _ in middles]
        self.rails = [[] for _ in middles]
        for wires, track in self._contact_rows:
            ohm = contact_line_resistance(wires, self._conductors) / 1000.0
            for piece in _covered(wires, middles):
                if self._exists(track, middles[piece]):
                    self.contacts[piece][track] = ohm
        for number, row, members in self._rail_rows:
            for piece in _covered(row, middles):
                if tracks := tuple(track for track in members if self._exists(track, middles[piece])):
                    ohm = return_resistance(row, len(tracks), self._conductors) / 1000.0
                    self.rails[piece].append(Rails(number, tracks, ohm, row.leakage_s_per_km / 1000.0))

    def _metres(self, track: str) -> NDArray[np.float64]:
        """Return the places of all kilometres along a track [m]: those that a chainage break leaves out have no length."""
        axis = self._axes[track]
        return axis.metre(np.clip(self._kms, axis.from_km, axis.to_km))

    def _exists(self, track: str, km: float) -> bool:
        low, high = self.ends[track]
        return low <= km <= high

    def cut(self, km: float) -> int:
        """Return the number of the cut nearest to a kilometre."""
        kms = self._kms
        after = bisect_left(kms, km)
        nearest = min((n for n in (after - 1, after) if 0 <= n < len(kms)), key=lambda n: abs(kms[n] - km))
        return self._cut_of[nearest]

    def sides(self, track: str, cut: int) -> list[str]:
        """Return on which sides of a cut the track has a contact line."""
        found = []
        if cut > 0 and track in self.contacts[cut - 1]:
            found.append(LOW)
        if cut < len(self.contacts) and track in self.contacts[cut]:
            found.append(HIGH)
        return found

    def rails_at(self, track: str, cut: int) -> list[Rails]:
        """Return the return conductors of a track beside a cut, the low side first."""
        beside = [*(self.rails[cut - 1] if cut > 0 else ()), *(self.rails[cut] if cut < len(self.rails) else ())]
        return [rails for rails in beside if track in rails.tracks]


def _covered(row: Stretch, middles: Sequence[float]) -> range:
    """Return the pieces between cuts, by their rising middles, that a row covers."""
    return range(bisect_left(middles, row.from_km), bisect_right(middles, row.to_km))


def find_bundles(supply: Supply, line: Line, axes: Mapping[str, TrackAxis], conductors: Sequence[Conductor]) -> list[Bundle]:
    """Return the bundles of a line in the order of their first tracks."""
    label: dict[str, str] = {track.id: track.id for track in line.tracks}
    for row in supply.return_circuit:
        own = sorted(return_tracks(row, line))
        old = {label[track] for track in own}
        label = {track: min(old) if mine in old else mine for track, mine in label.items()}
    groups: Mapping[str, list[str]] = defaultdict(list)
    for track in sorted(label):
        groups[label[track]].append(track)
    return [Bundle(tracks, supply, line, axes, conductors) for tracks in groups.values()]


def return_tracks(row: ReturnCircuit, line: Line) -> set[str]:
    """Return the tracks of the line that a row of the return circuit belongs to."""
    known = {track.id for track in line.tracks}
    return known if row.tracks is None else known & set(row.tracks)
