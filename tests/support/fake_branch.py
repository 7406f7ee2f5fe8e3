"""Made-up results of the line with a branch that ships: theoretical journeys of its trains, voltages and potentials drawn up."""

from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from fake_runs import FakeRun, figure

from tractionpower.io.scenario_files import load_scenario
from tractionpower.kernels.train_tables import PHASES
from tractionpower.movement.journey import theoretical_journeys
from tractionpower.results.results import Results

LENGTH_KM = {"1": 26.0, "2": 26.0, "3": 14.6}
LOWEST_V = 2800.0
"""Lowest voltage, at the far end of the branch."""


@cache
def branch_run() -> FakeRun:
    """Return the trains of the line y-junction; the voltage falls to the far end of the branch."""
    scenario = load_scenario("y-junction").scenario
    journeys = theoretical_journeys(scenario)
    trains = pd.concat([_train_rows(journey) for journey in journeys], ignore_index=True).sort_values("time_s", kind="stable")
    tables = {"trains": trains, "profile": _profile(), "rail_profile": _rail_profile(), "rails": _rails(scenario.clock.start)}
    run = {
        "status": "complete", "study": "fake", "name": scenario.name, "start_s": scenario.clock.start, "coupling": "full",
        "steps": 4200, "end_s": scenario.clock.end, "step_s": 1.0, "verdicts": [],
        "trains": [
            {"train": each.run.id, "status": "left", "entered_s": each.rows["time_s"][0], "finished_s": each.finished_s}
            for each in journeys
        ],
    }  # fmt: skip
    figures = [figure("lowest_voltage_v", LOWEST_V, "track 3, km 0", scenario.clock.start)]
    return FakeRun(scenario, Results(run, figures, {name: pa.Table.from_pandas(rows) for name, rows in tables.items()}))


def _train_rows(journey: Any) -> pd.DataFrame:
    rows = journey.rows
    leg, km = journey.path.places(rows["s_m"])
    track = np.array([each.axis.track for each in journey.path.legs])[leg]
    volts = np.where(track == "3", LOWEST_V + 30.0 * km, 3400.0)
    return pd.DataFrame(
        {
            "time_s": rows["time_s"], "train": journey.run.id, "track": track, "position_km": km, "distance_m": rows["s_m"],
            "speed_kmh": 3.6 * rows["v_mps"], "acceleration_mps2": 0.0, "phase": PHASES[0], "limited_by": "nothing",
            "voltage_v": volts, "current_a": rows["power_w"] / volts, "power_kw": rows["power_w"] / 1000.0,
        }
    )  # fmt: skip


def _places() -> pd.DataFrame:
    return pd.DataFrame(
        [(track, km) for track, end in LENGTH_KM.items() for km in np.linspace(0.0, end, 27)], columns=["track", "km"]
    )


def _profile() -> pd.DataFrame:
    fixed, trains = _places().assign(where="cross_section"), _places().assign(where="pantograph")
    rows = pd.concat([fixed, trains], ignore_index=True)
    low = np.where(rows["track"] == "3", LOWEST_V + 30.0 * rows["km"], 3300.0)
    return rows.assign(lowest_voltage_v=low, mean_voltage_v=low + 50.0, highest_voltage_v=low + 100.0, count=60)


def _rail_profile() -> pd.DataFrame:
    rows = _places()
    high = np.where(rows["track"] == "3", 60.0 - 4.0 * rows["km"], 20.0)
    return rows.assign(lowest_potential_v=-20.0, mean_potential_v=0.0, highest_potential_v=high)


def _rails(start_s: float) -> pd.DataFrame:
    rows = _places()
    volts = np.where(rows["track"] == "3", 60.0 - 4.0 * rows["km"], 20.0 - rows["km"])
    return pd.concat([rows.assign(time_s=start_s + 60.0 * k, potential_v=volts / (1 + k)) for k in range(5)], ignore_index=True)
