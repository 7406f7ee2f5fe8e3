"""Tracks and trains of TTOBench (tests/data/ttobench, BSD-2) as scenarios on 3 kV, and driven journeys on them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from tractionpower.io.limits_files import shipped_limits
from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.train_tables import POINT, TRAIN_ROW, new_train_state
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import Movement
from tractionpower.movement.driving.plan import Plan, lay_plans

FOLDER = Path(__file__).parents[1] / "data" / "ttobench"
TRACKS = sorted(path.stem for path in (FOLDER / "tracks").glob("*.json"))
TRAINS = {"flirt": "CH_Stadler_FLIRT_TPF", "virm": "NL_Intercity_VIRM6", "subway": "CN_Beijing_Subway"}
KMH = 3.6


def read(kind: str, name: str) -> dict[str, Any]:
    return json.loads((FOLDER / kind / f"{name}.json").read_text())


def rows_of(track: dict[str, Any], name: str, end: float) -> list[tuple[float, float, float]]:
    """Return (from m, to m, value) of steps that begin at positions."""
    values = [row for row in track[name]["values"] if row[0] < end]
    ends = [*(row[0] for row in values[1:]), end]
    return [(row[0], until, row[1]) for row, until in zip(values, ends, strict=True) if until > row[0]]


def vehicle_of(name: str, rate_mps2: float) -> dict[str, Any]:
    given = read("trains", TRAINS[name])
    number = {key: item["value"] for key, item in given.items() if "value" in item}
    return {
        "id": "car",
        "kind": "multiple_unit",
        "mass_t": number["mass"] / 1e3,
        "length_m": number.get("length", 150.0),
        "max_speed_kmh": number["max speed"],
        "rotating_mass_factor": 1.0 + number["rho"] / 100.0,
        "resistance": {
            "a_n": 1e3 * number["rolling resistance r0"],
            "b_n_per_kmh": 1e3 * number["rolling resistance r1"],
            "c_n_per_kmh2": 1e3 * number["rolling resistance r2"],
        },
        "drive": {
            "kind": "inverter",
            "starting_effort_kn": number["max traction force"],
            "power_kw": number["max traction power"],
            "efficiency": number["efficiency traction"] / 100.0,
            "max_current_a": 1e4,
            "fold_back_from_v": 3600.0,
            "fold_back_to_v": 3900.0,
        },
        "brake": {
            "electric_effort_kn": number["max reg braking force"],
            "electric_power_kw": number["max reg braking power"],
            "efficiency": number["efficiency reg brake"] / 100.0,
            "service_rate_mps2": rate_mps2,
        },
    }


def scenario_of(
    track: str | dict[str, Any], train: str, *, mass: str = "uniform", rate_mps2: float = 0.5, **run: Any
) -> Scenario:
    """Return a run over a whole track, given by name or as its file is; stops are calls A0, A1, ...; keywords go to the run."""
    given = read("tracks", track) if isinstance(track, str) else track
    stops = given["stops"]["values"]
    end = float(stops[-1])
    vehicle = run.pop("vehicle", None) or vehicle_of(train, rate_mps2)
    stations = [{"id": f"A{n}", "km": at / 1e3} for n, at in enumerate(stops)]
    calls = run.pop("calls", None) or [{"station": station["id"]} for station in stations]
    tunnels = [
        {"from_km": at / 1e3, "to_km": (at + length) / 1e3, "kind": "single_track" if area < 30.0 else "double_track"}
        for at, length, area in given.get("tunnels", {}).get("values", [])
    ]
    whole = {"from_km": 0.0, "to_km": end / 1e3}
    limits = [{"from_km": a / 1e3, "to_km": b / 1e3, "kmh": v} for a, b, v in rows_of(given, "speed limits", end)]
    slopes = [{"from_km": a / 1e3, "to_km": b / 1e3, "permille": i} for a, b, i in rows_of(given, "gradients", end)]
    return Scenario.model_validate(
        {
            "line": {
                "tracks": [whole | {"id": "1"}],
                "stations": stations,
                "speed_limits": limits,
                "gradients": slopes,
                "tunnels": tunnels,
            },
            "supply": {
                "substations": [{"id": "S", "km": 0.0, "no_load_voltage_v": 3300.0, "internal_resistance_ohm": 0.1}],
                "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
                "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
            },
            "clock": {"start": 0.0, "end": 7200.0},
            "timetable": {
                "trains": [
                    {
                        "id": "x",
                        "train": "t",
                        "route": [whole | {"track": "1"}],
                        "start": {"time": 0.0},
                        "calls": calls,
                    }
                    | run
                ]
            },
            "trains": [{"id": "t", "vehicles": [{"id": "car"}], "mass_distribution": mass}],
            "vehicles": [vehicle],
            "limits": shipped_limits(),
        }
    )


class Driven:
    """A run alone, by a plan or flat out: its rows, calls, running time without dwells [s], net energy [J]."""

    def __init__(self, movement: Movement, rows: Any = None, *, k: int = 0, voltage: Any = 3000.0, step_s: float = 1.0) -> None:
        if rows is not None:
            movement = lay_plans(movement, {k: Plan(*rows, np.zeros(0, POINT), np.inf)})
        state = new_train_state(movement.tables)
        points = [(0.0, voltage)] if isinstance(voltage, int | float) else voltage
        steps = np.zeros(40_000, TRAIN_ROW)
        item = movement.runs[k]
        count, self.status, self.end_s = run_journey(
            movement.tables, state, k, (item.start_s, step_s), np.array(points, POINT), steps
        )
        self.rows = steps[:count]
        calls = slice(int(movement.tables.trains[k]["first_stop"]), None)
        count = int(movement.tables.trains[k]["stops"])
        self.arrived_s, self.left_s = state.arrived_s[calls][:count], state.left_s[calls][:count]
        self.finished_s = float(state.movers[k]["finished_s"])
        self.running_s = float(self.rows["on_line_s"][self.rows["moved_m"] > 0.0].sum())
        self.net_j = float((self.rows["power_w"] * step_s).sum())

    def energy_j(self, returned: float = 1.0, step_s: float = 1.0) -> float:
        power = self.rows["power_w"]
        return float(np.where(power > 0.0, power, returned * power).sum() * step_s)
