"""One step in two halves: wish and what the voltage permits; ledgers of a step."""

import numpy as np
import pytest
from random_trains import random_study
from small_trains import DRIVES, INVERTER, SERIES_MOTORS, Stepper, make_trains, run


@pytest.mark.parametrize("seed", range(12))
def test_ledgers_of_random_trains_under_a_voltage_that_wanders(seed):
    rng = np.random.default_rng(seed)
    stepper = Stepper(random_study(seed))
    train = stepper.tables.trains[0]
    h = float(rng.choice([0.5, 1.0, 2.0, 5.0]))
    base = rng.uniform(1950.0, 3800.0)
    for _ in range(400):
        before = (float(stepper.mover["s_m"]), float(stepper.mover["v_mps"]))
        row = stepper.step(base + rng.uniform(-100.0, 100.0), h)
        done = stepper.state.done[0]
        s, v = float(stepper.mover["s_m"]), float(stepper.mover["v_mps"])
        assert s >= before[0]
        assert v >= 0.0
        # work = change of kinetic energy + resistance, in every step; a joule is lost in the last micrometre before a stop
        gained = 0.5 * train["inertia_kg"] * (v * v - before[1] ** 2)
        assert done["traction_j"] - done["brake_j"] - done["resistance_j"] == pytest.approx(gained, rel=1e-9, abs=2.0)
        assert row["voltage_v"] * row["current_a"] == pytest.approx(row["power_w"], rel=1e-12)
        assert row["wheel_w"] * h == pytest.approx(done["traction_j"], rel=1e-12)
        taken = row["wheel_w"] + row["drive_loss_w"] + row["starting_resistor_w"]
        if train["drive"] == 1:
            assert taken == pytest.approx(row["wheel_w"] / 0.85, rel=1e-8, abs=1e-3)
        assert row["drive_loss_w"] >= -1e-6 * abs(taken) or train["drive"] == 3
        assert row["starting_resistor_w"] >= 0.0
        assert row["friction_brake_n"] >= -1e-9
        if stepper.gone:
            break
        assert done["on_line_s"] == pytest.approx(h, rel=1e-9)


def test_a_step_of_several_phases_takes_the_power_that_the_voltage_permits():
    # The limit rises within the step and the train speeds up in a part of it; at 2100 V the power does not suffice.
    drive = INVERTER | {"max_current_a": 800.0}
    stepper = Stepper(
        make_trains(10.0, drive=drive, limits=[(-1.0, 2.0, 72.0), (2.0, 11.0, 144.0)], speed_kmh=72.0, length_m=50.0)
    )
    limited = 0
    while stepper.mover["s_m"] < 2300.0:
        row = stepper.step(2100.0, 2.0)
        most = 2100.0 * 800.0 * 100.0 / 700.0
        assert row["power_w"] <= most * (1 + 1e-9)
        limited += row["power_w"] == pytest.approx(most, rel=1e-9)
    assert limited >= 6


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_a_step_does_not_change_its_trial(kind):
    # Once wished, the same voltage gives the same row, whatever was tried before.
    rows = []
    for detours in (0, 2):
        stepper = Stepper(make_trains(10.0, drive=DRIVES[kind]))
        for _ in range(30):
            stepper.step(2900.0)
        saved = stepper.state.movers.copy()
        for _ in range(detours):
            stepper.step(2150.0)
            stepper.state.movers[:] = saved
            stepper.time_s -= 1.0
        rows.append(stepper.step(2900.0).tolist())
    assert rows[0] == rows[1]


def test_the_wish_is_told():
    low = Stepper(make_trains(5.0)).step(2200.0)
    assert low["wished_n"] == pytest.approx(200e3)
    stepper = Stepper(make_trains(5.0, speed_kmh=72.0))
    row = stepper.step(2200.0)
    assert row["traction_n"] < row["wished_n"]
    assert row["limited_by"] == 6


def test_table_drive_as_the_inverter_that_its_points_come_from():
    v = np.concatenate(([0.0], np.linspace(53.9, 54.1, 3), np.linspace(55.0, 160.0, 211)))
    effort = np.minimum(200.0, 3000.0 * 3.6 / np.maximum(v, 1.0))
    table = {
        "kind": "table",
        "effort": [{"speed_kmh": a, "effort_kn": b} for a, b in zip(v.tolist(), effort.tolist(), strict=True)],
        "current": [
            {"speed_kmh": a, "current_a": b} for a, b in zip(v.tolist(), (effort * v / 3.6 / 0.85 / 3.0).tolist(), strict=True)
        ],
    }
    line = {"slopes": [(-1.0, 21.0, 3.0)], "limits": [(-1.0, 21.0, 130.0)], "resistance": {"a_n": 3000.0}}
    one, other = (run(20.0, drive=drive, **line) for drive in (INVERTER, table))
    assert other.finished_s == pytest.approx(one.finished_s, rel=1e-5)
    assert other.seconds @ other.rows["power_w"] == pytest.approx(one.seconds @ one.rows["power_w"], rel=2e-4)


def test_a_table_between_its_voltages():
    def rows(name, unit, values):
        return [{"speed_kmh": v, "voltage_v": u, name: x * unit} for u, x in values for v in (0.0, 200.0)]

    table = {
        "kind": "table",
        "effort": rows("effort_kn", 1.0, [(2000.0, 60.0), (3000.0, 100.0)]),
        "current": rows("current_a", 1.0, [(2000.0, 800.0), (3000.0, 1000.0)]),
    }
    found = {
        u: Stepper(make_trains(9.0, drive=table, speed_kmh=72.0, mass_t=1e4)).step(u) for u in (1500.0, 2000.0, 2500.0, 3500.0)
    }
    assert found[2000.0]["traction_n"] == pytest.approx(60e3)
    assert found[2500.0]["current_a"] == pytest.approx(900.0)
    mean = found[2500.0]["v_mps"] + 0.5 * found[2500.0]["acceleration_mps2"]
    losses = 0.5 * (2000.0 * 800.0 - 60e3 * mean + 3000.0 * 1000.0 - 100e3 * mean)
    assert found[2500.0]["wheel_w"] == pytest.approx(2500.0 * 900.0 - losses, rel=1e-4)
    assert (found[1500.0]["traction_n"], found[3500.0]["traction_n"]) == (
        pytest.approx(60e3 * 0.75**2, rel=1e-3),  # below U_min2 as auxiliaries
        pytest.approx(100e3),
    )
    assert found[3500.0]["power_w"] == pytest.approx(3e6)


def test_part_effort_of_motors_costs_more_than_the_wheel_gets():
    rows = run(6.0, drive=SERIES_MOTORS, limits=[(-1.0, 7.0, 30.0)], resistance={"a_n": 5000.0}).rows
    cruising = rows[rows["phase"] == 1][5:-2]
    assert cruising["traction_n"] == pytest.approx(5000.0)
    assert (cruising["starting_resistor_w"] > 0.0).all()  # 30 km/h lie below the natural curve of the first grouping
