"""What a train takes and gives at a voltage: current limits, auxiliaries, fold-back, ledgers."""

import numpy as np
import pytest
from small_trains import BRAKE, INVERTER, SERIES_MOTORS, TABLE, Stepper, call, make_trains, run

FAST = {"speed_kmh": 108.0, "limits": [(-1.0, 20.0, 600.0)]}
LIMITED = INVERTER | {"power_kw": 20000.0, "max_current_a": 2000.0, "knee_factor": 0.9}


def first(voltage_v, **more):
    return Stepper(make_trains(10.0, **FAST | more)).step(voltage_v)


# --- low voltage -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("voltage_v", "current_a"),
    [(2200.0, 642.857142857), (2350.0, 1050.0), (2500.0, 1457.142857143), (2600.0, 1728.571428571), (2700.0, 2000.0),
     (3300.0, 2000.0)],
)  # fmt: skip
def test_the_current_falls_from_the_knee_to_the_auxiliaries(voltage_v, current_a):
    # U_n 3000 V, a = 0.9, U_min2 = 2000 V where the auxiliaries take 100 A.
    row = first(voltage_v, drive=LIMITED, auxiliaries={"power_kw": 200.0})
    assert row["current_a"] == pytest.approx(current_a, rel=1e-9)
    assert row["wheel_w"] == pytest.approx(0.85 * (current_a * voltage_v - 200e3), rel=1e-9)
    assert row["limited_by"] == (6 if voltage_v < 2700.0 else 5)


@pytest.mark.parametrize("voltage_v", [2000.0, 1999.0, 1000.0, 1.0])
@pytest.mark.parametrize("speed_kmh", [0.0, 0.5, 100.0])
@pytest.mark.parametrize("rise", [0.0, 20.0])
def test_no_traction_at_or_below_the_lowest_voltage(voltage_v, speed_kmh, rise):
    train = {"drive": LIMITED, "auxiliaries": {"power_kw": 200.0}, "slopes": [(-1.0, 11.0, rise)], "resistance": {"a_n": 2e3}}
    stepper = Stepper(make_trains(10.0, speed_kmh=speed_kmh, **train))
    for _ in range(3):
        row = stepper.step(voltage_v)
        assert (row["traction_n"], row["wheel_w"]) == (0.0, 0.0)
        assert row["power_w"] == pytest.approx(200e3 * (voltage_v / 2000.0) ** 2, rel=1e-9)


@pytest.mark.parametrize("voltage_v", [2000.001, 2000.5, 2003.0, 2005.0])
@pytest.mark.parametrize("speed_kmh", [0.0, 0.3])
def test_little_power_near_standstill_does_work_and_nothing_else(voltage_v, speed_kmh):
    # Where the effort P/v is steep, a solution that jumps would take power without motion or move without power.
    slopes = [(-1.0, 11.0, 10.0)]
    stepper = Stepper(make_trains(10.0, drive=LIMITED, slopes=slopes, speed_kmh=speed_kmh, resistance={"a_n": 2e3}))
    for _ in range(50):
        row = stepper.step(voltage_v)
        assert row["power_w"] == pytest.approx(2000.0 * (voltage_v - 2000.0) / 700.0 * voltage_v, rel=1e-6)
        assert row["wheel_w"] == pytest.approx(0.85 * row["power_w"], rel=1e-6)


@pytest.mark.parametrize(("voltage_v", "power_w"), [(3000.0, 290e3), (3600.0, 329.6e3), (1000.0, 60e3), (0.0, 0.0), (-5.0, 0.0)])
def test_auxiliaries(voltage_v, power_w):
    # 200 kW whatever the voltage, down to U_min2, below with its square; 90 kW of heating at 3 kV with its square.
    stops = {"stations": {"A": 0.0, "Z": 5.0}, "calls": [call("A", departure=100.0), call("Z")]}
    stepper = Stepper(make_trains(5.0, auxiliaries={"power_kw": 200.0, "heating_kw": 90.0}, **stops))
    row = stepper.step(voltage_v)
    assert row["power_w"] == row["auxiliary_w"] == pytest.approx(power_w)
    assert row["current_a"] * voltage_v == pytest.approx(power_w)


