"""A tiny co-simulation with a train of every drive; printed as JSON: ``python interpreted.py``."""

import json
import sys
from typing import Any

from coupled import couple, run
from small_studies import run_in_memory

from tractionpower.model.scenario import Scenario


def tiny_coupling() -> Scenario:
    """Return six steps in which trains start, brake towards a stop, run on, enter and leave."""
    stations = [{"id": "A", "km": 0.0}, {"id": "N", "km": 6.0}, {"id": "B", "km": 20.0}]
    stop = [{"station": "N"}]
    return couple(
        run("E", speed_kmh=80.0, low=3.0, high=6.0),
        run("F", speed_kmh=40.0, low=5.86, high=6.0, calls=stop),
        run("M", "series_motors"),
        run("S", "series_motors", "2", 20.0, 0.0, speed_kmh=70.0),
        run("T", "table", "2", 12.0, 0.0, speed_kmh=50.0, time=2.4),
        run("X", low=10.0, high=10.05, speed_kmh=110.0, time=1.0),
        stations=stations,
        end_s=6.0,
    )


def found_in(scenario: Scenario) -> dict[str, Any]:
    """Return what a run finds, as plain numbers."""
    results, outcome, _ = run_in_memory(scenario)
    rows = results.table("trains")
    numbers = rows[["time_s", "distance_m", "speed_kmh", "voltage_v", "current_a", "power_kw", "wheel_power_kw"]]
    return {
        "status": outcome.run["status"],
        "ledgers": {kind: ledger["closes"] for kind, ledger in outcome.run["ledgers"].items()},
        "phases": sorted(set(rows["phase"].astype(str))),
        "rows": numbers.astype(float).to_numpy().tolist(),
        "figures": {f"{each['name']} {each['place']}": each["value"] for each in results.key_figures},
    }


if __name__ == "__main__":
    json.dump(found_in(tiny_coupling()), sys.stdout)
