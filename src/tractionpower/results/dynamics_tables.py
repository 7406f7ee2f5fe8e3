"""From recorded rows of a train as many vehicles to tables for the world: here newtons become kilonewtons, pascals bar."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.results.tables import make_table

Array = NDArray[Any]
Cycles = Mapping[tuple[float, float], float]
"""How many rainflow cycles there are by range and mean [kN]."""

KN, BAR, KWH, KMH = 1e3, 1e5, 3.6e6, 1.0 / 3.6

ENERGIES = {
    "traction_kwh": "traction_j",
    "electric_kwh": "electric_j",
    "brake_kwh": "brake_j",
    "resistance_kwh": "resistance_j",
    "gravity_kwh": "grade_j",
    "coupling_kwh": "coupling_j",
}
"""Columns of table ``controls`` that are works, and where they come from."""

SPEED, FORCE, ACCELERATION = 0, 1, 2
"""Rows of the record array of bins."""


def vehicles_table(time_s: Array, names: Sequence[str], rows: Array, start_m: Array) -> pa.Table:
    """Return the rows of table ``vehicles``.

    Parameters
    ----------
    time_s
        Times [s], shape (rows,).
    names
        Vehicles from the front, length n.
    rows
        Records of `tractionpower.kernels.chain_state.VEHICLE_ROW`, shape (rows, n).
    start_m
        Places of the vehicles at the start [m], shape (n,).
    """
    columns = {
        "position_m": rows["s_m"],
        "speed_kmh": rows["v_mps"] / KMH,
        "acceleration_mps2": rows["a_mps2"],
        "relative_position_m": relative_m(rows, start_m),
        "tractive_force_kn": rows["traction_n"] / KN,
        "electric_brake_force_kn": rows["electric_n"] / KN,
        "brake_force_kn": rows["brake_n"] / KN,
        "resistance_kn": rows["resistance_n"] / KN,
        "grade_force_kn": rows["grade_n"] / KN,
        "cylinder_pressure_bar": rows["cylinder_pa"] / BAR,
    }
    return make_table("vehicles", _by_thing(time_s, "vehicle", names) | {name: v.ravel() for name, v in columns.items()})


def relative_m(rows: Array, start_m: Array) -> Array:
    """Return how far each vehicle has moved against the first one since the start [m], shape (rows, n)."""
    moved = rows["s_m"] - start_m
    return np.asarray(moved - moved[:, :1])


def couplings_table(time_s: Array, names: Sequence[str], rows: Array) -> pa.Table:
    """Return the rows of table ``couplings`` from records of `LINK_ROW`, shape (rows, couplings)."""
    columns = {"force_kn": rows["force_n"] / KN, "deflection_mm": rows["stretch_m"] * 1e3, "rate_mps": rows["rate_mps"]}
    return make_table("couplings", _by_thing(time_s, "coupling", names) | {name: v.ravel() for name, v in columns.items()})


def controls_table(rows: Array, kinetic_j: Array) -> pa.Table:
    """Return the rows of table ``controls`` from records of `CHAIN_ROW`, and the kinetic energy at each of them [J]."""
    return make_table(
        "controls",
        {
            "time_s": rows["time_s"],
            "drive": rows["drive"],
            "brake": rows["brake"],
            "electric_percent": rows["electric"] * 100.0,
            "independent_bar": rows["independent_pa"] / BAR,
            "reduction_bar": rows["reduction_pa"] / BAR,
            **{name: rows[joule] / KWH for name, joule in ENERGIES.items()},
            "kinetic_kwh": kinetic_j / KWH,
        },
    )


def kinetic_j(speed_mps: Array, inertia_kg: Array) -> Array:
    """Return the kinetic energy of all vehicles with their rotating parts [J]; speeds of shape (..., vehicles)."""
    return np.asarray(0.5 * (speed_mps * speed_mps) @ inertia_kg)


def coupling_extremes_table(names: Sequence[str], links: Array, damage: Array | None = None) -> pa.Table:
    """Return the rows of table ``coupling_extremes``.

    Parameters
    ----------
    names
        Couplings, length n.
    links
        Records of `LINK` at the end, shape (n,).
    damage
        Relative damage of each, shape (n,); None where no cycles were counted.
    """
    pulled, pushed = links["greatest_n"] > 0.0, links["least_n"] < 0.0
    return make_table(
        "coupling_extremes",
        {
            "coupling": (np.arange(len(names)), list(names)),
            "greatest_tension_kn": np.where(pulled, links["greatest_n"], 0.0) / KN,
            "tension_at_s": np.where(pulled, links["greatest_at_s"], np.nan),
            "greatest_compression_kn": np.where(pushed, -links["least_n"], 0.0) / KN,
            "compression_at_s": np.where(pushed, links["least_at_s"], np.nan),
            "absorbed_kj": links["absorbed_j"] / 1e3,
            "damper_kj": links["damper_j"] / 1e3,
            "damage": np.full(len(names), np.nan) if damage is None else damage,
        },
    )


def distributions_table(times_s: Mapping[str, Array], bins: Array) -> pa.Table:
    """Return the rows of table ``distributions``; the frequencies of each distribution add up to 1.

    Parameters
    ----------
    times_s
        Time spent [s]: ``drive_speed`` and ``brake_speed`` at a level (rows) and a speed (columns of its bins, one more at
        either end), ``coupler_force`` and ``acceleration`` in bins. One in which no time was spent is left out.
    bins
        Records of `HISTOGRAM`: of speed, force and acceleration.
    """
    of = {
        "drive_speed": (SPEED, KMH),
        "brake_speed": (SPEED, KMH),
        "coupler_force": (FORCE, KN),
        "acceleration": (ACCELERATION, 1.0),
    }
    pieces: dict[str, list[Array]] = {"code": [], "level": [], "lowest": [], "highest": [], "frequency": []}
    for code, (name, (row, unit)) in enumerate(of.items()):
        spent = np.asarray(times_s[name], float)
        if not spent.sum() > 0.0:
            continue
        lowest, highest = bin_ends(bins[row])
        levels = np.arange(len(spent), dtype=float) if spent.ndim == 2 else np.array([np.nan])
        pieces["code"].append(np.full(spent.size, code))
        pieces["level"].append(np.repeat(levels, len(lowest)))
        pieces["lowest"].append(np.tile(lowest / unit, len(levels)))
        pieces["highest"].append(np.tile(highest / unit, len(levels)))
        pieces["frequency"].append((spent / spent.sum()).ravel())
    columns = {name: np.concatenate(parts) if parts else np.empty(0) for name, parts in pieces.items()}
    codes = columns.pop("code").astype(np.int32)
    return make_table("distributions", columns | {"of": (codes, list(of))})


def bin_ends(bins: Any) -> tuple[Array, Array]:
    """Return lower and upper ends of bins, the open ones at either end included; NaN where there is no end."""
    edges = bins["from_"] + bins["width"] * np.arange(int(bins["bins"]) + 1)
    return np.concatenate([[np.nan], edges]), np.concatenate([edges, [np.nan]])


def rainflow_table(names: Sequence[str], cycles: Sequence[Cycles]) -> pa.Table:
    """Return the rows of table ``rainflow``: the cycles of each coupling, the greatest range first."""
    rows = list(_cycle_rows(cycles))
    numbers = np.array([row[1:] for row in rows], float).reshape(-1, 3)
    return make_table(
        "rainflow",
        {
            "coupling": (np.array([row[0] for row in rows], np.int32), list(names)),
            "range_kn": numbers[:, 0],
            "mean_kn": numbers[:, 1],
            "cycles": numbers[:, 2],
        },
    )


def _cycle_rows(cycles: Sequence[Cycles]) -> Iterator[tuple[int, float, float, float]]:
    for number, counted in enumerate(cycles):
        for (range_kn, mean_kn), count in sorted(counted.items(), key=lambda item: (-item[0][0], item[0][1])):
            yield number, range_kn, mean_kn, count


def _by_thing(time_s: Array, key: str, names: Sequence[str]) -> dict[str, Any]:
    return {"time_s": np.repeat(time_s, len(names)), key: (np.tile(np.arange(len(names)), len(time_s)), list(names))}
