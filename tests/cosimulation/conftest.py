"""One busy run with trains of all drives, that the tests of this room look at from different sides."""

from dataclasses import dataclass

import pandas as pd
import pytest
from coupled import couple, run, vehicle
from small_studies import run_in_memory
from small_trains import INVERTER

from tractionpower.cosimulation.run import Run
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results


@dataclass(frozen=True)
class Busy:
    """A run, its scenario, and its table of trains with SI-free numbers in float64."""

    scenario: Scenario
    results: Results
    run: Run
    trains: pd.DataFrame

    def rows(self, train: str) -> pd.DataFrame:
        return self.trains[self.trains["train"] == train].reset_index(drop=True)

    def figure(self, name: str, place: str = "") -> float:
        return self.results.key_figure(name, place)

    def noted(self, name: str, place: str | None = None) -> dict:
        """Return a key figure as it is written; without a place the only one of its name."""
        named = [each for each in self.results.key_figures if each["name"] == name]
        (found,) = [each for each in named if place in (None, each["place"])]
        return found


def at(station: str, arrival: float | None = None, departure: float | None = None, **more) -> dict:
    return {"station": station, "arrival": arrival, "departure": departure} | more


def busy_scenario(**more) -> Scenario:
    """Return trains on a weak line without a cabin: low and high voltages, limits, overlaps, late calls."""
    plants = [
        {"id": "A", "km": 0.0, "no_load_voltage_v": 3590.0, "internal_resistance_ohm": 0.15},
        {"id": "M", "km": 9.0, "no_load_voltage_v": 3590.0, "internal_resistance_ohm": 0.3},
        {"id": "B", "km": 20.0, "no_load_voltage_v": 3590.0, "internal_resistance_ohm": 0.3, "conducts": "both"},
    ]
    loads = [
        {"id": "heavy", "track": "1", "km": 14.0, "power_kw": 6500.0, "from": 330.0, "to": 360.0},
        {"id": "feeds", "track": "2", "km": 0.5, "current_a": -300.0, "limits": "none", "from": 930.0, "to": 940.0},
    ]
    vehicles = [
        vehicle("inverter", drive=INVERTER | {"max_current_a": 1000.0}),
        vehicle("strong", drive=INVERTER | {"power_kw": 6000.0, "starting_effort_kn": 300.0}, mass_t=400.0),
        vehicle("series_motors", "series_motors"),
        vehicle("table", "table"),
    ]
    runs = [
        run("E1", calls=[at("P", 300.0, 320.0, min_dwell_s=20.0), at("B", 800.0)]),
        run("E2", "strong", "2", 20.0, 0.0, time=30.0, calls=[at("Q", min_dwell_s=10.0), at("A", 700.0)], end="stay"),
        run("E3", "strong", "2", 20.0, 0.0, time=60.5),
        run("M1", "series_motors", time=120.5, calls=[{"station": "P"}, {"station": "B"}]),
        run("M2", "series_motors", "2", 10.0, 0.0, speed_kmh=90.0, calls=[{"station": "A"}]),
        run("S1", "strong", "1", 1.0, 20.0, time=40.0),
        run("S2", "strong", "1", 6.0, 20.0, time=100.0),
        run("T1", "table", "2", 20.0, 4.0, time=200.0),
    ]
    plain = {"end_s": 1000.0, "substations": plants, "section_cabins": [], "vehicles": vehicles, "loads": loads}
    wires = [{"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.09}]
    return couple(*runs, **plain | {"contact_lines": wires} | more)


@pytest.fixture(scope="session")
def busy() -> Busy:
    scenario = busy_scenario()
    results, _, made = run_in_memory(scenario)
    trains = results.table("trains")
    numbers = trains.select_dtypes("number").columns
    trains = trains.astype(dict.fromkeys(numbers, float) | {"train": str, "track": str, "phase": str, "limited_by": str})
    return Busy(scenario, results, made, trains)
