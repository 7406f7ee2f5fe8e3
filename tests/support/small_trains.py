"""Small scenarios with one or a few trains on a line without much on it, made in two lines, and their journeys."""

from __future__ import annotations

from typing import Any

import numpy as np

from tractionpower.io.limits_files import shipped_limits
from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.train_tables import POINT, STAYING, TRAIN_ROW, new_train_state
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import Movement, compile_trains
from tractionpower.movement.journey import Journey, theoretical_journeys

INVERTER = {
    "kind": "inverter",
    "starting_effort_kn": 200.0,
    "power_kw": 3000.0,
    "efficiency": 0.85,
}
"""No knee of its own: without `max_current_a` the current never limits it at 3000 V."""

SERIES_MOTORS = {
    "kind": "series_motors",
    "motors": 4,
    "groupings": [{"series": 4, "parallel": 1}, {"series": 2, "parallel": 2}],
    "starting_current_a": 300.0,
    "motor_resistance_ohm": 0.1,
    "magnetisation": [
        {"current_a": 100.0, "emf_vs_per_rev": 50.0},
        {"current_a": 200.0, "emf_vs_per_rev": 75.0},
        {"current_a": 300.0, "emf_vs_per_rev": 90.0},
        {"current_a": 500.0, "emf_vs_per_rev": 105.0},
    ],
    "field_steps_percent": [100.0, 70.0, 50.0],
    "gear_ratio": 3.0,
    "wheel_diameter_m": 1.25,
    "gear_efficiency": 0.97,
    "notch_time_s": 1.0,
}

TABLE = {
    "kind": "table",
    "effort": [{"speed_kmh": 0.0, "effort_kn": 200.0}, {"speed_kmh": 54.0, "effort_kn": 200.0}]
    + [{"speed_kmh": v, "effort_kn": 10800.0 / v} for v in (60.0, 72.0, 90.0, 108.0, 126.0, 144.0, 160.0)],
    "current": [{"speed_kmh": 0.0, "current_a": 20.0}, {"speed_kmh": 54.0, "current_a": 1150.0}]
    + [{"speed_kmh": v, "current_a": 1150.0} for v in (60.0, 160.0)],
}

BRAKE = {"electric_effort_kn": 100.0, "electric_power_kw": 2000.0, "service_rate_mps2": 0.5}

DRIVES = {"inverter": INVERTER, "series_motors": SERIES_MOTORS, "table": TABLE, "none": None}

VEHICLE: dict[str, Any] = {
    "id": "car",
    "kind": "multiple_unit",
    "mass_t": 200.0,
    "length_m": 100.0,
    "max_speed_kmh": 160.0,
    "rotating_mass_factor": 1.0,
    "resistance": {},
    "drive": INVERTER,
}


def call(station: str, **more: Any) -> dict[str, Any]:
    return {"station": station, **more}


def passing(station: str, **more: Any) -> dict[str, Any]:
    return {"station": station, "stops": False, **more}


def make_line(length_km: float, **more: Any) -> dict[str, Any]:
    """Return a level line with one track that reaches 1 km beyond both ends of the route, and no limit below 600 km/h.

    `limits` are rows (from km, to km, km/h), `slopes` rows (from km, to km, permille), `stations` kilometres by name.
    """
    whole = {"from_km": -1.0, "to_km": length_km + 1.0}
    limits = more.pop("limits", [(-1.0, length_km + 1.0, 600.0)])
    slopes = more.pop("slopes", [])
    stations = more.pop("stations", {})
    return {
        "tracks": [whole | {"id": "1"}],
        "stations": [{"id": name, "km": km} for name, km in stations.items()],
        "speed_limits": [{"from_km": low, "to_km": high, "kmh": kmh} for low, high, kmh in limits],
        "gradients": [{"from_km": low, "to_km": high, "permille": slope} for low, high, slope in slopes],
        **more,
    }


def make_run(name: str, length_km: float, *, backwards: bool = False, **more: Any) -> dict[str, Any]:
    """Return a run from one end of the route to the other that starts at 0 s from rest and leaves at its end."""
    ends = (length_km, 0.0) if backwards else (0.0, length_km)
    start = {"time": more.pop("time", 0.0), "speed_kmh": more.pop("speed_kmh", 0.0)}
    run = {"id": name, "train": "t", "route": [{"track": "1", "from_km": ends[0], "to_km": ends[1]}]}
    return run | {"start": start} | more


