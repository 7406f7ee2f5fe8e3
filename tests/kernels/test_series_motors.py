"""DC series motors: natural curves, starting energy, groupings, relay, part effort, against the formulas."""

import itertools

import numpy as np
import pytest
from small_trains import SERIES_MOTORS, Stepper, energy_of, make_trains, run

from tractionpower.movement.curves import drive_curves

PER_M = 3.0 / (np.pi * 1.25)  # revolutions of the motor per metre
AMPS = np.array([0.0, 100.0, 200.0, 300.0, 500.0])
EMF = np.array([0.0, 50.0, 75.0, 90.0, 105.0]) * PER_M
ONE = SERIES_MOTORS | {"groupings": [{"series": 2, "parallel": 2}], "field_steps_percent": [100.0]}


def emf(amps, field=1.0):
    return np.interp(field * amps, AMPS, EMF)


def curves(drive, *voltages_v):
    scenario = make_trains(2.0, drive=drive)
    return drive_curves(scenario.trains[0], scenario.vehicles, scenario.limits, "dc3000", voltages_v)


# --- natural curves ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("voltage_v", [2000.0, 3000.0, 3600.0])
def test_the_natural_curve(voltage_v):
    # v = (u/k - I R) / c phi(I), F = N c phi I eta, line current = branches I; below it the set current is held.
    found = curves(ONE, voltage_v)
    amps = np.linspace(300.0, 60.0, 200)
    speed = (voltage_v / 2.0 - 0.1 * amps) / emf(amps)
    effort, current = 4.0 * 0.97 * emf(amps) * amps, 2.0 * amps
    inside = speed < found.speed_mps[-1]
    effort_found = np.interp(speed[inside], found.speed_mps, found.curves[0].effort_n)
    current_found = np.interp(speed[inside], found.speed_mps, found.curves[0].current_a)
    np.testing.assert_allclose(effort_found, effort[inside], rtol=0.01)
    np.testing.assert_allclose(current_found, current[inside], rtol=0.005)
    below = found.speed_mps < speed[0] - 0.2
    np.testing.assert_allclose(found.curves[0].effort_n[below], effort[0], rtol=1e-6)
    np.testing.assert_allclose(found.curves[0].current_a[below], 600.0, rtol=1e-9)


def test_all_scales_with_the_voltage():
    # Without resistance of the windings the same current flows at speeds in the ratio of the voltages.
    found = curves(ONE | {"motor_resistance_ohm": 0.0}, 2000.0, 3000.0)
    low, high = found.curves
    speed = found.speed_mps[(found.speed_mps > 16.0) & (found.speed_mps < 28.0)]
    at_low, at_high = (np.interp(speed * x, found.speed_mps, c.effort_n) for x, c in ((1.0, low), (1.5, high)))
    np.testing.assert_allclose(at_low, at_high, rtol=2e-3)


def test_weaker_fields_above_the_full_one():
    found = curves(ONE | {"field_steps_percent": [100.0, 50.0]}, 3000.0).curves[0]
    scenario = make_trains(2.0, drive=ONE)
    v = drive_curves(scenario.trains[0], scenario.vehicles, scenario.limits).speed_mps
    amps = np.linspace(300.0, 150.0, 100)
    speed = (1500.0 - 0.1 * amps) / emf(amps, 0.5)
    effort = 4.0 * 0.97 * emf(amps, 0.5) * amps
    inside = (speed > speed[0] + 0.3) & (speed < v[-1])
    np.testing.assert_allclose(np.interp(speed[inside], v, found.effort_n), effort[inside], rtol=0.01)