@pytest.mark.parametrize("drive", [SERIES_MOTORS, TABLE])
def test_the_low_voltage_curve_is_for_inverters_or_where_it_is_given(drive):
    limited = drive | {"max_current_a": 200.0}
    free = first(2200.0, drive=limited, auxiliaries={"power_kw": 100.0})
    assert free["current_a"] == pytest.approx(200.0)
    reduced = first(2200.0, drive=limited | {"knee_factor": 0.9}, auxiliaries={"power_kw": 100.0})
    assert reduced["current_a"] == pytest.approx(50.0 + 150.0 * 200.0 / 700.0)


def test_without_a_current_the_full_power_at_the_knee_is_the_limit():
    most = 3e6 / 0.85 / 2700.0
    assert first(2700.0)["current_a"] == pytest.approx(most)
    assert first(2350.0)["current_a"] == pytest.approx(0.5 * most)


# --- braking -----------------------------------------------------------------------------------------------------

STOP = {"limits": [(-1.0, 5.0, 108.0)], "speed_kmh": 108.0, "stations": {"A": 0.901}}
OWN = {"auxiliaries": {"power_kw": 150.0}, "mass_t": 200.0}


def braking(voltage_v, brake, drive=INVERTER):
    """Return a step at about 29 m/s with 100 kN of braking, of which 60 kN electric."""
    more = {"electric_effort_kn": 60.0, "service_rate_mps2": 0.5} | brake
    if "electric_power_kw" not in more:
        more["electric_power_kw"] = 5000.0
    stepper = Stepper(make_trains(5.0, drive=drive, brake=more, calls=[call("A", min_dwell_s=5.0)], **STOP, **OWN))
    stepper.step(voltage_v)
    stepper.step(voltage_v)
    return stepper.step(voltage_v), stepper


@pytest.mark.parametrize(
    ("voltage_v", "share"), [(3000.0, 1.0), (3600.0, 1.0), (3675.0, 0.75), (3750.0, 0.5), (3900.0, 0.0), (4000.0, 0.0)]
)
@pytest.mark.parametrize("rheostat_kw", [0.0, 300.0, 5000.0])
def test_fold_back_acts_on_what_the_auxiliaries_leave(voltage_v, share, rheostat_kw):
    row, stepper = braking(voltage_v, {"rheostat_kw": rheostat_kw})
    free, other = braking(3000.0, {})
    mean = row["v_mps"] - 0.25
    gained = 0.85 * 60e3 * mean
    refused = (1.0 - share) * (gained - 150e3)
    heated = min(refused, rheostat_kw * 1e3)
    assert row["returned_w"] == pytest.approx(share * (gained - 150e3), rel=1e-9)
    assert row["power_w"] == pytest.approx(-row["returned_w"], rel=1e-9)
    assert row["refused_w"] == pytest.approx(refused, abs=1e-6)
    assert row["braking_resistor_w"] == pytest.approx(heated, abs=1e-6)
    assert row["electric_brake_n"] == pytest.approx(60e3 - (refused - heated) / 0.85 / mean, rel=1e-9)
    assert row["electric_brake_n"] + row["friction_brake_n"] == pytest.approx(100e3, rel=1e-9)
    assert (float(stepper.mover["s_m"]), float(stepper.mover["v_mps"])) == (
        float(other.mover["s_m"]), float(other.mover["v_mps"]),
    )  # fmt: skip
    assert free["returned_w"] > 0.0


def test_auxiliaries_above_the_braking_power():
    row, _ = braking(3900.0, {"electric_effort_kn": 5.0})
    gained = 0.85 * 5e3 * (row["v_mps"] - 0.25)
    assert row["power_w"] == pytest.approx(150e3 - gained, rel=1e-9)
    assert (row["returned_w"], row["refused_w"]) == (0.0, 0.0)


def test_electric_brake_has_power_and_a_lowest_speed():
    brake = {"electric_effort_kn": 80.0, "electric_power_kw": 1000.0, "electric_above_kmh": 18.0, "service_rate_mps2": 0.5}
    rows = run(5.0, brake=brake, calls=[call("A", min_dwell_s=5.0)], step_s=0.1, **STOP, **OWN).rows
    rows = rows[(rows["phase"] == 3) & (rows["v_mps"] > 0.2)][2:]
    mean = rows["v_mps"] - 0.025
    expected = np.where(mean > 5.0, np.minimum(80e3, 1e6 / mean), 0.0)
    np.testing.assert_allclose(rows["electric_brake_n"], expected, rtol=1e-6)
    np.testing.assert_allclose(rows["friction_brake_n"], 100e3 - expected, rtol=1e-6)


