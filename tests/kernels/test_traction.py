"""Traction at a voltage, against tables and limits written out."""

import numpy as np
import pytest
from small_trains import INVERTER, Stepper, make_trains

TWO_VOLTS = {
    "kind": "table",
    "effort": [
        {"speed_kmh": v, "voltage_v": u, "effort_kn": kn} for u, kn in ((2400.0, 120.0), (3300.0, 180.0)) for v in (0.0, 200.0)
    ],
    "current": [
        {"speed_kmh": v, "voltage_v": u, "current_a": a + 5.0 * v}
        for u, a in ((2400.0, 200.0), (3300.0, 300.0))
        for v in (0.0, 200.0)
    ],
}
FAST = {"speed_kmh": 90.0, "limits": [(-1.0, 20.0, 600.0)], "auxiliaries": {}}


def first(volts, **more):
    return Stepper(make_trains(10.0, **FAST | more)).step(volts)


def mean_speed(row):
    return row["moved_m"] / 1.0


@pytest.mark.parametrize("volts", [2400.0, 2500.0, 2850.0, 3100.0, 3300.0])
def test_current_and_losses_of_a_table_are_linear_in_the_voltage(volts):
    row = first(volts, drive=TWO_VOLTS)
    share = (volts - 2400.0) / 900.0
    # both voltages at their own mean speed of the step, of which effort and current are those of the table
    ends = []
    for u, force, current in ((2400.0, 120e3, 200.0), (3300.0, 180e3, 300.0)):
        v = 25.0 + 0.5 * force / 200e3
        amperes = current + 5.0 * 3.6 * v
        ends.append((amperes, u * amperes - force * v))
    amperes, loss = ((1.0 - share) * low + share * high for low, high in zip(*ends, strict=True))
    assert row["current_a"] == pytest.approx(amperes, rel=1e-6)
    assert row["wheel_w"] == pytest.approx(volts * amperes - loss, rel=1e-6)


@pytest.mark.parametrize("volts", [3400.0, 3800.0])
def test_above_its_highest_voltage_a_table_keeps_its_power(volts):
    row, top = first(volts, drive=TWO_VOLTS), first(3300.0, drive=TWO_VOLTS)
    assert row["power_w"] == pytest.approx(top["power_w"], rel=1e-9)
    assert row["wheel_w"] == pytest.approx(top["wheel_w"], rel=1e-9)


@pytest.mark.parametrize(
    ("volts", "power_w"),
    [(2350.0, 1200e3), (2700.0, 1800e3), (2850.0, 2400e3), (3000.0, 3000e3), (3600.0, 3000e3)],
)
def test_power_over_voltage(volts, power_w):
    points = [
        {"voltage_v": u, "power_kw": kw} for u, kw in ((2000.0, 600.0), (2700.0, 1800.0), (3000.0, 3000.0), (4000.0, 3000.0))
    ]
    row = first(volts, drive=INVERTER | {"power_over_voltage": points})
    assert row["wheel_w"] == pytest.approx(power_w, rel=1e-6)
    assert row["power_w"] == pytest.approx(power_w / 0.85, rel=1e-6)
    assert row["limited_by"] == (6 if volts < 3000.0 else 3)


@pytest.mark.parametrize("volts", [2500.0, 3000.0, 3500.0])
def test_a_limit_of_the_line_holds_for_the_whole_train(volts):
    limits = [{"from_km": -1.0, "to_km": 11.0, "max_current_a": 500.0}]
    row = first(volts, drive=INVERTER, train_current_limits=limits, auxiliaries={"power_kw": 200.0})
    assert row["current_a"] == pytest.approx(500.0)
    assert row["wheel_w"] == pytest.approx(0.85 * (500.0 * volts - 200e3), rel=1e-9)
    assert row["limited_by"] == 4


def test_efficiency_of_a_map_is_that_of_the_effort_that_is_got():
    grid = [
        {"speed_kmh": v, "load_percent": load, "efficiency": 0.80 + 0.001 * load}
        for v in (0.0, 200.0)
        for load in (0.0, 50.0, 100.0)
    ]
    drive = {key: value for key, value in INVERTER.items() if key != "efficiency"} | {"efficiency_map": grid}
    limits = [{"from_km": -1.0, "to_km": 11.0, "max_current_a": 700.0}]
    row = first(3000.0, drive=drive, train_current_limits=limits)
    share = row["traction_n"] / (3000e3 / mean_speed(row))
    assert row["current_a"] == pytest.approx(700.0)
    assert row["wheel_w"] / row["power_w"] == pytest.approx(0.80 + 0.1 * share, rel=1e-6)
    assert 0.4 < share < 0.8


def test_traction_grows_with_the_voltage():
    for drive in (INVERTER | {"max_current_a": 900.0}, TWO_VOLTS):
        efforts = [first(volts, drive=drive)["traction_n"] for volts in np.arange(2050.0, 3300.0, 50.0)]
        assert (np.diff(efforts) >= -1e-6).all()
        assert efforts[-1] > 1.2 * efforts[0]
