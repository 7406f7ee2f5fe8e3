"""The lowest and highest voltages of a run, and the lowest that trains have along the line."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.cosimulation.places import BIN_KM, Placed, Places
from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.scenario import Clock
from tractionpower.results.spells import TrainSpells
from tractionpower.results.tables import make_table
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]
Rows = NDArray[np.void]

NOWHERE = (np.nan, "", np.nan, np.nan)
"""Voltage [V], track, kilometre, time [s] of what was never seen."""


class VoltageWatch:
    """Takes the voltages at fixed places, loads and pantographs; what nothing feeds has none.

    Parameters
    ----------
    supply
        What runs.
    places
        Where trains are.
    clock, trains
        Of the run: its clock, and the number of trains.

    Attributes
    ----------
    lowest
        Lowest voltage [V], its track, kilometre and time [s].
    highest_v
        Highest voltage [V], NaN if there is none.
    """

    def __init__(self, supply: SupplyTables, places: Places, clock: Clock, trains: int) -> None:
        self._places, self._step_s = places, clock.step_s
        self._above = TrainSpells(trains, supply.voltages.u_max1)
        self._fixed = [*supply.sections, *((load.track, load.km) for load in supply.loads)]
        self._fixed_v = np.full(len(self._fixed), np.nan)
        self._bin_v = np.full(places.bins, np.inf)
        self.lowest: tuple[float, str, float, float] = NOWHERE
        self.highest_v = np.nan

    def add(self, time_s: Floats, rows: Buffers, supply: SupplyTables, placed: Placed) -> None:
        """Take steps; `placed` are the places of their rows of trains."""
        fed = supply.network.ports["start_v"][supply.load_port] > 0.0
        self._add_fixed(time_s, np.concatenate([rows.section_v, np.where(fed, rows.load_v, np.nan)], axis=1))
        volts = np.ascontiguousarray(rows.trains["voltage_v"])
        self._above.add(rows.trains["time_s"], rows.trains["train"], volts, self._step_s)
        live = volts != 0.0  # a dead contact line has no voltage that could be low
        if not live.any():
            return
        known = np.where(live, volts, np.inf)
        np.minimum.at(self._bin_v, self._places.bin(placed), known)
        self.highest_v = np.fmax(self.highest_v, volts.max())
        k = int(known.argmin())
        if not volts[k] >= self.lowest[0]:
            track = self._places.tracks[placed.track[k]]
            self.lowest = (float(volts[k]), track, float(placed.km[k]), float(rows.trains["time_s"][k]))

    def _add_fixed(self, time_s: Floats, volts: Floats) -> None:
        lowest = np.fmin.reduce(volts, axis=0, initial=np.nan)
        self._fixed_v = np.fmin(self._fixed_v, lowest)
        if np.isnan(lowest).all():
            return
        self.highest_v = np.fmax(self.highest_v, np.fmax.reduce(volts, axis=None))
        k = int(np.nanargmin(lowest))
        if not lowest[k] >= self.lowest[0]:
            track, km = self._fixed[k]
            self.lowest = (float(lowest[k]), track, km, float(time_s[np.nanargmin(volts[:, k])]))

    @property
    def above_u_max1_s(self) -> float:
        """Longest time of a train above U_max1 without a break [s]; NaN without trains."""
        return float(self._above.longest_s.max(initial=0.0)) if len(self._above.longest_s) else np.nan

    def profile(self) -> pa.Table:
        """Return table ``case_profile`` without the column case, by track and kilometre.

        Trains are at a place for some seconds of a run, what is fixed there for all of it: a line through the lowest voltages
        of both would jump up and down. So a fixed place counts only where no train came near.
        """
        bins = zip(self._places.bin_track.tolist(), self._places.bin_km.tolist(), strict=True)
        where = [(self._places.tracks[track], km) for track, km in bins]
        found = {place: volts for place, volts in zip(where, self._bin_v.tolist(), strict=True) if np.isfinite(volts)}
        passed: dict[str, list[float]] = {}
        for track, km in found:
            passed.setdefault(track, []).append(km)
        for (track, km), volts in zip(self._fixed, self._fixed_v.tolist(), strict=True):
            if np.isfinite(volts) and not any(abs(km - there) <= BIN_KM for there in passed.get(track, ())):
                found[track, km] = min(volts, found.get((track, km), np.inf))
        return case_table("case_profile", by_place("track", found) | {"lowest_voltage_v": [found[key] for key in sorted(found)]})


def by_place(column: str, found: dict[tuple[str, float], Any]) -> dict[str, Any]:
    """Return the columns of tracks, under the name `column`, and of kilometres [km] of places, sorted."""
    order = sorted(found)
    return {column: coded([track for track, _ in order]), "km": [km for _, km in order]}


def coded(words: list[str]) -> tuple[list[int], list[str]]:
    """Return texts as a table takes them: numbers, and the sorted texts that these stand for."""
    names = sorted(set(words))
    number = {name: k for k, name in enumerate(names)}
    return [number[word] for word in words], names


def case_table(table: str, columns: dict[str, Any]) -> pa.Table:
    """Return a table of cases without its first column, the case."""
    first = next(iter(columns.values()))
    count = len(first[0] if isinstance(first, tuple) else first)
    return make_table(table, columns | {"case": (np.zeros(count, np.int32), [""])}).drop_columns(["case"])