# --- starting ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("motors", "series", "share"),
    [(4, (4, 2), 1 / 3), (6, (6, 3, 2), 1 / 4), (8, (8, 4, 2), 3 / 11), (4, (2,), 1 / 2), (4, (4,), 1 / 2)],
)
def test_energy_lost_in_starting_resistors(motors, series, share):
    # A constant flux, no losses in motors and gear: a grouping is left at once where the last resistor is out.
    flux = [{"current_a": 1.0, "emf_vs_per_rev": 90.0}, {"current_a": 500.0, "emf_vs_per_rev": 90.0}]
    drive = SERIES_MOTORS | {"motors": motors, "magnetisation": flux, "motor_resistance_ohm": 0.0, "gear_efficiency": 1.0}
    drive |= {"groupings": [{"series": k, "parallel": motors // k} for k in series], "notch_time_s": 0.0}
    drive |= {"field_steps_percent": [100.0]}
    stepper = Stepper(make_trains(20.0, drive=drive))
    top = 3000.0 / (series[-1] * 90.0 * PER_M)
    while stepper.mover["v_mps"] < top * 0.998:
        stepper.step(3000.0, 0.02)
    rows = stepper.rows
    effort = motors * 90.0 * PER_M * 300.0
    assert rows["starting_resistor_w"].sum() / rows["power_w"].sum() == pytest.approx(share, rel=5e-3)
    assert np.quantile(rows["traction_n"], 0.02) == pytest.approx(effort, rel=2e-3)
    np.testing.assert_allclose(rows["drive_loss_w"], 0.0, atol=1.0)


def test_the_set_current_is_held_by_resistors():
    rows = run(10.0, drive=SERIES_MOTORS, step_s=0.1).rows
    held = rows[rows["v_mps"] < 9.0]
    np.testing.assert_allclose(held["current_a"], 300.0, rtol=1e-6)
    mean = held["v_mps"] + 0.05 * held["acceleration_mps2"]
    np.testing.assert_allclose(held["starting_resistor_w"], (3000.0 - 4.0 * (30.0 + emf(300.0) * mean)) * 300.0, rtol=1e-4)
    losses = 4.0 * (0.1 * 300.0**2 + 0.03 * emf(300.0) * mean * 300.0)
    np.testing.assert_allclose(held["drive_loss_w"], losses, rtol=1e-3)


def test_groupings_and_fields_follow_each_other():
    stepper = Stepper(make_trains(30.0, drive=SERIES_MOTORS))
    notches = []
    while stepper.mover["v_mps"] < 40.0:
        stepper.step(3000.0)
        notches.append(int(stepper.mover["notch"]))
    order = [key for key, _ in itertools.groupby(notches)]
    assert order == sorted(set(order))
    assert order[0] == 0
    assert order[-1] == 5  # parallel, weakest field


@pytest.mark.parametrize("step_s", [0.05, 0.1, 1.0])
def test_a_train_starts_again_in_the_first_grouping(step_s):
    # After a stop as at the first start: the second one costs the same energy in resistors.
    line = {"stations": {"A": 2.0, "B": 4.0}, "limits": [(-1.0, 5.0, 90.0)]}
    calls = [{"station": "A", "min_dwell_s": 17.0}, {"station": "B"}]
    rows = run(4.0, drive=SERIES_MOTORS, calls=calls, step_s=step_s, **line).rows
    first, second = (rows["starting_resistor_w"][part].sum() for part in (rows["s_m"] < 2000.0, rows["s_m"] >= 2000.0))
    assert second == pytest.approx(first, rel=0.03)


@pytest.mark.parametrize("kmh", [25.0, 40.0, 55.0, 70.0, 85.0, 100.0])
@pytest.mark.parametrize("rise", [0.0, 4.0])
def test_cruising_without_flutter(kmh, rise):
    # Between notches the wished effort is met; losses lie between nothing and those at full.
    more = {"slopes": [(-1.0, 31.0, rise)], "resistance": {"a_n": 3000.0, "c_n_per_kmh2": 1.0}}
    stepper = Stepper(make_trains(30.0, drive=SERIES_MOTORS, limits=[(-1.0, 31.0, kmh)], **more))
    notches = []
    for n in range(600):
        row = stepper.step(3000.0)
        if n >= 300:
            notches.append(int(stepper.mover["notch"]))
            need = 3000.0 + kmh**2 + 200e3 * 9.80665 * rise / 1e3
            assert row["traction_n"] == pytest.approx(need, rel=1e-9)
            assert row["power_w"] > row["wheel_w"] / 0.97
            assert row["drive_loss_w"] > 0.0
    assert np.count_nonzero(np.diff(notches)) == 0


def test_held_back_by_a_train_current_limit():
    free = energy_of(run(4.0, drive=SERIES_MOTORS), "power_w")
    found = run(4.0, drive=SERIES_MOTORS | {"max_current_a": 400.0})
    assert found.rows["current_a"].max() == pytest.approx(400.0)
    assert energy_of(found, "power_w") < free


def test_the_relay_opens_after_its_delay_and_lets_start_again():
    drive = SERIES_MOTORS | {"relay": {"off_v": 2000.0, "on_v": 2300.0, "delay_s": 3.0}}
    stepper = Stepper(make_trains(30.0, drive=drive, speed_kmh=36.0))
    lived = []
    for n in range(60):
        voltage = 1900.0 if 10 <= n < 20 else 2200.0 if 20 <= n < 30 else 3000.0
        lived.append(stepper.step(voltage)["traction_n"] > 0.0)
    # Three seconds below 2000 V are over at 13; 2200 V close nothing, three seconds of 3000 V do at 33.
    assert lived == [True] * 13 + [False] * 20 + [True] * 27
    short = Stepper(make_trains(30.0, drive=drive, speed_kmh=36.0))
    assert all(short.step(1900.0 if n % 4 < 2 else 2500.0)["traction_n"] > 0.0 for n in range(40))


def test_low_voltage_bites_hard():
    # At 2000 V and 72 km/h a quarter of the current of 3000 V is left, or less.
    found = curves(ONE, 2000.0, 3000.0)
    low, high = (float(np.interp(21.0, found.speed_mps, curve.effort_n)) for curve in found.curves)
    assert low < 0.45 * high
