"""The greatest effort of inverter drives, adhesion, and efficiency maps, against the formulas."""

import numpy as np
import pytest
from small_trains import INVERTER, make_trains, run

from tractionpower.movement.curves import drive_curves

G = 9.80665


def curves(voltages_v=(3000.0,), **more):
    scenario = make_trains(2.0, **more)
    return drive_curves(scenario.trains[0], scenario.vehicles, scenario.limits, "dc3000", voltages_v)


def test_start_power_and_pull_out():
    found = curves(drive=INVERTER | {"pull_out_kmh": 108.0, "max_current_a": 5000.0}, max_speed_kmh=180.0)
    v, effort = found.speed_mps[1:], found.curves[0].effort_n[1:]
    expected = np.minimum(np.minimum(200e3, 3e6 / v), 3e6 * 30.0 / v**2)
    np.testing.assert_allclose(effort, expected, rtol=1e-12)
    np.testing.assert_allclose(found.curves[0].current_a[1:], expected * v / 0.85 / 3000.0, rtol=1e-9)


def test_several_units_add_up():
    one, two = curves(), curves(vehicles=[{"id": "car", "count": 2}])
    np.testing.assert_allclose(two.curves[0].effort_n, 2.0 * one.curves[0].effort_n, rtol=1e-12)
    np.testing.assert_allclose(two.curves[0].current_a, 2.0 * one.curves[0].current_a, rtol=1e-12)


def test_adhesion_limits_by_the_mass_on_driven_axles():
    adhesion = {"a_kmh": 7.5, "b_kmh": 44.0, "c": 0.13}
    found = curves(adhesive_mass_t=60.0, adhesion=adhesion, drive=INVERTER | {"max_current_a": 5000.0})
    v = found.speed_mps[1:]
    mu = 7.5 / (3.6 * v + 44.0) + 0.13
    np.testing.assert_allclose(found.curves[0].effort_n[1:], np.minimum(60e3 * G * mu, np.minimum(200e3, 3e6 / v)), rtol=1e-12)
    np.testing.assert_allclose(found.adhesion_n[1:], 60e3 * G * mu, rtol=1e-12)


MAP = [
    {"speed_kmh": v, "load_percent": load, "efficiency": eta}
    for v, load, eta in [(0, 20, 0.5), (100, 20, 0.7), (0, 100, 0.8), (50, 100, 0.9), (100, 100, 0.94), (50, 20, 0.6)]
]
MAPPED = {"kind": "inverter", "starting_effort_kn": 100.0, "power_kw": 1e5, "efficiency_map": MAP, "max_current_a": 1e5}


def efficiency(kmh, percent):
    """Bilinear, constant beyond its ends."""
    low = np.interp(kmh, [0, 50, 100], [0.5, 0.6, 0.7])
    high = np.interp(kmh, [0, 50, 100], [0.8, 0.9, 0.94])
    return low + (high - low) * np.clip((percent - 20.0) / 80.0, 0.0, 1.0)


@pytest.mark.parametrize("rise", [2.0, 10.0, 25.0, 40.0])
def test_efficiency_map_at_part_load(rise):
    # Cruising at 72 km/h on a rise takes m g i of the 100 kN that the drive can give.
    found = run(4.0, drive=MAPPED, speed_kmh=72.0, limits=[(-1.0, 5.0, 72.0)], slopes=[(-1.0, 5.0, rise)])
    row = found.rows[20]
    need = 200e3 * G * rise / 1e3
    assert row["traction_n"] == pytest.approx(need, rel=1e-9)
    assert row["power_w"] == pytest.approx(need * 20.0 / efficiency(72.0, need / 1e3), rel=1e-9)


def test_efficiency_map_at_full_load():
    rows = run(3.0, drive=MAPPED).rows[:-1]
    mean = rows["v_mps"] + 0.5 * rows["acceleration_mps2"]
    rows, mean = rows[mean < 44.0], mean[mean < 44.0]
    np.testing.assert_allclose(rows["wheel_w"] / rows["power_w"], efficiency(3.6 * mean, 100.0), rtol=1e-9)


def test_efficiency_map_where_the_current_is_limited():
    # What a limited current leaves is worth less than full load: 400 A at 3 kV.
    rows = run(3.0, drive=MAPPED | {"max_current_a": 400.0}, step_s=0.1).rows[220:-2]
    mean = rows["v_mps"] + 0.05 * rows["acceleration_mps2"]
    np.testing.assert_allclose(rows["current_a"], 400.0, rtol=1e-9)
    np.testing.assert_allclose(rows["wheel_w"] / 1.2e6, efficiency(3.6 * mean, rows["traction_n"] / 1e3), rtol=1e-6)


def test_power_over_voltage():
    points = [{"voltage_v": u, "power_kw": p} for u, p in [(2000.0, 500.0), (2800.0, 2500.0), (3300.0, 3000.0)]]
    drive = INVERTER | {"power_over_voltage": points, "max_current_a": 5000.0}
    for u, power in [(2200.0, 1e6), (2800.0, 2.5e6), (3050.0, 2.75e6), (3500.0, 3e6)]:
        found = curves((u,), drive=drive)
        v = found.speed_mps[1:]
        np.testing.assert_allclose(found.curves[0].effort_n[1:], np.minimum(200e3, power / v), rtol=1e-9)
        rows = run(4.0, voltage_v=u, drive=drive).rows
        assert rows["wheel_w"].max() == pytest.approx(power, rel=1e-9)
        assert rows["power_w"].max() == pytest.approx(power / 0.85, rel=1e-9)
