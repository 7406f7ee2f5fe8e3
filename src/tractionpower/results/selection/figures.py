"""Key figures of rows that are stored: the same as a run gives, of the part that is selected."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.model.base import format_time
from tractionpower.results.extremes import Extremes
from tractionpower.results.key_figures import (
    KeyFigure,
    PlantSums,
    SubstationWindows,
    load_figures,
    plant_figures,
    substation_figures,
    window_figures,
)
from tractionpower.results.trains import KMH_PER_MPS, SupplySummary, TrainSummary, supply_figures, train_figures
from tractionpower.results.useful_voltage import Means, UsefulVoltage
from tractionpower.results.windows import SlidingWindows

Array = NDArray[np.float64]

Useful = tuple[Means, Array, Array, Array]
"""Mean useful voltages of all trains, and what `UsefulVoltage.energies` tells of them."""

STANDS = ("dwelling", "waiting")
"""Phases in which a train stands at a stop."""


def substations_of(rows: pd.DataFrame, step_s: float) -> Iterator[KeyFigure]:
    """Yield the key figures of substations from rows of table ``substations``."""
    time_s, names, current_a = by_device(rows, ("substation",), "current_a")
    power_w = by_device(rows, ("substation",), "power_kw")[2] * 1000.0
    current, power, windows = Extremes(len(names)), Extremes(len(names)), SubstationWindows.of(len(names), step_s)
    current.add(time_s, current_a)
    power.add(time_s, power_w)
    windows.add(time_s, current_a, power_w)
    plants = PlantSums.of(len(names))
    of_plants = (("regulation_kw", plants.regulation), ("loss_kw", plants.heat))
    for column, sums in of_plants:
        sums.add(time_s, by_device(rows, ("substation",), column)[2] * 1000.0)
    plants.voltage.add(time_s, by_device(rows, ("substation",), "voltage_v")[2])
    plants.fed_back.add(time_s, np.minimum(power_w, 0.0))
    yield from substation_figures(names, current, power, step_s)
    yield from plant_figures(names, plants, [bool((power_w[:, k] < -1.0).any()) for k in range(len(names))], step_s)
    yield from window_figures(names, windows)


def loads_of(rows: pd.DataFrame, step_s: float) -> Iterator[KeyFigure]:
    """Yield the key figures of fixed loads from rows of table ``loads``."""
    time_s, names, power_kw = by_device(rows, ("load",), "power_kw")
    power = Extremes(len(names))
    power.add(time_s, power_kw * 1000.0)
    yield from load_figures(names, power, step_s)


def feeders_of(rows: pd.DataFrame) -> Iterator[KeyFigure]:
    """Yield the key figures of feeders from rows of table ``feeders``."""
    time_s, names, current_a = by_device(rows, ("substation", "track", "side"), "current_a")
    magnitude = Extremes(len(names))
    magnitude.add(time_s, np.abs(current_a))
    for k, name in enumerate(names):
        when = format_time(magnitude.highest_s[k])
        definition = "highest mean of a step, in either direction"
        yield KeyFigure("highest_current_a", float(magnitude.highest[k]), f"feeder {name}", when, definition)
        definition = "root of the mean square over the run"
        yield KeyFigure("rms_current_a", float(magnitude.rms[k]), f"feeder {name}", "", definition)


def trains_of(
    rows: pd.DataFrame, calls: pd.DataFrame | None, ways: Mapping[str, Mapping[str, Any]], step_s: float
) -> Iterator[KeyFigure]:
    """Yield the key figures of trains from rows of table ``trains`` and, where there are any, their calls.

    `ways` tell of each train when it entered and when it finished [s after midnight]: within a step, which counts in part.
    """
    train = rows["train"].astype("category").cat.remove_unused_categories()
    names, code = [str(name) for name in train.cat.categories], train.cat.codes.to_numpy().astype(np.int64)
    late = _late(calls)
    sums = _useful(rows, code, len(names), step_s)
    useful = sums.of_trains(), *sums.energies()
    order = np.argsort(code, kind="stable")
    ends = np.searchsorted(code[order], np.arange(len(names) + 1))
    for k, name in enumerate(names):
        own = rows.iloc[order[ends[k] : ends[k + 1]]].sort_values("time_s", kind="stable")
        yield from train_figures(_summary(name, own, ways.get(name, {}), step_s))
        yield from supply_figures(_supply(name, own, step_s, late.get(name, np.nan), useful, k))


def voltages_of(trains: pd.DataFrame | None, loads: pd.DataFrame | None) -> Iterator[KeyFigure]:
    """Yield the lowest and the highest voltage at the pantographs of trains and at fixed loads."""
    for which, pick in (("lowest", "idxmin"), ("highest", "idxmax")):
        found = []
        for rows, subject in ((trains, "train"), (loads, "load")):
            known = None if rows is None else rows[rows["voltage_v"].notna()]
            if known is not None and len(known):
                row = known.loc[getattr(known["voltage_v"], pick)()]
                where = f", track {row['track']}, km {row['position_km']:.2f}" if subject == "train" else ""
                found.append((float(row["voltage_v"]), f"{subject} {row[subject]}{where}", float(row["time_s"])))
        if found:
            volts, place, when_s = (min if which == "lowest" else max)(found)
            definition = f"{which} mean of a step between contact line and rail, at trains and loads of the part"
            yield KeyFigure(f"{which}_voltage_v", volts, place, format_time(when_s), definition)


def by_device(rows: pd.DataFrame, keys: Sequence[str], value: str) -> tuple[Array, Sequence[str], Array]:
    """Return times [s], names of devices and values of shape (times, devices) of a table with a row for each of both.

    Columns `keys`, joined by blanks, name a device.
    """
    time_s, at = np.unique(rows["time_s"].to_numpy(float), return_inverse=True)
    number = rows.groupby(list(keys), observed=True, sort=True).ngroup().to_numpy()
    first = rows.iloc[np.unique(number, return_index=True)[1]]
    values = np.full((len(time_s), len(first)), np.nan)
    values[at, number] = rows[value].to_numpy(float)
    return time_s, [" ".join(map(str, words)) for words in first[list(keys)].itertuples(index=False)], values


def _summary(name: str, rows: pd.DataFrame, way: Mapping[str, Any], step_s: float) -> TrainSummary:
    time_s, speed, current = (rows[column].to_numpy(float) for column in ("time_s", "speed_kmh", "current_a"))
    fastest, most = int(speed.argmax()), int(current.argmax())
    power_kw, returned_kw = (float(rows[column].to_numpy(float).sum()) for column in ("power_kw", "returned_kw"))
    last = rows.iloc[-1]
    last_s = _part(last["time_s"], way.get("finished_s"), step_s)
    journey_s = (len(rows) - 1) * step_s + last_s - (step_s - _part(-time_s[0] - step_s, _minus(way.get("entered_s")), step_s))
    standing_s = float(rows["phase"].astype(str).isin(STANDS).sum()) * step_s
    lengths_s = np.append(np.full(len(rows) - 1, step_s), last_s)
    ways_m = (speed / KMH_PER_MPS + 0.5 * rows["acceleration_mps2"].to_numpy(float) * lengths_s) * lengths_s
    follows = np.diff(time_s) < 1.5 * step_s  # else it was beyond the part meanwhile
    ways_m[:-1] = np.where(follows, np.diff(rows["distance_m"].to_numpy(float)), ways_m[:-1])
    return TrainSummary(
        name, float(ways_m.sum()), journey_s, journey_s - standing_s,
        float(speed[fastest]) / KMH_PER_MPS, float(time_s[fastest]),
        (power_kw + returned_kw) * 1000.0 * step_s, returned_kw * 1000.0 * step_s,
        float(current[most]), float(time_s[most]),
    )  # fmt: skip


def _part(begin_s: float, end_s: float | None, step_s: float) -> float:
    """Return how much of a step [s] passes until an event, all of it where that is later, or none."""
    return step_s if end_s is None or not begin_s < end_s < begin_s + step_s else end_s - begin_s


def _minus(value: float | None) -> float | None:
    return None if value is None else -value


def _supply(name: str, rows: pd.DataFrame, step_s: float, late_s: float, useful: Useful, k: int) -> SupplySummary:
    columns = ("auxiliary_power_kw", "drive_loss_kw", "starting_resistor_kw", "refused_regeneration_kw")
    auxiliary_j, drive_j, starting_j, refused_j = (
        float(rows[column].to_numpy(float).sum()) * 1000.0 * step_s for column in columns
    )
    time_s, volts = rows["time_s"].to_numpy(float), rows["voltage_v"].to_numpy(float)
    known = np.where(np.isnan(volts), np.inf, volts)
    least, most = int(known.argmin()), int(np.nan_to_num(volts).argmax())
    means, energy_j, charge_c, mean_v = useful
    ten = SlidingWindows(1, step_s, (10.0,), "lowest")
    for piece in np.split(np.arange(len(rows)), np.flatnonzero(np.diff(time_s) > 1.5 * step_s) + 1):
        ten.add(time_s[piece], np.nan_to_num(volts[piece])[:, np.newaxis])
    found = ten.windows_s and np.isfinite(ten.best[0, 0])
    return SupplySummary(
        name, auxiliary_j, drive_j, starting_j, refused_j, float(known[least]), float(time_s[least]),
        float(ten.best[0, 0]) if found else np.nan, float(ten.best_from_s[0, 0]) if found else np.nan,
        float(volts[most]), float(time_s[most]), float(mean_v[k]),
        means, k, float(energy_j[k]), float(charge_c[k]), late_s,
    )  # fmt: skip


def _useful(rows: pd.DataFrame, train: NDArray[np.integer[Any]], trains: int, step_s: float) -> UsefulVoltage:
    useful = UsefulVoltage(trains, 0)
    volts = np.nan_to_num(rows["voltage_v"].to_numpy(float))
    tractive = rows["tractive_force_kn"].to_numpy(float) > 0.0
    useful.add(train, np.full(len(rows), -1), volts, np.nan_to_num(rows["current_a"].to_numpy(float)), tractive, step_s)
    return useful


def _late(calls: pd.DataFrame | None) -> dict[str, Any]:
    """Return how late each train is at the last call that has a planned time and was reached [s]."""
    if calls is None or calls.empty:
        return {}
    known = calls[calls["late_s"].notna()].sort_values("actual_s", kind="stable")
    return {str(train): float(own["late_s"].iloc[-1]) for train, own in known.groupby("train", observed=True)}
