"""Trains alone: running times by place beside closed forms, and beside the rows of the theoretical journey."""

import numpy as np
import pytest
from small_trains import call, make_trains, passing, run

from tractionpower.kernels.train_tables import POINT
from tractionpower.movement.alone import leave_at, run_alone, running_at_calls
from tractionpower.movement.compile import compile_trains

NOMINAL = np.array([(0.0, 3000.0)], POINT)
STOPS = {"stations": {"P": 3.0, "Q": 6.0, "Z": 10.0}}
CALLS = [call("P", min_dwell_s=30.0), passing("Q"), call("Z", min_dwell_s=10.0)]


def alone(scenario, voltage=NOMINAL, left=None, step_s=1.0, entered_s=0.0):
    movement = compile_trains(scenario)
    left = np.full(len(movement.tables.stops), np.nan) if left is None else np.array(left)
    tables = leave_at(movement, np.array([entered_s]), left)
    return run_alone(tables, 0, (np.floor(entered_s), step_s), voltage)


def test_constant_effort_below_the_corner_speed():
    # 200 kN on 200 t: 1 m/s2 up to 15 m/s, without resistance
    times = alone(make_trains(10.0))
    places = np.array([0.0, 8.0, 50.0, 100.0])
    np.testing.assert_allclose(times.until(places), np.sqrt(2.0 * places), atol=1e-6)
    assert np.isnan(times.until(np.array([10001.0]))[0])


def test_constant_power_from_a_speed():
    v0, length = 25.0, 4000.0
    power, mass = 3e6, 200e3
    times = alone(make_trains(4.0, speed_kmh=90.0, max_speed_kmh=400.0))
    v1 = (v0**3 + 3.0 * power * length / mass) ** (1.0 / 3.0)
    assert times.until(np.array([length]))[0] == pytest.approx(mass * (v1**2 - v0**2) / (2.0 * power), abs=1e-3)


def test_stops_are_taken_off_wherever_they_lie_in_a_step():
    scenario = make_trains(10.0, limits=[(-1.0, 11.0, 100.0)], calls=CALLS, **STOPS)
    found = run(10.0, limits=[(-1.0, 11.0, 100.0)], calls=CALLS, **STOPS)
    arrived = np.array([each.arrival_s for each in found.calls])
    expected = arrived - [0.0, 30.0, 30.0]
    np.testing.assert_allclose(
        running_at_calls(0.0, np.array([True, False, True]), arrived, arrived + np.array([30.0, 0.0, 10.0])), expected
    )
    for left in ([np.nan] * 3, [500.3, np.nan, np.nan], [arrived[0] + 30.0, np.nan, np.nan]):
        times = alone(scenario, left=left)
        np.testing.assert_allclose(times.at_calls_s, expected, atol=0.02)
        np.testing.assert_allclose(times.until(np.array([3000.0, 6000.0, 10000.0])), times.at_calls_s, atol=0.02)
        assert (np.diff(times.until(np.linspace(0.0, 10000.0, 401))) > 0.0).all()
    exact = alone(scenario, left=[arrived[0] + 30.0, np.nan, np.nan])  # steps begin where they did
    np.testing.assert_allclose(exact.at_calls_s, expected, atol=1e-9)


def test_an_entry_within_a_step_counts_from_then():
    whole, later = (alone(make_trains(10.0), entered_s=time_s) for time_s in (100.0, 100.7))
    places = np.linspace(100.0, 10000.0, 30)
    np.testing.assert_allclose(whole.until(places), later.until(places), atol=0.02)


def test_a_voltage_over_the_way_slows_only_there():
    capped = {
        "drive": {
            "kind": "inverter",
            "starting_effort_kn": 200.0,
            "power_kw": 3000.0,
            "efficiency": 0.85,
            "max_current_a": 1200.0,
        }
    }
    scenario = make_trains(10.0, max_speed_kmh=400.0, **capped)
    low = np.array([(0.0, 3000.0), (4000.0, 3000.0), (4000.1, 2200.0), (6000.0, 2200.0), (6000.1, 3000.0)], POINT)
    at_nominal, slowed = alone(scenario), alone(scenario, low)
    places = np.array([2000.0, 4000.0, 6000.0, 10000.0])
    lost = slowed.until(places) - at_nominal.until(places)
    np.testing.assert_allclose(lost[:2], 0.0, atol=0.05)
    assert 0.5 < lost[2] < lost[3]


def test_a_train_that_cannot_go_on_has_no_times_beyond():
    stuck = np.array([(0.0, 3000.0), (4000.0, 3000.0), (4000.1, 0.0)], POINT)
    slope = {"slopes": [(-1.0, 4.0, 0.0), (4.0, 11.0, 20.0)]}
    times = alone(make_trains(10.0, calls=CALLS[1:], coast_without_voltage_s=3600.0, **STOPS, **slope), stuck)
    assert np.isnan(times.at_calls_s[-1])
    assert np.isnan(times.until(np.array([10000.0]))[0])
    assert np.isfinite(times.until(np.array([4000.0]))[0])
