"""Effort by levels against its formulas, its lag against the exponential and against SciPy."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from small_controls import compiled, electric_effort_at, lagged_by, locomotive, scenario, steady_effort_at

KMH = 3.6


def effort_kn(chain, level, kmh):
    return steady_effort_at(chain, 0, level, kmh / KMH) / 1e3


@pytest.mark.interpreted
def test_effort_is_the_least_of_effort_and_power_over_speed():
    chain, _ = compiled(scenario(wagons=0))
    assert effort_kn(chain, 15, 0.0) == 270.0
    assert effort_kn(chain, 15, 20.0) == pytest.approx(270.0, rel=1e-15)  # the corner is 1500 kW / 270 kN = 20 km/h
    assert effort_kn(chain, 15, 60.0) == pytest.approx(1500.0 * KMH / 60.0, rel=1e-15)
    assert effort_kn(chain, 6, 0.0) == pytest.approx(108.0, rel=1e-15)
    assert effort_kn(chain, 6, 60.0) == pytest.approx(36.0, rel=1e-15)
    assert effort_kn(chain, 0, 0.0) == effort_kn(chain, -3, 10.0) == 0.0
    assert effort_kn(chain, 99, 60.0) == effort_kn(chain, 15, 60.0)
    assert effort_kn(chain, 9, -60.0) == effort_kn(chain, 9, 60.0)


def test_quadratic_power_of_diesel_notches():
    chain, _ = compiled(scenario(wagons=0, traction={"levels": 8, "law": "quadratic_power"}))
    assert effort_kn(chain, 2, 0.0) == pytest.approx(270.0 / 4.0, rel=1e-15)
    assert effort_kn(chain, 2, 36.0) == pytest.approx(1500.0 / 16.0 / 10.0, rel=1e-15)


def test_pull_out_of_an_inverter_drive():
    drive = {"kind": "inverter", "starting_effort_kn": 270.0, "power_kw": 1500.0, "pull_out_kmh": 90.0, "efficiency": 0.9}
    chain, _ = compiled(scenario(wagons=0, loco=locomotive(drive=drive)))
    assert effort_kn(chain, 15, 90.0) == pytest.approx(60.0, rel=1e-14)
    assert effort_kn(chain, 15, 180.0) == pytest.approx(15.0, rel=1e-14)  # with 1/v2 from 90 km/h on
    assert effort_kn(chain, 5, 180.0) == pytest.approx(5.0, rel=1e-14)


@pytest.mark.interpreted
def test_points_are_linear_between_and_end():
    points = [
        {"level": level, "speed_kmh": v, "effort_kn": level * f} for level in (1, 2) for v, f in ((10, 100), (30, 60), (50, 50))
    ]
    chain, _ = compiled(scenario(wagons=0, traction={"levels": 2, "effort": points}))
    for level in (1, 2):
        found = [effort_kn(chain, level, v) for v in (0.0, 10.0, 20.0, 35.0, 50.0, 50.001)]
        np.testing.assert_allclose(found, np.array([100.0, 100.0, 80.0, 57.5, 50.0, 0.0]) * level, rtol=1e-12)


@pytest.mark.interpreted
def test_electric_brake_fades_at_low_speed():
    brake = {"levels": 8, "effort_kn": 150.0, "power_kw": 1500.0, "fades_below_kmh": 18.0}
    chain, _ = compiled(scenario(wagons=0, electric_brake=brake))
    shares = {(1.0, 27.0): 150.0, (1.0, 72.0): 75.0, (0.5, 72.0): 37.5, (1.0, 9.0): 75.0, (1.0, 0.0): 0.0, (0.0, 30.0): 0.0}
    for (share, kmh), kn in shares.items():
        assert electric_effort_at(chain, 0, share, kmh / KMH) == pytest.approx(kn * 1e3, rel=1e-14)
    assert electric_effort_at(chain, 0, 2.0, -7.5) == pytest.approx(150e3, rel=1e-15)


@pytest.mark.interpreted
def test_a_constant_aim_is_equation_2():
    # Z(2): F = F* exp(-t/T) + F_inf (1 - exp(-t/T)), at three times and however the time is cut
    start, end, lag = 40e3, 200e3, 0.01
    for time in (0.004, 0.01, 0.05):
        exact = start * math.exp(-time / lag) + end * (1.0 - math.exp(-time / lag))
        assert lagged_by(start, end, end, time, lag) == pytest.approx(exact, rel=1e-14)
        force = start
        for _ in range(8):
            force = lagged_by(force, end, end, time / 8.0, lag)
        assert force == pytest.approx(exact, rel=1e-13)
    assert lagged_by(start, 0.0, end, 0.5, 0.0) == end
    assert lagged_by(start, 0.0, end, 0.0, 0.1) == start


def test_a_new_level_before_the_last_has_settled_starts_from_the_effort_that_prevails():
    lag = 0.5
    prevailing = lagged_by(0.0, 100e3, 100e3, 0.3, lag)
    assert prevailing == pytest.approx(100e3 * (1.0 - math.exp(-0.6)), rel=1e-14)
    found = lagged_by(prevailing, 20e3, 20e3, 0.2, lag)
    assert found == pytest.approx(prevailing * math.exp(-0.4) + 20e3 * (1.0 - math.exp(-0.4)), rel=1e-14)


def test_the_lag_of_the_paper_is_stable_where_euler_is_not():
    # T = 0.01 s: an explicit step of 0.05 s would multiply the difference by -4
    force, before = 0.0, -1.0
    for _ in range(20):
        force = lagged_by(force, 1.0, 1.0, 0.05, 0.01)
        assert before < force <= 1.0 or force == before == 1.0
        before = force
    assert abs(force - 1.0) < 1e-15


@given(before=st.floats(-1.0, 1.0), first=st.floats(-1.0, 1.0), last=st.floats(-1.0, 1.0), x=st.floats(1e-3, 20.0))
@settings(max_examples=20, deadline=None, derandomize=True)
def test_a_linear_aim_against_a_solver(before, first, last, x):
    lag = 0.3
    tau = x * lag
    solved = solve_ivp(lambda t, f: (first + (last - first) * t / tau - f) / lag, (0.0, tau), [before], rtol=1e-11, atol=1e-12)
    assert lagged_by(before, first, last, tau, lag) == pytest.approx(solved.y[0, -1], abs=1e-9)


@given(x=st.floats(1e-12, 1e-3))
@settings(max_examples=20, deadline=None, derandomize=True)
def test_a_short_step_behind_a_linear_aim_is_no_noise(x):
    # series of the exact solution: (aim - F) x - (aim - F) x2/2 + change (x/2 - x2/6)
    found = lagged_by(0.0, 1.0, 3.0, x, 1.0)
    assert found == pytest.approx(x - x * x / 2.0 + 2.0 * (x / 2.0 - x * x / 6.0), rel=1e-6, abs=3e-16)
