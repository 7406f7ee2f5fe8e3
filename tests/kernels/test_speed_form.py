"""The form over the speed (eq. 3 and 4 of the paper) against the form over time, and closed forms."""

import math

import numpy as np
import pytest
from random_trains import random_study
from small_trains import DRIVES, INVERTER, call, energy_of, journey, run

LINE = {
    "slopes": [(-1.0, 2.0, 0.0), (2.0, 5.0, 10.0), (5.0, 13.0, -4.0)],
    "limits": [(-1.0, 4.0, 120.0), (4.0, 5.0, 80.0), (5.0, 13.0, 140.0)],
    "stations": {"A": 7.0, "Z": 12.0},
    "resistance": {"a_n": 3000.0, "c_n_per_kmh2": 0.8},
}
CALLS = [call("A", min_dwell_s=20.0), call("Z")]


@pytest.mark.parametrize(("kind", "share"), [("inverter", 3e-4), ("table", 3e-4), ("series_motors", 4e-3)])
def test_both_forms_tend_to_the_same(kind, share):
    def pair(step_s):
        return [run(12.0, drive=DRIVES[kind], calls=CALLS, step_s=step_s, form=form, **LINE) for form in ("time", "speed")]

    by_time, by_speed = pair(0.05)
    assert by_speed.finished_s == pytest.approx(by_time.finished_s, rel=5e-4 if kind == "series_motors" else 2e-4)
    assert energy_of(by_speed, "power_w") == pytest.approx(energy_of(by_time, "power_w"), rel=share)
    # The speed where the time form is at, over the distance.
    s = np.linspace(100.0, 11900.0, 119)
    speeds = [np.interp(s, found.rows["s_m"], found.rows["v_mps"]) for found in (by_time, by_speed)]
    np.testing.assert_allclose(*speeds, atol=0.3 if kind == "series_motors" else 0.05)  # notches are state
    coarse = pair(1.0)[1]
    assert coarse.finished_s == pytest.approx(by_time.finished_s, rel=1e-3)
    assert energy_of(coarse, "power_w") == pytest.approx(
        energy_of(by_time, "power_w"), rel=8e-3 if kind == "series_motors" else 2e-3
    )


def test_constant_force_and_power():
    force = INVERTER | {"power_kw": 1e6, "max_current_a": 1e6}
    found = run(2.0, drive=force, form="speed", limits=[(-1.0, 3.0, 600.0)], max_speed_kmh=600.0, calls=[], step_s=5.0)
    k = np.flatnonzero(found.rows["s_m"] > 1000.0)[0]
    row = found.rows[k]
    assert row["time_s"] == pytest.approx(row["v_mps"], rel=1e-9)  # a = 1 m/s2
    assert row["s_m"] == pytest.approx(0.5 * row["v_mps"] ** 2, rel=1e-9)
    assert found.finished_s == pytest.approx(math.sqrt(4000.0), rel=1e-6)
    power = INVERTER | {"starting_effort_kn": 1e4, "max_current_a": 1e6}
    found = run(8.0, drive=power, mass_t=500.0, speed_kmh=72.0, limits=[(-1.0, 9.0, 600.0)], max_speed_kmh=600.0, form="speed")
    row = found.rows[np.flatnonzero(found.rows["v_mps"] > 39.0)[0]]
    assert row["time_s"] == pytest.approx(500e3 * (row["v_mps"] ** 2 - 400.0) / 6e6, rel=1e-6)
    assert row["s_m"] == pytest.approx(500e3 * (row["v_mps"] ** 3 - 8000.0) / 9e6, rel=1e-6)


@pytest.mark.parametrize("seed", range(9))
@pytest.mark.parametrize("step_s", [1.0, 5.0])
def test_calls_and_ceiling_are_kept(seed, step_s):
    scenario = random_study(seed)
    found, other = (journey(scenario, form=form, step_s=step_s) for form in ("speed", "time"))
    assert found.status == other.status
    piece = found.ceiling[np.searchsorted(found.ceiling["from_m"], found.rows["s_m"], side="right") - 1]
    assert (found.rows["v_mps"] ** 2 <= piece["w"] + piece["dw"] * (found.rows["s_m"] - piece["from_m"]) + 1e-6).all()
    for one, two in zip(found.calls, other.calls, strict=True):
        assert one.arrival_s == pytest.approx(two.arrival_s, abs=1.5 * step_s, nan_ok=True)


@pytest.mark.parametrize("at_m", [20.0, 40.0, 60.0, 150.0])
@pytest.mark.parametrize("step_s", [1.0, 2.0, 5.0])
def test_a_slow_train_does_not_step_over_a_stop(at_m, step_s):
    # 6 kN on 200 t: a step of the speed is up to 100 m long, the stop lies within it. 0.03 m/s2 up, 0.5 m/s2 down.
    slow = INVERTER | {"starting_effort_kn": 6.0}
    calls = [call("A", min_dwell_s=20.0)]
    found = run(2.0, form="speed", step_s=step_s, drive=slow, stations={"A": at_m / 1e3}, calls=calls, end="leave")
    top = math.sqrt(2.0 * at_m * 0.03 * 0.5 / 0.53)
    assert found.calls[0].arrival_s == pytest.approx(top / 0.03 + top / 0.5, abs=2e-3)


def test_the_neighbourhood_of_the_balance_is_run_in_time():
    # 20 permille: 39.2 kN; 500 kW hold 12.7 m/s, where dt/dv is infinite.
    weak = INVERTER | {"power_kw": 500.0}
    found = run(15.0, drive=weak, slopes=[(-1.0, 16.0, 20.0)], form="speed")
    assert found.status == "complete"
    assert found.rows["v_mps"][-1] == pytest.approx(500e3 / (200e3 * 9.80665 * 0.020), rel=1e-4)
