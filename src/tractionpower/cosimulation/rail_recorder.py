"""What becomes of rail potentials, leakage and currents into earth: tables, touch voltages, stray currents, key figures.

A run has them where something defines remote earth: leakage, an earthing, a voltage-limiting device.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Placed
from tractionpower.kernels.block_tables import Buffers
from tractionpower.kernels.rails import add_rails, new_rail_sums
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.scenario import Scenario
from tractionpower.results.extremes import Array, Extremes, add_up
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.rails import (
    RailExtremes,
    RailRow,
    device_figures,
    earthing_table,
    rail_figures,
    rail_profile_table,
    rails_table,
    spell_figures,
)
from tractionpower.results.stray import Leakage, stray_rows, stray_verdicts
from tractionpower.results.touch import TouchCheck, touch_limits, touch_verdicts
from tractionpower.supply.compile import SupplyTables

MOST_PLACES = 200
"""With more places than this, table ``rails`` tells some only."""

APART_KM = 1.0
"""These are so far apart, besides the places of devices [km]."""

CARRIES_A = 1e-3
"""A device carries current from this on [A]."""

Append = Callable[[str, pa.Table], None]


class RailRecorder:
    """Takes potentials of rails and currents into earth as they come.

    Parameters
    ----------
    scenario, supply
        What runs.
    trains, tracks
        Names of the trains and tracks that numbers in rows stand for.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables, trains: tuple[str, ...], tracks: tuple[str, ...]) -> None:
        self.scenario, self.devices = scenario, supply.earth_devices
        self.trains, self.tracks, self.step_s = trains, tracks, scenario.clock.step_s
        self.every = max(1, round(scenario.output.rails_every_s / self.step_s))
        found = supply.rail_places
        self.places = RailRow(
            [each.tracks for each in found],
            *(np.array([getattr(each, name) for each in found], float) for name in ("km", "leakage_s_per_m", "length_m")),
        )
        self.told = told_places(self.places, _device_km(scenario))
        self.sums = new_rail_sums(len(found))
        limits = touch_limits(scenario.limits, scenario.supply.system, self.step_s)
        self.touch = TouchCheck(limits, len(found), len(trains), self.step_s)
        self.leaked_a = Extremes(1)
        self.device_a = Extremes(len(self.devices))
        self.device_sums = np.zeros((2, len(self.devices)))  # sum of the magnitudes [A], steps with current
        self._lowest, self._highest = (np.inf, "", np.nan), (-np.inf, "", np.nan)
        self.steps = 0
        self._device_ohm, self._device_place = _device_sides(scenario, self.devices, self.places)

    @property
    def exists(self) -> bool:
        """Whether the rails have a potential against earth."""
        return bool(self.places.tracks)

    def add(self, time_s: Array, rows: Buffers) -> None:
        """Take steps that count in key figures."""
        self.steps += len(time_s)
        if self.exists:
            add_rails(self.sums, np.ascontiguousarray(time_s), np.ascontiguousarray(rows.rail_v))
            self.touch.add(time_s, rows.rail_v)
            self.leaked_a.add(time_s, np.ascontiguousarray(rows.steps["leaked_a"])[:, np.newaxis])
        if self.devices:
            self.device_a.add(time_s, rows.earth_a)
            magnitude = np.abs(rows.earth_a)
            parts = np.stack([magnitude, (magnitude > CARRIES_A).astype(float)], axis=1)
            self.device_sums = add_up(self.device_sums, parts)

    def add_trains(self, rows: NDArray[np.void], placed: Placed) -> None:
        """Take rows of trains that count in key figures; the potential is highest under a train."""
        known = np.isfinite(rows["rail_v"]) if self.exists else np.zeros(0, np.bool_)
        if not known.any():
            return
        rows, track, km = rows[known], placed.track[known], placed.km[known]
        volts, time_s, train = (np.ascontiguousarray(rows[name]) for name in ("rail_v", "time_s", "train"))
        self.touch.add_trains(time_s, train, volts, (track, km))
        low, high = int(volts.argmin()), int(volts.argmax())
        where = [f"train {self.trains[train[k]]}, track {self.tracks[track[k]]}, km {km[k]:.2f}" for k in (low, high)]
        if volts[low] < self._lowest[0]:
            self._lowest = (float(volts[low]), where[0], float(time_s[low]))
        if volts[high] > self._highest[0]:
            self._highest = (float(volts[high]), where[1], float(time_s[high]))

    def write(self, number: NDArray[np.int64], time_s: Array, rows: Buffers, append: Append) -> None:
        """Write the potentials of the steps that are due; `number` counts steps from the start of the clock."""
        due = number % self.every == 0
        if self.exists and due.any():
            append("rails", rails_table(time_s[due], self.places.part(self.told), rows.rail_v[due][:, self.told]))

    def write_devices(self, time_s: Array, rows: Buffers, append: Append) -> None:
        """Write the currents into earth of steps."""
        if not self.devices or not len(time_s):
            return
        potential = rows.earth_a * self._device_ohm
        for k, place in enumerate(self._device_place):
            if place >= 0:
                potential[:, k] = rows.rail_v[:, place]
        append("earthing", earthing_table(time_s, self.devices, potential, rows.earth_a))

    def profile(self) -> pa.Table:
        """Return table ``rail_profile``."""
        longest = self.touch.places[0].longest_s if self.touch.limits else np.full(len(self.sums), np.nan)
        return rail_profile_table(self.places, self.sums, self.leakage(), longest)

    def leakage(self) -> Leakage:
        """Return means at all places over the steps that count."""
        count = np.where(self.sums["count"] > 0, self.sums["count"], np.nan)
        tracks = np.array([len(each.split()) for each in self.places.tracks], np.int64)
        means = self.sums["sum_v"] / count, self.sums["positive_v"] / count
        return Leakage(tracks, self.places.leakage_s_per_m, *means, self.steps * self.step_s)

    def _checks(self) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
        words, supply = self.places.words, self.scenario.supply
        return (
            self.touch.rows(words, self.trains, self.tracks),
            stray_rows(self.leakage(), words, self.scenario.limits, supply.system),
        )

    def verdicts(self) -> list[dict[str, Any]]:
        """Return touch voltages and, of a day, stray currents against their limits."""
        if not self.exists or not self.steps:
            return []
        touch, stray = self._checks()
        return [*touch_verdicts(touch), *stray_verdicts(stray)]

    def summary(self) -> dict[str, Any]:
        """Return what ``run.json`` says of the return circuit; nothing where no earth is defined."""
        if not self.exists or not self.steps:
            return {}
        touch, stray = self._checks()
        return {"return_circuit": {"places": len(self.sums), "touch_voltage": touch, "stray_current": stray}}

    def figures(self) -> Iterator[KeyFigure]:
        """Yield the key figures of rails, earthings and voltage-limiting devices."""
        if self.exists and self.steps:
            yield from rail_figures(self._extremes(), self.leakage(), self.places.words, self.leaked_a, self.step_s)
            yield from spell_figures(self._checks()[0])
        limiting = {device.id for device in self.scenario.supply.voltage_limiting_devices}
        for k, name in enumerate(self.devices if self.steps else ()):
            place = f"voltage-limiting device {name}" if name in limiting else f"earthing {name}"
            magnitude = float(self.device_sums[0, k]), float(self.device_sums[1, k])
            yield from device_figures(place, self.device_a, k, magnitude, self.step_s)

    def _extremes(self) -> RailExtremes:
        """Return the extremes of places and trains."""
        low, high = int(self.sums["lowest_v"].argmin()), int(self.sums["highest_v"].argmax())
        words, fixed = self.places.words, self.sums
        lowest = (float(fixed["lowest_v"][low]), words[low], float(fixed["lowest_s"][low]))
        highest = (float(fixed["highest_v"][high]), words[high], float(fixed["highest_s"][high]))
        return RailExtremes(min(lowest, self._lowest), max(highest, self._highest))


