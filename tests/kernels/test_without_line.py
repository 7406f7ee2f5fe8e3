"""Trains where they may take no traction current: stretches without power, a dead line."""

import numpy as np
import pytest
from small_trains import BRAKE, DRIVES, SERIES_MOTORS, Stepper, call, energy_of, make_trains, run

from tractionpower.kernels.train_tables import LIMITED_BY, PHASES

STRONG = {"kind": "inverter", "starting_effort_kn": 40.0, "power_kw": 40000.0, "efficiency": 0.85, "max_current_a": 20000.0}
FAST = {"max_speed_kmh": 300.0, "drive": STRONG, "speed_kmh": 198.0}  # 55 m/s, 0.2 m/s2 on 200 t, no resistance
AUXILIARIES = {"auxiliaries": {"power_kw": 90.0, "heating_kw": 0.0}}
RUNNING = {"resistance": {"a_n": 3000.0, "c_n_per_kmh2": 0.5}}
RATE = 0.5


def off(low, high, kind="neutral"):
    return {"from_km": low, "to_km": high, "kind": kind}


def words(rows):
    return {(PHASES[row["phase"]], LIMITED_BY[row["limited_by"]]) for row in rows}


# --- stretches without power


@pytest.mark.parametrize("kind", ["neutral", "coast", "lower_pantograph"])
@pytest.mark.parametrize("step_s", [0.02, 1.0, 5.0])
@pytest.mark.parametrize("form", ["time", "speed"])
def test_a_stretch_shorter_than_a_step_is_met_exactly(kind, step_s, form):
    found = run(2.0, power_off=[off(0.5, 0.53, kind)], step_s=step_s, form=form, **FAST)
    a, v0 = 0.2, 55.0
    v1 = np.sqrt(v0 * v0 + 2.0 * a * 500.0)
    v2 = np.sqrt(v1 * v1 + 2.0 * a * 1470.0)
    assert found.finished_s == pytest.approx((v1 - v0) / a + 30.0 / v1 + (v2 - v1) / a, abs=1e-6)
    assert energy_of(found, "wheel_w") == pytest.approx(40e3 * 1970.0, rel=1e-9)
    assert energy_of(found, "power_w") == pytest.approx(40e3 * 1970.0 / 0.85, rel=1e-9)
    np.testing.assert_allclose(found.rows["voltage_v"] * found.rows["current_a"], found.rows["power_w"], rtol=1e-12)
    crossed = found.rows[(found.rows["limited_by"] == LIMITED_BY.index("power_off"))]
    assert len(crossed) >= 1
    assert (crossed["traction_n"] < crossed["wished_n"] - 1.0).all()
    if form == "time":
        assert (found.rows["wished_n"] * found.seconds).sum() == pytest.approx(40e3 * found.finished_s, rel=1e-9)


@pytest.mark.parametrize(("kind", "left_w"), [("neutral", 0.0), ("lower_pantograph", 0.0), ("coast", 90e3)])
def test_auxiliaries_stay_on_while_coasting_and_are_off_in_a_neutral_section(kind, left_w):
    found = run(6.0, power_off=[off(2.0, 3.0, kind)], **FAST | AUXILIARIES)
    rows, ends = found.rows, found.rows["s_m"] + found.rows["moved_m"]
    inside = rows[(rows["s_m"] >= 2000.0) & (ends <= 3000.0)]
    assert len(inside) > 10
    np.testing.assert_allclose(inside["power_w"], left_w)
    np.testing.assert_allclose(inside["auxiliary_w"], left_w)
    assert (inside["voltage_v"] == 3000.0).all()  # of the line
    assert words(inside) == {("unpowered", "power_off")}
    crossing = found.rows[(rows["s_m"] < 2000.0) & (ends > 2000.0)]
    before_s = (np.sqrt(crossing["v_mps"] ** 2 + 2.0 * 0.2 * (2000.0 - crossing["s_m"])) - crossing["v_mps"]) / 0.2
    np.testing.assert_allclose(crossing["auxiliary_w"], 90e3 * before_s if left_w == 0.0 else 90e3)
    np.testing.assert_allclose(crossing["traction_n"], 40e3 * before_s)
    lost = 1000.0 / np.sqrt(55.0**2 + 2.0 * 0.2 * 2000.0) if left_w == 0.0 else 0.0
    assert energy_of(found, "auxiliary_w") == pytest.approx(90e3 * (found.finished_s - lost), rel=1e-9)


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_the_step_does_not_matter(kind):
    line = RUNNING | {"power_off": [off(1.0, 1.03), off(2.2, 2.7, "coast")], "drive": DRIVES[kind], "brake": BRAKE}
    line |= {"stations": {"B": 6.0}, "calls": [call("B")]}
    coarse, fine = (run(6.0, step_s=step_s, **line) for step_s in (1.0, 0.05))
    assert coarse.finished_s == pytest.approx(fine.finished_s, rel=1e-3 if kind == "inverter" else 3e-3)
    assert energy_of(coarse, "power_w") == pytest.approx(energy_of(fine, "power_w"), rel=2e-3 if kind == "inverter" else 6e-3)
    for found in (coarse, fine):
        assert all(ledger.closes for ledger in found.ledgers().values())


