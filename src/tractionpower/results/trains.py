"""Trains in results: from SI to the units of the tables and key figures, codes of phases and limits to names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import LIMITED_BY, PHASES
from tractionpower.model.base import format_time
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.tables import make_table
from tractionpower.results.useful_voltage import Means

Array = NDArray[Any]
Coded = tuple[Any, Sequence[str]]
"""Texts as codes and the names that they stand for."""

KMH_PER_MPS = 3.6
J_PER_KWH = 3.6e6
S_PER_H = 3600.0

_KILO = {
    "tractive_force_kn": "traction_n",
    "electric_brake_force_kn": "electric_brake_n",
    "friction_brake_force_kn": "friction_brake_n",
    "resistance_kn": "resistance_n",
    "wished_force_kn": "wished_n",
    "power_kw": "power_w",
    "auxiliary_power_kw": "auxiliary_w",
    "starting_resistor_kw": "starting_resistor_w",
    "braking_resistor_kw": "braking_resistor_w",
    "refused_regeneration_kw": "refused_w",
    "drive_loss_kw": "drive_loss_w",
    "wheel_power_kw": "wheel_w",
    "returned_kw": "returned_w",
}
"""Columns in thousands, and the fields of `TRAIN_ROW` that they come from."""

_PLAIN = {
    "time_s": "time_s",
    "distance_m": "s_m",
    "acceleration_mps2": "acceleration_mps2",
    "voltage_v": "voltage_v",
    "current_a": "current_a",
}


@dataclass(frozen=True, slots=True)
class CallRow:
    """A row of table ``calls``; times are seconds after midnight [s], NaN where there is none.

    Attributes
    ----------
    train, station
        Identifiers of the train's run and of the station.
    kind
        ``arrival``, ``departure`` or ``pass``.
    planned_s, actual_s
        Planned (RJ) and computed (PT) time.
    dwell_s
        Time that the train stood there, of departures.
    """

    train: str
    station: str
    kind: str
    planned_s: float = np.nan
    actual_s: float = np.nan
    dwell_s: float = np.nan

    @property
    def late_s(self) -> float:
        """Computed less planned time [s]; NaN where one of them is missing."""
        return self.actual_s - self.planned_s


def trains_table(rows: NDArray[np.void], train: Coded, track: Coded, km: Array, rail_v: Array | None = None) -> pa.Table:
    """Return the rows of table ``trains``.

    Parameters
    ----------
    rows
        Records of `tractionpower.kernels.train_tables.TRAIN_ROW`, SI.
    train, track
        Train and track of each row, as (codes, names).
    km
        Place of the front [km].
    rail_v
        Potential of the rails under the train [V]; None where nothing defines remote earth.
    """
    columns: dict[str, Any] = {name: rows[field] for name, field in _PLAIN.items()}
    columns |= {name: rows[field] / 1000.0 for name, field in _KILO.items()}
    columns |= {
        "train": train,
        "track": track,
        "position_km": km,
        "speed_kmh": rows["v_mps"] * KMH_PER_MPS,
        "phase": (rows["phase"], PHASES),
        "limited_by": (rows["limited_by"], LIMITED_BY),
        "rail_potential_v": np.full(len(rows), np.nan) if rail_v is None else rail_v,
    }
    return make_table("trains", columns)


def calls_table(calls: Sequence[CallRow]) -> pa.Table:
    """Return table ``calls``."""
    columns: dict[str, Any] = {
        name: np.array([getattr(call, name) for call in calls], float) for name in ("planned_s", "actual_s", "dwell_s", "late_s")
    }
    for name in ("train", "station", "kind"):
        words = [getattr(call, name) for call in calls]
        known = sorted(set(words))
        columns[name] = ([known.index(word) for word in words], known)
    return make_table("calls", columns)


@dataclass(frozen=True, slots=True)
class TrainSummary:
    """What one train did, summed up.

    Attributes
    ----------
    train
        Identifier of the run.
    length_m
        Distance that the train ran [m].
    journey_s, running_s
        Time from the start to the end, with stops and without [s]; both without what lies before the clock or in its warm-up.
    highest_mps, highest_mps_s
        Highest speed at the start of a step [m/s], and when [s after midnight].
    taken_j, returned_j
        Energy taken from the line and fed back [J].
    highest_a, highest_a_s
        Highest mean current of a step [A], and when [s after midnight].
    """

    train: str
    length_m: float
    journey_s: float
    running_s: float
    highest_mps: float
    highest_mps_s: float
    taken_j: float
    returned_j: float
    highest_a: float
    highest_a_s: float


def sum_up(
    train: str, rows: NDArray[np.void], seconds: Array, *, length_m: float, journey_s: float, running_s: float
) -> TrainSummary:
    """Return the summary of one train from its rows, records of `TRAIN_ROW` that last `seconds` [s] each."""
    fastest, most = int(rows["v_mps"].argmax()), int(rows["current_a"].argmax())
    return TrainSummary(
        train, length_m, journey_s, running_s,
        float(rows["v_mps"][fastest]), float(rows["time_s"][fastest]),
        float((rows["power_w"] + rows["returned_w"]) @ seconds), float(rows["returned_w"] @ seconds),
        float(rows["current_a"][most]), float(rows["time_s"][most]),
    )  # fmt: skip


def train_figures(summary: TrainSummary) -> Iterator[KeyFigure]:
    """Yield the key figures of one train."""
    place, running_s = f"train {summary.train}", summary.running_s
    yield KeyFigure(
        "length_km", summary.length_m / 1000.0, place, "", "distance run, since the start of the clock and its warm-up"
    )
    yield KeyFigure(
        "running_time_s",
        running_s,
        place,
        "",
        "from start to end, without the time at stops; what lies before the clock or in its warm-up is left out",
    )
    yield KeyFigure(
        "journey_time_s",
        summary.journey_s,
        place,
        "",
        "from start to end, stops included; what lies before the clock or in its warm-up is left out",
    )
    mean = summary.length_m / running_s if running_s > 0.0 else 0.0
    yield KeyFigure("mean_speed_kmh", mean * KMH_PER_MPS, place, "", "distance run over the running time")
    when = format_time(summary.highest_mps_s)
    yield KeyFigure("highest_speed_kmh", summary.highest_mps * KMH_PER_MPS, place, when, "at the start of a step")
    yield KeyFigure("energy_taken_kwh", summary.taken_j / J_PER_KWH, place, "", "taken from the line")
    yield KeyFigure("energy_returned_kwh", summary.returned_j / J_PER_KWH, place, "", "fed back into the line")
    when = format_time(summary.highest_a_s)
    yield KeyFigure("highest_current_a", summary.highest_a, place, when, "highest mean of a step")


@dataclass(frozen=True, slots=True)
class SupplySummary:
    """How one train fared on the supply that feeds it.

    Attributes
    ----------
    train
        Identifier of the run.
    auxiliary_j, drive_loss_j, starting_resistor_j, refused_j
        Energies of auxiliaries, of losses between pantograph and wheel, in starting resistors, and what the line did not
        take back [J].
    lowest_v, lowest_s
        Lowest mean voltage of a step [V], and when [s after midnight].
    ten_seconds_v, ten_seconds_s
        Lowest mean over 10 s [V] and when it begins [s]; NaN where the train was not so long on the line.
    highest_v, highest_s
        Highest mean voltage of a step [V], and when [s after midnight].
    mean_v
        Mean voltage of all steps with a voltage [V].
    useful, number
        Mean useful voltages of all trains, and the number of this one among them.
    useful_j, useful_c
        Sums U |I| dt [J] and |I| dt [C].
    late_s
        Computed less planned time at its last call with a planned time [s]; NaN without one.
    """

    train: str
    auxiliary_j: float
    drive_loss_j: float
    starting_resistor_j: float
    refused_j: float
    lowest_v: float
    lowest_s: float
    ten_seconds_v: float
    ten_seconds_s: float
    highest_v: float
    highest_s: float
    mean_v: float
    useful: Means
    number: int
    useful_j: float
    useful_c: float
    late_s: float


def supply_figures(summary: SupplySummary) -> Iterator[KeyFigure]:
    """Yield the key figures of one train that a run with the network adds."""
    place = f"train {summary.train}"
    energies = {
        "auxiliary_energy_kwh": (summary.auxiliary_j, "auxiliaries and heating"),
        "drive_loss_kwh": (summary.drive_loss_j, "between pantograph and wheel, without resistors"),
        "starting_resistor_energy_kwh": (summary.starting_resistor_j, "heat in starting resistors"),
        "refused_energy_kwh": (summary.refused_j, "of the electric brake that the line did not take"),
    }
    for name, (joule, definition) in energies.items():
        yield KeyFigure(name, joule / J_PER_KWH, place, "", definition)
    when = format_time(summary.lowest_s)
    yield KeyFigure("lowest_pantograph_voltage_v", summary.lowest_v, place, when, "lowest mean of a step at the pantograph")
    if np.isfinite(summary.ten_seconds_v):
        when = format_time(summary.ten_seconds_s)
        yield KeyFigure("lowest_10_s_mean_voltage_v", summary.ten_seconds_v, place, when, "lowest sliding mean over 10 s")
    when = format_time(summary.highest_s)
    yield KeyFigure("highest_pantograph_voltage_v", summary.highest_v, place, when, "highest mean of a step at the pantograph")
    yield KeyFigure("mean_pantograph_voltage_v", summary.mean_v, place, "", "mean of all steps with a voltage, at the pantograph")
    yield from useful_figures(place, summary.useful, summary.number)
    if summary.useful_c > 0.0:
        definition = "sum U |I| dt; over useful_charge_ah: the mean useful voltage, current-weighted"
        yield KeyFigure("useful_energy_kwh", summary.useful_j / J_PER_KWH, place, "", definition)
        yield KeyFigure("useful_charge_ah", summary.useful_c / S_PER_H, place, "", "sum |I| dt")
    if np.isfinite(summary.late_s):
        definition = "computed less planned time at the last timed call reached; if another is overdue, the time since it"
        yield KeyFigure("late_at_end_s", summary.late_s, place, "", definition)


def useful_figures(place: str, means: Means, k: int) -> Iterator[KeyFigure]:
    """Yield the mean useful voltage of train or zone `k` by both definitions, and what they are quotients of, as far as known."""
    is_train = place.startswith("train ")
    steps = "steps with traction effort" if is_train else "all trains and steps"
    definitions = {
        "mean_useful_voltage_current_weighted_v": (
            means.current_weighted_v[k],
            "mean useful voltage, current-weighted: sum U |I| dt / sum |I| dt"
            + ("" if is_train else ", every train divided by its time in the zone"),
        ),
        "mean_useful_voltage_time_mean_v": (means.time_mean_v[k], f"mean useful voltage, time mean: over {steps}"),
    }
    for name, (volts, definition) in definitions.items():
        if np.isfinite(volts):
            yield KeyFigure(name, float(volts), place, "", definition)
    if not is_train and means.current_a[k] > 0.0:
        definition = "sum over trains of their mean U |I| in the zone; over useful_current_a: the mean useful voltage"
        yield KeyFigure("useful_power_kw", float(means.power_w[k]) / 1000.0, place, "", definition)
        definition = "sum over trains of their mean |I| in the zone"
        yield KeyFigure("useful_current_a", float(means.current_a[k]), place, "", definition)
    if means.counted_s[k] > 0.0:
        definition = f"sum U dt over {steps}; over time_of_useful_steps_s: the mean useful voltage, time mean"
        yield KeyFigure("voltage_of_useful_steps_vs", float(means.voltage_time_vs[k]), place, "", definition)
        yield KeyFigure("time_of_useful_steps_s", float(means.counted_s[k]), place, "", f"time of {steps}")