def make_trains(length_km: float = 10.0, **more: Any) -> Scenario:
    """Return a scenario with one train: keywords go to the line, the run, the train, or else to the vehicle."""
    line = {key: more.pop(key) for key in LINE_KEYS if key in more}
    run = {key: more.pop(key) for key in RUN_KEYS if key in more}
    train = {key: more.pop(key) for key in TRAIN_KEYS if key in more}
    runs = more.pop("runs", None) or [make_run("x", length_km, **run)]
    outer = {key: more.pop(key) for key in ("clock", "coast_without_voltage_s") if key in more}
    vehicles = more.pop("all_vehicles", None) or [VEHICLE | more]
    return Scenario.model_validate(
        {
            "line": make_line(length_km, **line),
            "supply": {
                "substations": [{"id": "S", "km": 0.0, "no_load_voltage_v": 3300.0, "internal_resistance_ohm": 0.1}],
                "contact_lines": [{"from_km": -1.0, "to_km": length_km + 1.0, "resistance_ohm_per_km": 0.05}],
                "return_circuit": [{"from_km": -1.0, "to_km": length_km + 1.0, "resistance_ohm_per_km": 0.01}],
            },
            "clock": {"start": 0.0, "end": 3600.0, "step_s": 1.0} | outer.pop("clock", {}),
            "timetable": {"trains": runs},
            "trains": [{"id": "t", "vehicles": [{"id": "car"}]} | train],
            "vehicles": vehicles,
            "limits": shipped_limits(),
            **outer,
        }
    )


LINE_KEYS = ("limits", "slopes", "stations", "curves", "tunnels", "train_current_limits", "curve_resistance", "tracks")
LINE_KEYS += ("power_off",)
RUN_KEYS = ("time", "speed_kmh", "end", "calls", "backwards", "driving", "max_current_a", "max_power_kw")
TRAIN_KEYS = ("mass_distribution", "vehicles")


def journey(scenario: Scenario, **more: Any) -> Journey:
    """Return the theoretical journey of the only train."""
    (found,) = theoretical_journeys(scenario, **more)
    return found


def run(
    length_km: float = 10.0, *, voltage_v: Any = None, step_s: float | None = None, form: Any = "time", **more: Any
) -> Journey:
    """Return the journey of the one train of `make_trains`."""
    return journey(make_trains(length_km, **more), voltage_v=voltage_v, step_s=step_s, form=form)


def energy_of(found: Journey, column: str) -> float:
    """Return the integral of a power over the journey [J]."""
    return float(found.seconds @ found.rows[column])


def energy_kwh(found: Journey) -> float:
    return energy_of(found, "power_w") / 3.6e6


class Stepper:
    """Steps one train by hand with a voltage of one's own at each step, and keeps its rows."""

    def __init__(self, scenario: Scenario, k: int = 0) -> None:
        self._take(compile_trains(scenario), k)

    @classmethod
    def of(cls, movement: Movement, k: int = 0) -> Stepper:
        """Return a stepper of trains that are compiled already."""
        found = cls.__new__(cls)
        found._take(movement, k)
        return found

    def _take(self, movement: Movement, k: int) -> None:
        self.movement, self.tables = movement, movement.tables
        self.state = new_train_state(self.tables)
        self.k, self.time_s = k, float(self.tables.trains[k]["start_s"])
        self._rows: list[Any] = []

    @property
    def mover(self) -> Any:
        return self.state.movers[self.k]

    @property
    def gone(self) -> bool:
        return bool(self.mover["status"] >= STAYING)

    @property
    def rows(self) -> Any:
        return np.concatenate(self._rows)

    def step(self, voltage_v: float, h: float = 1.0) -> Any:
        row = np.zeros(1, TRAIN_ROW)
        voltage = np.array([(0.0, voltage_v)], POINT)
        run_journey(self.tables, self.state, self.k, (self.time_s, h), voltage, row)
        self.time_s += h
        self._rows.append(row)
        return row[0]