@pytest.mark.parametrize("kind", ["series_motors", "table"])
def test_motion_that_only_a_part_of_the_step_powers_keeps_to_the_voltage(kind):
    # Under 2300 V the effort is cut in the powered rest of a step, too; the energy is that of voltage, current and step.
    line = RUNNING | {"power_off": [off(0.4, 0.41), off(0.8, 0.82)], "drive": DRIVES[kind]}
    coarse, fine = (run(2.0, voltage_v=2300.0, step_s=step_s, **line) for step_s in (1.0, 0.05))
    assert coarse.finished_s == pytest.approx(fine.finished_s, rel=2e-3)
    assert coarse.ledgers()["pantograph_to_wheel"].closes
    assert energy_of(coarse, "power_w") == pytest.approx(energy_of(fine, "power_w"), rel=1e-2)


@pytest.mark.parametrize("rheostat_kw", [0.0, 400.0, 1e5])
def test_nothing_is_fed_back_and_resistors_take_what_they_can(rheostat_kw):
    brake = BRAKE | {"rheostat_kw": rheostat_kw, "efficiency": 0.9, "electric_above_kmh": 10.0}
    line = {"power_off": [off(2.0, 6.5, "coast")], "stations": {"B": 6.0}, "calls": [call("B")], "brake": brake}
    found = run(6.0, speed_kmh=120.0, limits=[(-1.0, 7.0, 130.0)], **line | AUXILIARIES)
    slows = found.rows[(found.rows["phase"] == PHASES.index("braking")) & (found.rows["v_mps"] > 5.0)]
    assert len(slows) > 20
    assert (slows["returned_w"] == 0.0).all()
    np.testing.assert_allclose(slows["power_w"], 90e3)
    given = np.minimum(np.minimum(0.9 * slows["electric_brake_n"] * slows["v_mps"], rheostat_kw * 1e3), 0.9 * 2e6)
    assert (slows["braking_resistor_w"] <= rheostat_kw * 1e3 * (1.0 + 1e-12)).all()
    np.testing.assert_allclose(slows["braking_resistor_w"], given, rtol=0.05)
    np.testing.assert_allclose(slows["electric_brake_n"] + slows["friction_brake_n"], 200e3 * RATE, rtol=1e-9)
    assert (slows["refused_w"] == 0.0).all()
    assert all(ledger.closes for ledger in found.ledgers().values())


def test_brakes_feed_back_outside_and_not_inside():
    line = {"stations": {"B": 6.0}, "calls": [call("B")], "brake": BRAKE, "limits": [(-1.0, 7.0, 130.0)], "speed_kmh": 120.0}
    plain, cut = run(6.0, **line), run(6.0, power_off=[off(5.0, 5.9)], **line)
    for name in ("s_m", "v_mps"):  # who brakes does not change the motion
        np.testing.assert_allclose(cut.rows[name], plain.rows[name], atol=1e-6)
    outside = cut.rows["s_m"] > 5900.0
    np.testing.assert_allclose(cut.rows["returned_w"][outside], plain.rows["returned_w"][outside], atol=1e-3)
    assert 0.0 < energy_of(cut, "returned_w") < 0.5 * energy_of(plain, "returned_w")


def test_a_train_that_comes_to_a_stand_without_power_is_stuck_and_says_why():
    found = run(6.0, power_off=[off(0.5, 1.5)], slopes=[(-1.0, 7.0, 8.0)], limits=[(-1.0, 7.0, 30.0)], **RUNNING)
    assert found.status == "stuck"
    assert words(found.rows[-5:]) == {("unpowered", "power_off")}
    assert 500.0 < found.end_m < 1500.0
    assert (found.rows[-5:]["power_w"] == 0.0).all()


def test_a_train_rolls_out_of_a_stretch_downhill_and_goes_on():
    found = run(6.0, power_off=[off(-0.5, 0.6)], slopes=[(-1.0, 7.0, -6.0)], limits=[(-1.0, 7.0, 60.0)], **RUNNING)
    assert found.status == "complete"
    assert found.rows["v_mps"].max() <= 60.0 / 3.6 + 1e-9  # the brakes keep the ceiling


