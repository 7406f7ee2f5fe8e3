"""Tiny runs that also pass when numba compiles nothing, and mean the same: ``NUMBA_DISABLE_JIT=1 pytest -m interpreted``."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from coupled import couple, run
from interpreted import found_in, tiny_coupling
from small_studies import load, make_scenario, run_in_memory, station

pytestmark = pytest.mark.interpreted

BYPASSED = [{"id": "C", "km": 10.0, "state": "bypassed"}]


def voltages(scenario):
    results, outcome, _ = run_in_memory(scenario)
    return results.table("loads").pivot_table(index="time_s", columns="load", values="voltage_v", observed=True), outcome


@pytest.mark.parametrize(("state", "expected"), [("closed", 3247.5), ("bypassed", 3060.0)])
def test_one_train(state, expected):
    cabins = [{"id": "C", "km": 10.0, "state": state}]
    found, outcome = voltages(make_scenario(load("x", 10.0, current_a=1500.0), section_cabins=cabins, clock={"end": 2.0}))
    np.testing.assert_allclose(found["x"], expected, atol=1e-3)
    assert outcome.run["status"] == "complete"
    assert outcome.run["ledgers"]["electric"]["closes"]


def test_power_by_time_of_day():
    loads = [load("x", 5.0), load("y", 15.0, "2", **{"from": 1.0, "to": 2.0})]
    found, outcome = voltages(make_scenario(*loads, clock={"end": 4.0}))
    assert found["x"].iloc[1] < found["x"].iloc[0]
    assert found["x"].iloc[0] == found["x"].iloc[2] == found["x"].iloc[3]
    assert outcome.run["worst_residual_a"] < 1e-6


def test_feeding_back_with_rectifiers_that_block():
    found, outcome = voltages(
        make_scenario(load("x", 5.0, power_kw=-5000.0), load("y", 15.0, power_kw=900.0), clock={"end": 2.0})
    )
    assert found["x"].between(3800.0, 3900.0).all()
    assert outcome.run["status"] == "complete"


def test_a_demand_that_cannot_be_served():
    _, outcome = voltages(
        make_scenario(load("x", 10.0, power_kw=9500.0, limits="none"), section_cabins=BYPASSED, clock={"end": 1.0})
    )
    assert outcome.run["status"] == "flagged"


def test_feeders_and_a_busbar_alone():
    stations = [station("A", 0.0, feeder_resistance_ohm=0.01), station("M", 8.0, state="rectifiers_out"), station("B", 20.0)]
    found, outcome = voltages(make_scenario(load("x", 5.0), substations=stations, clock={"end": 1.0}))
    assert 3000.0 < found["x"].iloc[0] < 3600.0
    assert outcome.run["ledgers"]["electric"]["closes"]


def test_trains_of_every_drive():
    found = found_in(tiny_coupling())
    assert found["status"] == "complete"
    assert all(found["ledgers"].values())
    assert found["phases"] == ["accelerating", "braking"]
    assert np.isfinite(found["rows"]).all()


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_one_train_takes_what_the_network_gives(kind):
    results, _, _ = run_in_memory(couple(run("E", kind, speed_kmh=60.0), end_s=3.0))
    rows, fed = results.table("trains"), results.table("substations")
    np.testing.assert_allclose(fed.groupby("time_s")["current_a"].sum(), rows["current_a"], rtol=1e-5)
    assert (rows["current_a"] > 300.0).all()
    assert (np.diff(rows["speed_kmh"]) > 0.0).all()


def test_compiled_and_interpreted_runs_find_the_same():
    script = Path(__file__).parents[1] / "support" / "interpreted.py"
    ways = [path for path in sys.path if path] + [str(script.parent)]
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(ways)}
    said = subprocess.run([sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True)
    other, here = json.loads(said.stdout), found_in(tiny_coupling())
    assert other["phases"] == here["phases"]
    np.testing.assert_allclose(other["rows"], here["rows"], rtol=1e-6, atol=1e-6)
    assert set(other["figures"]) == set(here["figures"])
    for name, value in here["figures"].items():
        assert other["figures"][name] == pytest.approx(value, rel=1e-9, abs=1e-9), name