def test_braking_without_feeding_back():
    row, _ = braking(3000.0, {"regenerates": False, "rheostat_kw": 600.0})
    assert row["power_w"] == pytest.approx(150e3)
    assert row["braking_resistor_w"] == pytest.approx(600e3)
    assert row["electric_brake_n"] * 0.85 * (row["v_mps"] - 0.25) == pytest.approx(600e3, rel=1e-9)
    motors, _ = braking(3000.0, {"efficiency": 0.85}, drive=SERIES_MOTORS)
    assert (motors["returned_w"], motors["electric_brake_n"], motors["power_w"]) == (0.0, 0.0, pytest.approx(150e3))


# --- ledgers -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("voltage_v", [2150.0, 2600.0, 3000.0, 3800.0])
def test_energy_from_the_line_is_that_of_wheel_auxiliaries_and_brakes(voltage_v):
    # Independent of the losses that the rows tell: work at the wheel by the efficiency.
    line = {"limits": [(-1.0, 2.0, 60.0), (2.0, 2.5, 45.0), (2.5, 9.0, 110.0)], "stations": {"A": 4.0, "Z": 8.0}}
    brake = BRAKE | {"rheostat_kw": 300.0}
    train = {"auxiliaries": {"power_kw": 90.0}, "drive": INVERTER | {"max_current_a": 900.0}, "brake": brake}
    stepper = Stepper(make_trains(8.0, calls=[call("A", min_dwell_s=7.5), call("Z")], slopes=[(-1.0, 9.0, 4.0)], **line, **train))
    line_j = work_j = 0.0
    while not stepper.gone:
        row = stepper.step(voltage_v)
        done = stepper.state.done[0]
        assert row["current_a"] * row["voltage_v"] == pytest.approx(row["power_w"], rel=1e-12)
        kept = 0.85 * done["electric_j"] * (row["electric_brake_n"] * 1.0 / done["electric_ns"] if done["electric_ns"] else 0.0)
        assert row["auxiliary_w"] == pytest.approx(90e3 * done["on_line_s"], rel=1e-9)
        line_j += row["power_w"]
        work_j += done["traction_j"] / 0.85 + row["auxiliary_w"] - (kept - row["braking_resistor_w"])
    assert line_j == pytest.approx(work_j, rel=1e-9)


def test_the_current_limit_of_the_line_is_that_of_the_place_where_the_step_begins():
    limits = [
        {"from_km": 0.0, "to_km": 0.5, "max_current_a": 500.0},
        {"from_km": 0.5, "to_km": 5.0, "max_current_a": 2500.0},
    ]
    rows = run(5.0, train_current_limits=limits, step_s=5.0).rows
    before = rows[rows["s_m"] < 500.0]
    assert before["s_m"][-1] + 5.0 * rows["v_mps"][len(before) - 1] > 500.0
    assert before["current_a"].max() == pytest.approx(500.0)
    assert rows["current_a"].max() > 1000.0


def test_a_standing_train_takes_no_more_than_the_line_allows():
    limits = [{"from_km": -1.0, "to_km": 5.0, "max_current_a": 2000.0, "standstill_current_a": 50.0}]
    stops = {"stations": {"A": 0.0, "Z": 5.0}, "calls": [call("A", departure=100.0), call("Z")]}
    journey = run(5.0, train_current_limits=limits, auxiliaries={"power_kw": 300.0}, **stops)
    standing = journey.rows[journey.rows["time_s"] < 100.0]
    assert set(standing["current_a"].tolist()) == {50.0}
    np.testing.assert_allclose(standing["auxiliary_w"], 50.0 * 3000.0)
    assert journey.rows["auxiliary_w"].max() == pytest.approx(300e3)


def test_power_over_voltage_is_that_at_the_wheel_whatever_the_efficiency():
    grid = [{"speed_kmh": v, "load_percent": p, "efficiency": 0.5 + 0.004 * p} for v in (0.0, 160.0) for p in (0.0, 100.0)]
    table = [{"voltage_v": 2000.0, "power_kw": 1000.0}, {"voltage_v": 3000.0, "power_kw": 3000.0}]
    drive = INVERTER | {"efficiency": None, "efficiency_map": grid, "power_over_voltage": table, "max_current_a": 9000.0}
    rows = run(20.0, drive=drive, voltage_v=2500.0, resistance={"c_n_per_kmh2": 1.0}).rows
    assert rows["wheel_w"].max() == pytest.approx(2000e3, rel=1e-4)
