"""The greatest rail potentials of a run, at every place along the line.

What is found under a train counts at the fixed place that is nearest to it: as places of their own, stretches that few trains
pass would lie beside fixed places, which are looked at in every step, and a line through both would jump up and down.
"""

from __future__ import annotations

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Placed, Places
from tractionpower.kernels.block_tables import Buffers
from tractionpower.studies.cases.voltages import by_place, case_table
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]


class RailWatch:
    """Takes the potentials of rails against remote earth, at fixed places and under trains, where one is defined.

    Parameters
    ----------
    supply
        What runs.
    places
        Where trains are.

    Attributes
    ----------
    greatest
        Greatest magnitude of a potential [V] and its kilometre; NaN where none is defined.
    """

    def __init__(self, supply: SupplyTables, places: Places) -> None:
        self._places = places
        self._fixed = [(place.tracks, place.km) for place in supply.rail_places]
        self._fixed_v = np.full((2, len(self._fixed)), np.nan)
        self._bin_v = np.full((2, places.bins), np.nan)
        self._bin_tracks = _rails_at(supply, places)
        self.greatest: tuple[float, float] = (np.nan, np.nan)

    def add(self, rows: Buffers, placed: Placed) -> None:
        """Take steps; `placed` are the places of their rows of trains."""
        if not self._fixed:
            return
        volts = rows.rail_v
        low, high = np.fmin.reduce(volts, axis=0, initial=np.nan), np.fmax.reduce(volts, axis=0, initial=np.nan)
        self._fixed_v = np.stack([np.fmin(self._fixed_v[0], low), np.fmax(self._fixed_v[1], high)])
        magnitude = np.fmax(np.abs(low), np.abs(high))
        if np.isfinite(magnitude).any():
            k = int(np.nanargmax(magnitude))
            self._note(float(magnitude[k]), self._fixed[k][1])
        under = np.ascontiguousarray(rows.trains["rail_v"])
        if np.isfinite(under).any():
            bins = self._places.bin(placed)
            np.fmin.at(self._bin_v[0], bins, under)
            np.fmax.at(self._bin_v[1], bins, under)
            k = int(np.nanargmax(np.abs(under)))
            self._note(float(abs(under[k])), float(placed.km[k]))

    def _note(self, magnitude: float, km: float) -> None:
        if not magnitude <= self.greatest[0]:
            self.greatest = (magnitude, km)

    def profile(self) -> pa.Table:
        """Return table ``case_rails`` without the column case, by tracks and kilometre; empty where no earth is defined."""
        found: dict[tuple[str, float], tuple[float, float]] = {}
        for place, (low, high) in zip(
            self._where(), np.concatenate([self._fixed_v, self._bin_v], axis=1).T.tolist(), strict=True
        ):
            if np.isfinite(low):
                known = found.get(place, (np.inf, -np.inf))
                found[place] = (min(low, known[0]), max(high, known[1]))
        ends = np.array([found[key] for key in sorted(found)]).reshape(-1, 2)
        columns = {"lowest_potential_v": ends[:, 0], "highest_potential_v": ends[:, 1]}
        return case_table("case_rails", by_place("track", found) | columns)

    def _where(self) -> list[tuple[str, float]]:
        """Return tracks and kilometre of all fixed places, then of the bins of trains: those of the nearest fixed place."""
        of_tracks: dict[str, list[float]] = {}
        for tracks, km in self._fixed:
            of_tracks.setdefault(tracks, []).append(km)
        near = []
        for tracks, km in zip(self._bin_tracks, self._places.bin_km.tolist(), strict=True):
            fixed = of_tracks.get(tracks, [km])
            near.append((tracks, fixed[int(np.abs(np.array(fixed) - km).argmin())]))
        return [*self._fixed, *near]


def _rails_at(supply: SupplyTables, places: Places) -> list[str]:
    """Return for each bin of the profile the tracks of the return conductor that its track belongs to there."""
    rails = [section for section in supply.conductor_sections if section.kind == "rails"]
    found = []
    for track, km in zip(places.bin_track.tolist(), places.bin_km.tolist(), strict=True):
        name = places.tracks[track]
        mine = [section for section in rails if name in section.tracks.split(" ")]
        mine.sort(key=lambda section: max(section.from_km - km, km - section.to_km))  # a bin may reach beyond the last end
        found.append(mine[0].tracks if mine else name)
    return found