def test_the_auxiliaries_of_a_train_that_stops_in_a_neutral_section_are_off():
    line = {"stations": {"B": 0.5}, "calls": [call("B", min_dwell_s=30.0)], "slopes": [(-1.0, 7.0, -8.0)]}
    found = run(3.0, power_off=[off(0.4, 0.6)], brake=BRAKE, **line | RUNNING | AUXILIARIES)
    stands = found.rows[(found.rows["phase"] == PHASES.index("dwelling"))][1:-1]
    assert len(stands) >= 27
    assert (stands["auxiliary_w"] == 0.0).all()
    assert found.status == "complete"


def test_where_two_stretches_overlap_what_takes_more_away_holds():
    found = run(6.0, power_off=[off(1.0, 3.0, "coast"), off(2.0, 2.5)], **FAST | AUXILIARIES)
    rows, ends = found.rows, found.rows["s_m"] + found.rows["moved_m"]
    for low, high, expected in ((1000.0, 2000.0, 90e3), (2000.0, 2500.0, 0.0), (2500.0, 3000.0, 90e3)):
        inside = rows[(rows["s_m"] >= low) & (ends <= high)]
        assert len(inside) >= 5
        np.testing.assert_allclose(inside["power_w"], expected)


# --- a dead line


def coasting(**more):
    """Return a train at 72 km/h without resistance whose line is to die."""
    brake = {"brake": {"service_rate_mps2": RATE}}
    return Stepper(make_trains(10.0, **{"speed_kmh": 72.0, "limits": [(-1.0, 11.0, 72.0)]} | brake | AUXILIARIES | more))


@pytest.mark.parametrize("coast_s", [0.0, 7.3, 20.0])
def test_a_train_coasts_then_brakes_to_a_stand_and_waits(coast_s):
    stepper = coasting(coast_without_voltage_s=coast_s)
    for _ in range(5):
        stepper.step(3000.0)
    begun = float(stepper.mover["s_m"])
    for _ in range(int(coast_s) + 70):
        stepper.step(0.0)
    rows = stepper.rows[5:]
    way = 20.0 * coast_s + 20.0**2 / (2.0 * RATE)
    assert float(stepper.mover["s_m"]) - begun == pytest.approx(way, abs=1e-6)  # split within the step
    assert float(stepper.mover["v_mps"]) == 0.0
    for name in ("power_w", "current_a", "auxiliary_w", "traction_n", "electric_brake_n"):
        assert (rows[name] == 0.0).all()
    t = np.arange(len(rows))
    np.testing.assert_allclose(rows["v_mps"], np.clip(20.0 - RATE * np.maximum(t - coast_s, 0.0), 0.0, 20.0), atol=1e-9)
    assert {PHASES[code] for code in rows["phase"][t > coast_s + 40.0]} == {"unpowered"}
    braking = rows["phase"] == PHASES.index("braking")
    assert (braking == ((t >= coast_s) & (t < coast_s + 40.0))).all()
    assert {LIMITED_BY[code] for code in rows["limited_by"][rows["v_mps"] == 0.0]} == {"voltage"}
    assert float(stepper.mover["held_s"]) > 20.0
    first = stepper.step(3000.0)  # it starts again by itself
    assert PHASES[first["phase"]] == "accelerating"
    assert float(stepper.mover["v_mps"]) > 0.1
    assert float(stepper.mover["held_s"]) == 0.0


def test_only_an_unbroken_time_without_voltage_counts():
    stepper = coasting(coast_without_voltage_s=10.0)
    for n in range(60):
        stepper.step(3000.0 if n % 8 == 7 else 0.0)
    assert not (stepper.rows["phase"] == PHASES.index("braking")).any()


def test_the_service_brake_is_that_of_braking_curves_on_a_slope():
    for permille in (-12.0, 8.0):
        stepper = coasting(coast_without_voltage_s=0.0, slopes=[(-1.0, 11.0, permille)], rotating_mass_factor=1.1)
        for _ in range(20):
            stepper.step(0.0)
        rate = RATE + 9.80665 * permille / 1000.0 / 1.1
        np.testing.assert_allclose(np.diff(stepper.rows["v_mps"]), -rate, rtol=1e-6)


def test_a_train_held_on_a_fall_does_not_roll_off():
    stepper = coasting(coast_without_voltage_s=0.0, slopes=[(-1.0, 11.0, -15.0)], limits=[(-1.0, 11.0, 100.0)])
    for _ in range(200):
        stepper.step(0.0)
    stands = stepper.rows[-60:]
    assert (stands["v_mps"] == 0.0).all()
    assert len(np.unique(stands["s_m"])) == 1