def told_places(places: RailRow, device_km: list[tuple[str, float]]) -> NDArray[np.int64]:
    """Return which places table ``rails`` tells: all of a few, else those some `APART_KM` apart and those of devices.

    `device_km` are track (or none: any) and kilometre of the devices.
    """
    count = len(places.km)
    if count <= MOST_PLACES:
        return np.arange(count)
    kept: list[int] = []
    for tracks in sorted(set(places.tracks)):
        mine = [k for k in range(count) if places.tracks[k] == tracks]
        mine.sort(key=lambda k: places.km[k])
        last = -np.inf
        for k in mine:
            km = float(places.km[k])
            near = any(abs(km - at) < SHARED_NODE_M / 1000.0 and track in ("", *tracks.split()) for track, at in device_km)
            if near or km - last >= APART_KM - 1e-9 or k == mine[-1]:
                kept.append(k)
                last = km
    return np.array(sorted(kept), np.int64)


def _device_km(scenario: Scenario) -> list[tuple[str, float]]:
    supply = scenario.supply
    stations = [("", each.km) for each in supply.substations] + [("", each.km) for each in supply.section_cabins]
    earthed = [(each.track or "", each.km) for each in supply.earthing if each.km is not None]
    return stations + earthed + [(each.track, each.km) for each in supply.voltage_limiting_devices]


def _device_sides(scenario: Scenario, devices: tuple[str, ...], places: RailRow) -> tuple[Array, list[int]]:
    """Return the resistances of earthings [ohm], not a number of others, and the place of each voltage-limiting device or -1.

    The potential of an earthing is its current times its resistance; an open device has no current, but its rails a potential.
    """
    supply = scenario.supply
    ohm = {each.id: each.resistance_ohm for each in supply.earthing}
    limiting = {each.id: each for each in supply.voltage_limiting_devices}
    at = [_place_of(places, limiting[name].track, limiting[name].km) if name in limiting else -1 for name in devices]
    return np.array([ohm.get(name, np.nan) for name in devices]), at


def _place_of(places: RailRow, track: str, km: float) -> int:
    near = np.flatnonzero(np.abs(places.km - km) < SHARED_NODE_M / 1000.0).tolist()
    return next((k for k in near if track in places.tracks[k].split()), -1)
