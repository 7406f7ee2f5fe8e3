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

Array = NDArray[Any]
Coded = tuple[Any, Sequence[str]]
"""Texts as codes and the names that they stand for."""

KMH_PER_MPS = 3.6
J_PER_KWH = 3.6e6

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


def trains_table(rows: NDArray[np.void], train: Coded, track: Coded, km: Array) -> pa.Table:
    """Return the rows of table ``trains``.

    Parameters
    ----------
    rows
        Records of `tractionpower.kernels.train_tables.TRAIN_ROW`, SI.
    train, track
        Train and track of each row, as (codes, names).
    km
        Place of the front [km].
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


def train_figures(
    train: str, rows: NDArray[np.void], seconds: Array, *, length_m: float, journey_s: float, running_s: float
) -> Iterator[KeyFigure]:
    """Yield the key figures of one journey.

    Parameters
    ----------
    train
        Identifier of the run.
    rows
        Records of `TRAIN_ROW`.
    seconds
        What each row lasts [s].
    length_m
        Distance that the train ran [m].
    journey_s, running_s
        Time from the start to the end, with stops and without [s].
    """
    place = f"train {train}"
    yield KeyFigure("length_km", length_m / 1000.0, place, "", "distance run")
    yield KeyFigure("running_time_s", running_s, place, "", "from start to end, without the time at stops")
    yield KeyFigure("journey_time_s", journey_s, place, "", "from start to end, stops included")
    mean = length_m / running_s if running_s > 0.0 else 0.0
    yield KeyFigure("mean_speed_kmh", mean * KMH_PER_MPS, place, "", "distance run over the running time")
    fastest = int(rows["v_mps"].argmax())
    when = format_time(rows["time_s"][fastest])
    yield KeyFigure("highest_speed_kmh", float(rows["v_mps"][fastest]) * KMH_PER_MPS, place, when, "at the start of a step")
    taken_w = rows["power_w"] + rows["returned_w"]
    yield KeyFigure("energy_taken_kwh", float(taken_w @ seconds) / J_PER_KWH, place, "", "taken from the line")
    yield KeyFigure("energy_returned_kwh", float(rows["returned_w"] @ seconds) / J_PER_KWH, place, "", "fed back into the line")
    most = int(rows["current_a"].argmax())
    when = format_time(rows["time_s"][most])
    yield KeyFigure("highest_current_a", float(rows["current_a"][most]), place, when, "highest mean of a step")
