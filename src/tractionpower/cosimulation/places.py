"""Where trains are: track, kilometre, feeding zone and profile bin of rows."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import Movement

Numbers = NDArray[np.int64]
Floats = NDArray[np.float64]

BIN_KM = 0.5
"""Length of the bins in which voltages at pantographs are summed up along the line [km]."""


@dataclass(frozen=True, slots=True)
class Placed:
    """Places of rows: number of the track, kilometre [km], direction of travel (+1 with rising kilometres, -1)."""

    track: Numbers
    km: Floats
    sign: Numbers


class Places:
    """Finds the places of the rows of trains.

    Attributes
    ----------
    tracks
        Identifiers of all tracks, sorted.
    zones
        Feeding zones between neighbouring substations, as ``A–B``.
    """

    def __init__(self, scenario: Scenario, movement: Movement) -> None:
        self.tracks = tuple(sorted(track.id for track in scenario.line.tracks))
        self._runs = movement.runs
        paths = list({id(planned.path): planned.path for planned in movement.runs}.values())
        number = {id(path): k for k, path in enumerate(paths)}
        self._paths = paths
        self._path_of = np.array([number[id(planned.path)] for planned in movement.runs], np.int64)
        self.zones: list[str] = []
        self._zone_ends: dict[int, tuple[Floats, Numbers]] = {}
        self._lay_zones(scenario)
        extents = {track.id: (track.from_km, track.to_km) for track in scenario.line.tracks}
        lowest = [np.floor(extents[track][0] / BIN_KM) for track in self.tracks]
        counts = [int(np.floor(extents[track][1] / BIN_KM) - low) + 1 for track, low in zip(self.tracks, lowest, strict=True)]
        self._first_bin = np.cumsum([0, *counts])[:-1] - np.array(lowest, np.int64)
        self.bins = int(sum(counts))
        self.bin_track = np.repeat(np.arange(len(self.tracks)), counts)
        middles = [(low + np.arange(n) + 0.5) * BIN_KM for low, n in zip(lowest, counts, strict=True)]
        # a bin that reaches beyond the end of its track counts there
        self.bin_km = np.concatenate([np.clip(km, *extents[track]) for track, km in zip(self.tracks, middles, strict=True)])

    def _lay_zones(self, scenario: Scenario) -> None:
        numbers: dict[str, int] = {}
        for track in scenario.line.tracks:
            along = sorted(
                (s.km, s.id)
                for s in scenario.supply.substations
                if (track.id in s.tracks if s.tracks is not None else track.from_km <= s.km <= track.to_km)
            )
            names = [f"{a}–{b}" for (_, a), (_, b) in pairwise(along)]
            zones = [numbers.setdefault(name, len(numbers)) for name in names]
            ends = np.array([km for km, _ in along])
            self._zone_ends[self.tracks.index(track.id)] = (ends, np.array(zones, np.int64))
        self.zones = list(numbers)

    def place(self, train: Numbers, s: Floats) -> Placed:
        """Return the places of the fronts of trains at distances `s` [m] on their routes."""
        track, km, sign = np.zeros(len(s), np.int64), np.zeros(len(s)), np.zeros(len(s), np.int64)
        which = self._path_of[train]
        for number in np.unique(which):
            here, path = which == number, self._paths[number]
            leg, km[here] = path.places(s[here])
            track[here] = np.array([self.tracks.index(leg.axis.track) for leg in path.legs])[leg]
            sign[here] = np.array([leg.sign for leg in path.legs])[leg]
        return Placed(track, km, sign)

    def name(self, train: int, s: float) -> tuple[str, float]:
        """Return track and kilometre of the front of a train at the distance `s` [m]."""
        return self._runs[train].path.place(s)

    def zone(self, placed: Placed) -> Numbers:
        """Return the zone of each row, -1 outside all."""
        found = np.full(len(placed.km), -1, np.int64)
        for track, (ends, zones) in self._zone_ends.items():
            here = placed.track == track
            if len(zones) and here.any():
                k = np.searchsorted(ends, placed.km[here], side="right") - 1
                inside = (k >= 0) & (placed.km[here] <= ends[-1])
                found[here] = np.where(inside, zones[np.clip(k, 0, len(zones) - 1)], -1)
        return found

    def bin(self, placed: Placed) -> Numbers:
        """Return the bin of the profile of each row."""
        return np.asarray(self._first_bin[placed.track] + np.floor(placed.km / BIN_KM).astype(np.int64))
