"""A real run that has something for every sheet: its workbook, with formulas and with values."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from coupled import couple, run, vehicle
from openpyxl import load_workbook
from small_studies import run_in_memory
from small_trains import INVERTER

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.workbook import write_workbook
from tractionpower.results.results import Results


@dataclass(frozen=True)
class Written:
    """A run and its workbook."""

    results: Results
    scenario: Scenario
    path: Path

    @property
    def formulas(self) -> Any:
        return load_workbook(self.path)

    @property
    def values(self) -> Any:
        return load_workbook(self.path, data_only=True)

    def figure(self, name: str, place: str) -> float:
        (found,) = [each for each in self.results.key_figures if (each["name"], each["place"]) == (name, place)]
        return float(found["value"])


@pytest.fixture(scope="session")
def rich(tmp_path_factory):
    """Trains of two categories with calls, plants with units, supply points and feeders with a resistance."""
    plant = {"no_load_voltage_v": 3500.0, "rated_current_a": 800.0, "feeder_resistance_ohm": 0.02, "trip_current_a": 2500.0}
    plant |= {"unit_resistance_ohm": 0.3, "units": 2, "dissipative_resistance_ohm": 0.06}
    plants = [
        plant | {"id": "A", "km": 0.0, "supply_point": "North", "contract_power_kw": 5000.0},
        plant | {"id": "M", "km": 9.0, "supply_point": "North", "contract_power_kw": 5000.0, "units_in_service": 1},
        plant | {"id": "B", "km": 20.0, "conducts": "both"},
    ]
    runs = [
        run(
            "E1",
            category="express",
            calls=[{"station": "P", "arrival": 250.0, "departure": 280.0}, {"station": "B", "arrival": 500.0}],
        ),
        run("E2", "strong", "2", 20.0, 0.0, time=30.0, category="Express", calls=[{"station": "A", "arrival": 900.0}]),
        run("=M1", "series_motors", time=120.5, calls=[{"station": "P"}, {"station": "B", "arrival": 5000.0}]),
    ]
    strong = vehicle("strong", drive=INVERTER | {"power_kw": 6000.0, "starting_effort_kn": 300.0}, mass_t=400.0)
    vehicles = [strong, *(vehicle(kind, kind) for kind in ("inverter", "series_motors"))]
    loads = [{"id": name, "track": "1", "km": km, "power_kw": 300.0} for name, km in (("depot", 4.0), ("heating", 12.0))]
    scenario = couple(*runs, end_s=900.0, substations=plants, vehicles=vehicles, loads=loads)
    results, *_ = run_in_memory(scenario)
    return Written(results, scenario, write_workbook(results, scenario, tmp_path_factory.mktemp("rich") / "report.xlsx"))
