"""Small studies of trains and network together, and their rows in SI."""

from dataclasses import dataclass
from typing import Any

from small_trains import BRAKE, DRIVES, VEHICLE

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import CompiledScenario, compile_scenario
from tractionpower.io.limits_files import shipped_limits
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import State, new_buffers
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario

LENGTH_KM = 20.0
MOTOR_BRAKE = {"electric_effort_kn": 60.0, "electric_power_kw": 1000.0, "rheostat_kw": 1000.0, "efficiency": 0.85}
MOTOR_BRAKE |= {"service_rate_mps2": 0.5}


def vehicle(name: str, kind: str = "inverter", **more: Any) -> dict[str, Any]:
    brake = BRAKE if kind == "inverter" else MOTOR_BRAKE if kind == "series_motors" else {"service_rate_mps2": 0.5}
    plain = {
        "drive": DRIVES[kind],
        "brake": brake,
        "resistance": {"a_n": 2500.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.6},
        "auxiliaries": {"power_kw": 60.0, "heating_kw": 40.0},
        "mass_t": 180.0,
    }
    return VEHICLE | plain | more | {"id": name}


def run(
    name: str, train: str = "inverter", track: str = "1", low: float = 0.0, high: float = LENGTH_KM, **more: Any
) -> dict[str, Any]:
    """Return a run that starts at 0 s from rest; with `low` above `high` it goes towards lower kilometres."""
    start = {"time": float(more.pop("time", 0.0)), "speed_kmh": more.pop("speed_kmh", 0.0)}
    leg = {"track": track, "from_km": low, "to_km": high}
    return {"id": name, "train": train, "route": [leg], "start": start} | more


def couple(*runs: dict[str, Any], end_s: float = 600.0, step_s: float = 1.0, **more: Any) -> Scenario:
    """Return two tracks of 20 km between the substations A and B, a cabin in the middle; keywords replace parts of it."""
    whole = {"from_km": 0.0, "to_km": LENGTH_KM}
    line = {
        "tracks": [whole | {"id": track} for track in "12"],
        "stations": [{"id": name, "km": km} for name, km in (("A", 0.0), ("P", 6.0), ("Q", 13.0), ("B", LENGTH_KM))],
        "speed_limits": [whole | {"kmh": 120.0}],
        "gradients": [],
    }
    supply = {
        "substations": [
            {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12}
            for name, km in (("A", 0.0), ("B", LENGTH_KM))
        ],
        "section_cabins": [{"id": "C", "km": 10.0}],
        "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
        "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
    }
    vehicles = more.pop("vehicles", [vehicle(kind, kind) for kind in ("inverter", "series_motors", "table")])
    outer = {key: more.pop(key) for key in ("coupling", "coupling_voltage_v", "output", "coast_without_voltage_s") if key in more}
    return Scenario.model_validate(
        {
            "line": line | {key: more.pop(key) for key in list(more) if key in Line.model_fields},
            "supply": supply | more,
            "clock": {"start": 0.0, "end": end_s, "step_s": step_s},
            "timetable": {"trains": list(runs)},
            "trains": [{"id": each["id"], "vehicles": [{"id": each["id"]}]} for each in vehicles],
            "vehicles": vehicles,
            "limits": shipped_limits(),
            **outer,
        }
    )


@dataclass
class Advanced:
    """What the block has computed of a scenario."""

    compiled: CompiledScenario
    state: State
    buffers: Any

    @property
    def trains(self) -> Any:
        return self.buffers.trains[: int(self.buffers.steps["trains"].sum())]

    def rows(self, name: str) -> Any:
        rows = self.trains
        return rows[rows["train"] == self.compiled.movement.names.index(name)]


def advanced(scenario: Scenario, steps: int | None = None) -> Advanced:
    """Run a scenario in one block."""
    compiled = compile_scenario(scenario)
    if steps is None:
        steps = round((scenario.clock.end - scenario.clock.start) / scenario.clock.step_s)
    state, buffers = start_state(compiled), new_buffers(compiled.block, steps)
    assert advance(compiled.block, state, buffers, steps)[0] == steps
    return Advanced(compiled, state, buffers)


MIXED = (
    run("E1", calls=[{"station": "P", "min_dwell_s": 20.0}, {"station": "B"}]),
    run(
        "E2",
        track="2",
        low=20.0,
        high=0.0,
        time=30.0,
        calls=[{"station": "Q", "min_dwell_s": 10.0}, {"station": "A"}],
        end="stay",
    ),
    run("M1", "series_motors", time=120.5, calls=[{"station": "P"}, {"station": "B"}]),
    run("M2", "series_motors", "2", 10.0, 0.0, speed_kmh=90.0, calls=[{"station": "A"}]),
    run("T1", "table", "2", 20.0, 4.0, time=200.0),
)
"""Trains of all drives in both directions, that stop, stay, leave, and enter within a step."""
