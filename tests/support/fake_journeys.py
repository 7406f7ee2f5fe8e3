"""Journeys and curves made by hand, for tests of tables, figures and commands that need no true motion."""

import itertools
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.path import compile_path
from tractionpower.kernels.train_tables import ACCELERATING, BRAKING, BY_DRIVE, DWELLING, PIECE, TRAIN_ROW
from tractionpower.model.line import Line
from tractionpower.model.timetable import Leg, TrainRun
from tractionpower.movement.ledgers import TrainLedger

STATIONS = [("A", "Alfa", 0.5), ("B", "Bravo", 6.0), ("C", "Ćma Wielka", 6.4), ("D", "Delta", 12.0)]


def make_line(**more: Any) -> Line:
    """Return two tracks of 12.5 km with four stations, hills, and speed limits."""
    plain: dict[str, Any] = {
        "tracks": [{"id": name, "from_km": 0.0, "to_km": 12.5} for name in ("1", "2")],
        "stations": [{"id": short, "name": name, "km": km} for short, name, km in STATIONS],
        "gradients": [
            {"from_km": 0.0, "to_km": 4.0, "permille": 2.0},
            {"from_km": 4.0, "to_km": 9.0, "permille": 8.0},
            {"from_km": 9.0, "to_km": 12.5, "permille": -5.0},
        ],
        "speed_limits": [
            {"from_km": 0.0, "to_km": 5.0, "kmh": 120.0},
            {"from_km": 5.0, "to_km": 7.0, "kmh": 80.0},
            {"from_km": 7.0, "to_km": 12.5, "kmh": 120.0},
        ],
        "train_current_limits": [{"from_km": 0.0, "to_km": 5.0, "max_current_a": 1500.0, "tracks": ["1"]}],
    }
    return Line.model_validate(plain | more)


@dataclass(frozen=True)
class FakeCall:
    station: str
    kind: str
    planned_arrival_s: float | None
    planned_departure_s: float | None
    arrival_s: float
    departure_s: float
    at_m: float


@dataclass(frozen=True)
class FakeJourney:
    run: TrainRun
    path: Any
    rows: Any
    calls: tuple[FakeCall, ...]
    status: str = "complete"
    start_s: float = 0.0
    finished_s: float = 0.0
    ceiling: Any = None

    @property
    def seconds(self) -> Any:
        return np.diff(self.rows["time_s"], append=self.rows["time_s"][-1] + 1.0)

    def ledgers(self) -> dict[str, TrainLedger]:
        return {"mechanical": TrainLedger({"wheel": -1.0, "kinetic": 1.0}, 1e-3)}


def make_journey(
    line: Line, name: str = "1", *, backwards: bool = False, start_s: float = 6 * 3600.0, stuck_m: float | None = None
) -> FakeJourney:
    """Return a train from one end of the line to the other with a stop at Bravo; its motion is a sine of the distance."""
    km = (12.0, 0.5) if backwards else (0.5, 12.0)
    leg = Leg(track="2" if backwards else "1", from_km=km[0], to_km=km[1])
    run = TrainRun.model_validate(
        {"id": name, "train": "t", "route": [leg.model_dump()], "calls": [{"station": "A", "departure": start_s}]}
    )
    path = compile_path(line, compile_axes(line), [leg], None, 200.0)
    halt = path.distance(leg.track, 6.0)
    first, second = _run(0.0, halt, start_s), _run(halt, path.length_m, 0.0)
    arrived = first["time_s"][-1] + 1.0
    stood = np.zeros(30, TRAIN_ROW)
    stood["time_s"], stood["s_m"] = arrived + np.arange(30), halt
    stood["phase"], stood["voltage_v"], stood["current_a"], stood["power_w"] = DWELLING, 3000.0, 30.0, 90e3
    second["time_s"] += arrived + 30.0
    rows = np.concatenate([first, stood, second])
    end = float(rows["time_s"][-1] + 1.0)
    status = "complete"
    if stuck_m is not None:
        rows, status = rows[rows["s_m"] < stuck_m].copy(), "stuck"
        rows["v_mps"][-1], rows["traction_n"][-1], rows["resistance_n"][-1], rows["limited_by"][-1] = 0.0, 0.0, 9e3, 6
        end = float(rows["time_s"][-1] + 1.0)
    nan = float("nan")
    reached = [place < rows["s_m"][-1] + 20.0 for place in (0.0, halt, path.length_m)]
    stop, last = ("D", "A") if backwards else ("A", "D")
    came = arrived if reached[1] else nan
    calls = (
        FakeCall(stop, "stop", None, start_s, nan, start_s, 0.0),
        FakeCall("B", "stop", start_s + 300.0, start_s + 330.0, came, came + 30.0, halt),
        FakeCall("C", "pass", None, None, nan, nan, halt + 400.0),
        FakeCall(last, "stop", start_s + 660.0, None, end if reached[2] else nan, nan, path.length_m),
    )
    return FakeJourney(run, path, rows, calls, status, start_s, end, ceiling=_ceiling([0.0, halt, path.length_m]))


