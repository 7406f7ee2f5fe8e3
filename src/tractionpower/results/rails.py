"""Rails and earth in results: from potentials and conductances to tables and key figures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.model.base import format_time
from tractionpower.results.extremes import Extremes
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.stray import M_PER_KM, Leakage
from tractionpower.results.tables import make_table

Array = NDArray[np.float64]

S_PER_H = 3600.0

FIGURES = {
    "lowest_rail_potential_v": "lowest mean of a step between rails and remote earth, at recorded places and under trains",
    "highest_rail_potential_v": "highest mean of a step between rails and remote earth, at recorded places and under trains",
    "lowest_mean_rail_potential_v": "lowest of the means over the run at recorded places (24 h or more: the day mean)",
    "highest_mean_rail_potential_v": "highest of the means over the run at recorded places (24 h or more: the day mean)",
    "highest_mean_stray_current_ma_per_m": "highest mean over the run of the current that leaves the rails into earth, for each"
    " metre of a single track; steps in which current enters count as zero",
    "mean_leaked_current_a": "current that leaves the rails into earth by leakage, all places together, mean over the run",
    "highest_leaked_current_a": "highest mean of a step of that current",
    "leaked_charge_ah": "sum of that current over the steps",
}
"""Key figures of a run whose rails have a potential, and how they are computed."""

DEVICE_FIGURES = {
    "highest_current_into_earth_a": "highest mean of a step; negative: the current only ever came out of earth",
    "lowest_current_into_earth_a": "lowest mean of a step; negative comes out of earth",
    "mean_current_into_earth_a": "mean over the run",
    "charge_through_earth_ah": "sum of the absolute current over the steps",
    "time_with_earth_current_s": "time in which the device carries current",
}
"""Key figures of an earthing or voltage-limiting device."""

SPELL_FIGURE = "longest unbroken time with a rail potential of either sign above the touch voltage of that name"


@dataclass(frozen=True, slots=True)
class RailRow:
    """Where rail potentials are told: tracks of the return conductor, kilometre [km], conductance [S/m], length [m]."""

    tracks: Sequence[str]
    km: Array
    leakage_s_per_m: Array
    length_m: Array

    def part(self, which: NDArray[np.int64]) -> RailRow:
        """Return some of the places."""
        return RailRow([self.tracks[k] for k in which], self.km[which], self.leakage_s_per_m[which], self.length_m[which])

    @property
    def coded(self) -> tuple[NDArray[np.int64], list[str]]:
        """Tracks as codes and names."""
        known = sorted(set(self.tracks))
        return np.array([known.index(each) for each in self.tracks], np.int64), known

    @property
    def words(self) -> list[str]:
        """Places in words."""
        return [
            f"track{'s' if ' ' in tracks else ''} {tracks}, km {km:.2f}"
            for tracks, km in zip(self.tracks, self.km.tolist(), strict=True)
        ]


def rails_table(time_s: Array, places: RailRow, potential_v: Array) -> pa.Table:
    """Return the rows of table ``rails``: steps at `time_s` [s] with potentials [V] of shape (steps, places)."""
    codes, names = places.coded
    steps = len(time_s)
    leakage = potential_v * (places.leakage_s_per_m * M_PER_KM)
    columns = {
        "time_s": np.repeat(time_s, len(places.km)), "track": (np.tile(codes, steps), names), "km": np.tile(places.km, steps),
        "potential_v": potential_v.ravel(), "leakage_a_per_km": leakage.ravel(),
    }  # fmt: skip
    return make_table("rails", columns)


def rail_profile_table(places: RailRow, sums: NDArray[np.void], leakage: Leakage, longest_s: Array) -> pa.Table:
    """Return table ``rail_profile`` from sums, records of `RAIL_SUM`, and longest spells above the long-term limit [s]."""
    codes, names = places.coded
    order = np.lexsort((places.km, codes))
    known = sums["count"] > 0
    per_km = places.leakage_s_per_m * M_PER_KM
    columns = {
        "km": places.km,
        "lowest_potential_v": np.where(known, sums["lowest_v"], np.nan),
        "mean_potential_v": leakage.mean_v,
        "highest_potential_v": np.where(known, sums["highest_v"], np.nan),
        "mean_leakage_a_per_km": leakage.mean_v * per_km,
        "mean_leaving_a_per_km": leakage.positive_v * per_km,
        "longest_above_limit_s": longest_s,
        "leakage_s_per_km": per_km,
        "length_km": places.length_m / M_PER_KM,
    }
    return make_table(
        "rail_profile", {name: values[order] for name, values in columns.items()} | {"track": (codes[order], names)}
    )


def earthing_table(time_s: Array, devices: Sequence[str], potential_v: Array, current_a: Array) -> pa.Table:
    """Return the rows of table ``earthing``; potentials [V] and currents [A] of shape (steps, devices)."""
    columns = {
        "time_s": np.repeat(time_s, len(devices)),
        "device": (np.tile(np.arange(len(devices)), len(time_s)), list(devices)),
        "potential_v": potential_v.ravel(),
        "current_a": current_a.ravel(),
    }
    return make_table("earthing", columns)


@dataclass(frozen=True, slots=True)
class RailExtremes:
    """Lowest and highest rail potential of a run: value [V], place in words, start of the step [s]."""

    lowest: tuple[float, str, float]
    highest: tuple[float, str, float]


def rail_figures(
    extremes: RailExtremes, leakage: Leakage, places: Sequence[str], leaked_a: Extremes, step_s: float
) -> Iterator[KeyFigure]:
    """Yield the key figures of the rails; `places` are those of `leakage` in words, `leaked_a` is one series [A]."""

    def told(name: str, value: float, place: str = "", when_s: float = np.nan) -> KeyFigure:
        return KeyFigure(name, float(value), place, format_time(when_s) if np.isfinite(when_s) else "", FIGURES[name])

    if np.isfinite(extremes.lowest[0]):  # a part of the network may have lost its earth
        yield told("lowest_rail_potential_v", *extremes.lowest)
        yield told("highest_rail_potential_v", *extremes.highest)
    if np.isfinite(leakage.mean_v).any():
        low, high = int(np.nanargmin(leakage.mean_v)), int(np.nanargmax(leakage.mean_v))
        yield told("lowest_mean_rail_potential_v", leakage.mean_v[low], places[low])
        yield told("highest_mean_rail_potential_v", leakage.mean_v[high], places[high])
        stray = np.where(np.isfinite(leakage.stray_ma_per_m), leakage.stray_ma_per_m, 0.0)
        most = int(stray.argmax())
        yield told("highest_mean_stray_current_ma_per_m", stray[most], places[most] if stray[most] > 0.0 else "")
    if leaked_a.count:
        yield told("mean_leaked_current_a", leaked_a.mean[0])
        yield told("highest_leaked_current_a", leaked_a.highest[0], "", leaked_a.highest_s[0])
        yield told("leaked_charge_ah", leaked_a.total[0] * step_s / S_PER_H)


def spell_figures(rows: Sequence[dict[str, Any]]) -> Iterator[KeyFigure]:
    """Yield the longest spell above each touch voltage, from the rows of `touch.TouchCheck`."""
    for row in rows:
        name = f"longest_spell_above_{row['limit'].replace('.', '_')}_s"
        definition = f"{SPELL_FIGURE}, {row['voltage_v']:g} V"
        yield KeyFigure(name, row["longest_s"], row["place"], row["time"], definition, row["status"])


def device_figures(place: str, current_a: Extremes, k: int, magnitude: tuple[float, float], step_s: float) -> Iterator[KeyFigure]:
    """Yield the key figures of a device: series `k` of the currents [A], sum of its magnitudes [A] and steps with current."""

    def told(name: str, value: float, when_s: float = np.nan) -> KeyFigure:
        return KeyFigure(name, float(value), place, format_time(when_s) if np.isfinite(when_s) else "", DEVICE_FIGURES[name])

    yield told("highest_current_into_earth_a", current_a.highest[k], current_a.highest_s[k])
    yield told("lowest_current_into_earth_a", current_a.lowest[k], current_a.lowest_s[k])
    yield told("mean_current_into_earth_a", current_a.mean[k])
    yield told("charge_through_earth_ah", magnitude[0] * step_s / S_PER_H)
    yield told("time_with_earth_current_s", magnitude[1] * step_s)