def test_lower_limits_and_stops_are_kept_while_it_coasts_and_brakes():
    limits = [(-1.0, 0.5, 72.0), (0.5, 0.9, 50.0), (0.9, 11.0, 100.0)]
    for coast_s in (5.0, 12.0, 500.0):
        stepper = coasting(coast_without_voltage_s=coast_s, limits=limits, stations={"B": 1.5}, calls=[call("B"), call("B2")][:1])
        for _ in range(120):
            stepper.step(0.0)
        rows = stepper.rows
        inside = (rows["s_m"] >= 500.0) & (rows["s_m"] <= 900.0)
        assert rows["v_mps"][inside].max(initial=0.0) <= 50.0 / 3.6 + 1e-9
        assert rows["s_m"].max() <= 1500.0
        arrived = float(stepper.state.arrived_s[0])
        if coast_s == 500.0:
            assert rows["s_m"][-1] == 1500.0
            assert np.isfinite(arrived)
        else:  # a forced stand is no call
            assert rows["s_m"][-1] < 1500.0
            assert np.isnan(arrived)


def test_a_train_does_not_leave_its_stop_without_voltage():
    stations = {"A": 0.0, "B": 8.0}
    calls = [call("A", departure="00:00:10"), call("B")]
    stepper = Stepper(make_trains(10.0, stations=stations, calls=calls, runs=None, time=0.0, slopes=[(-1.0, 11.0, -5.0)]))
    for n in range(40):
        stepper.step(0.0 if n >= 5 and n < 30 else 3000.0)
    rows = stepper.rows
    assert float(stepper.state.left_s[0]) == 30.0
    assert (rows["s_m"][:31] == 0.0).all()
    assert words(rows[:10]) == {("dwelling", "nothing")}
    assert words(rows[10:30]) == {("unpowered", "voltage")}
    assert float(stepper.mover["s_m"]) > 1.0


def test_motors_start_again_in_the_first_grouping():
    drive = SERIES_MOTORS | {"relay": {"off_v": 2000.0, "on_v": 2200.0, "delay_s": 2.0}}
    stepper = Stepper(make_trains(10.0, drive=drive, slopes=[(-1.0, 11.0, 4.0)], speed_kmh=50.0, **RUNNING))
    for _ in range(30):
        row = stepper.step(3000.0)
    assert row["grouping"] == 2
    for _ in range(20):
        stepper.step(0.0)
    assert bool(stepper.mover["relay_open"])
    groupings = [int(stepper.step(3000.0)["grouping"]) for _ in range(8)]
    assert groupings[:2] == [0, 0]  # the relay waits for its delay
    assert [each for each in groupings if each][-1] == 2
    assert bool(stepper.mover["relay_open"]) is False


def test_a_train_without_a_drive_rolls_on():
    stepper = Stepper(make_trains(4.0, drive=None, speed_kmh=72.0, limits=[(-1.0, 5.0, 72.0)], coast_without_voltage_s=0.0))
    for _ in range(50):
        stepper.step(0.0)
    assert (stepper.rows["v_mps"] == 20.0).all()


# --- current limits of the line


def limited(motion_a, standstill_a, **more):
    rows = [{"from_km": -1.0, "to_km": 11.0, "max_current_a": motion_a, "standstill_current_a": standstill_a}]
    calls = [call("B", min_dwell_s=40.0), call("C")]
    auxiliaries = {"auxiliaries": {"power_kw": 90.0, "heating_kw": 60.0}}
    line = {"train_current_limits": rows, "stations": {"B": 2.0, "C": 4.0}, "calls": calls, "brake": BRAKE}
    return run(4.0, **line | auxiliaries | more)


@pytest.mark.parametrize(("standstill_a", "expected_a", "by"), [(80.0, 50.0, "nothing"), (40.0, 40.0, "standstill_current"),
                                                              (10.0, 10.0, "standstill_current")])  # fmt: skip
def test_at_standstill_the_line_cuts_heating_then_auxiliaries(standstill_a, expected_a, by):
    found = limited(700.0, standstill_a)
    stands = found.rows[found.rows["phase"] == PHASES.index("dwelling")][1:-1]
    assert len(stands) >= 38
    np.testing.assert_allclose(stands["current_a"], expected_a, rtol=1e-12)
    np.testing.assert_allclose(stands["auxiliary_w"], 3000.0 * expected_a, rtol=1e-12)
    assert words(stands) == {("dwelling", by)}
    moves = found.rows[found.rows["moved_m"] > 0.0]
    np.testing.assert_allclose(moves["auxiliary_w"][5:20], 150e3)
    assert (moves["current_a"] <= 700.0 + 1e-9).all()
    assert "line_current" in {LIMITED_BY[code] for code in moves["limited_by"]}
    assert "standstill_current" not in {LIMITED_BY[code] for code in moves["limited_by"]}


def test_a_lower_limit_in_motion_leaves_standstill_alone():
    assert words(limited(200.0, 100.0).rows) >= {("accelerating", "line_current"), ("dwelling", "nothing")}