def _ceiling(stops_m: list[float]) -> Any:
    """Return 33 m/s, and braking curves with 0.5 m/s2 to the stops."""
    rows = []
    for begin, stop in itertools.pairwise(stops_m):
        rows += [(begin, 33.0**2, 0.0), (stop - 33.0**2, 33.0**2, -1.0)]
    return np.array([*rows, (stops_m[-1], 0.0, 0.0)], PIECE)


def _run(begin_m: float, end_m: float, start_s: float) -> Any:
    """Return rows of a run from one stop to the next, in steps of a second, at 32 m/s at most."""
    length = end_m - begin_m
    seconds = int(length / 20.0)
    s = begin_m + length * 0.5 * (1.0 - np.cos(np.pi * np.arange(seconds + 1) / seconds))
    v = length * 0.5 * np.pi / seconds * np.sin(np.pi * np.arange(seconds + 1) / seconds)
    rows = np.zeros(seconds, TRAIN_ROW)
    rows["time_s"], rows["s_m"], rows["v_mps"] = start_s + np.arange(seconds), s[:-1], v[:-1]
    rows["acceleration_mps2"] = np.diff(v)
    rows["resistance_n"] = 9e3 + 20.0 * rows["v_mps"] ** 2
    effort = 400e3 * rows["acceleration_mps2"] + rows["resistance_n"]
    rows["traction_n"] = rows["wished_n"] = np.maximum(effort, 0.0)
    rows["electric_brake_n"] = np.minimum(np.maximum(-effort, 0.0), 60e3)
    rows["friction_brake_n"] = np.maximum(-effort, 0.0) - rows["electric_brake_n"]
    rows["wheel_w"] = rows["traction_n"] * rows["v_mps"]
    rows["returned_w"] = 0.8 * rows["electric_brake_n"] * rows["v_mps"]
    rows["drive_loss_w"], rows["auxiliary_w"] = rows["wheel_w"] * 0.15, 90e3
    rows["voltage_v"], rows["power_w"] = 3000.0, rows["wheel_w"] * 1.15 + 90e3 - rows["returned_w"]
    rows["current_a"] = rows["power_w"] / rows["voltage_v"]
    rows["phase"], rows["limited_by"] = np.where(effort >= 0.0, ACCELERATING, BRAKING), BY_DRIVE
    return rows


@dataclass(frozen=True)
class FakeCurve:
    voltage_v: float
    effort_n: Any
    current_a: Any


@dataclass(frozen=True)
class FakeCurves:
    train: str = "loco"
    speed_mps: Any = field(default_factory=lambda: np.linspace(0.0, 160.0 / 3.6, 81))
    curves: tuple[FakeCurve, ...] = ()
    adhesion_n: Any = None
    resistance_n: Any = None
    electric_brake_n: Any = None
    mass_kg: float = 484e3
    length_m: float = 260.0
    notches: tuple[Any, ...] = ()


def make_curves(voltages_v: Any = (2000.0, 2400.0, 2700.0, 3000.0, 3300.0, 3600.0)) -> FakeCurves:
    """Return curves of a constant-power drive with 200 kN, whose power grows with the voltage up to 3000 V."""
    v = np.linspace(0.0, 160.0 / 3.6, 81)
    curves = []
    for volts in voltages_v:
        power = 4e6 * min(1.0, max(volts - 2000.0, 0.0) / 1000.0)
        effort = np.minimum(200e3, power / np.maximum(v, 0.1)) if power else 0.0 * v
        curves.append(FakeCurve(volts, effort, (effort * v / 0.85 + 100e3) / volts))
    weight = 484e3 * 9.81
    level = 7e3 + 9.0 * v**2
    return FakeCurves(
        speed_mps=v,
        curves=tuple(curves),
        adhesion_n=84e3 * 9.81 * (7.5 / (3.6 * v + 44.0) + 0.161),
        resistance_n={p: level + weight * p / 1000.0 for p in (0.0, 5.0, 10.0, 20.0)},
        electric_brake_n=np.minimum(120e3, 2.5e6 / np.maximum(v, 0.1)) * (v > 2.0),
    )
