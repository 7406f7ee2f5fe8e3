"""Characteristics of trains over speed and voltage."""

import numpy as np
import pytest
from small_trains import INVERTER, make_trains

from tractionpower.movement.curves import drive_curves


def curves(voltages_v=None, **more):
    scenario = make_trains(2.0, **more)
    return drive_curves(scenario.trains[0], scenario.vehicles, scenario.limits, "dc3000", voltages_v)


def test_effort_follows_the_voltage():
    found = curves([2000.0, 2350.0, 3000.0], drive=INVERTER | {"max_current_a": 1000.0}, auxiliaries={"power_kw": 100.0})
    v = found.speed_mps[1:]
    for curve, total in zip(found.curves, (50.0, 525.0, 1000.0), strict=True):
        power = 0.85 * (total * curve.voltage_v - 100e3)
        np.testing.assert_allclose(curve.effort_n[1:], np.minimum(200e3, min(power, 3e6) / v), rtol=1e-9, atol=1e-3)
        np.testing.assert_allclose(curve.current_a[1:], (curve.effort_n[1:] * v / 0.85 + 100e3) / curve.voltage_v, rtol=1e-9)


def test_resistance_brake_and_speeds():
    brake = {"electric_effort_kn": 100.0, "electric_power_kw": 2000.0, "electric_above_kmh": 10.0}
    found = curves(resistance={"a_n": 2000.0, "b_n_per_kmh": 30.0, "c_n_per_kmh2": 0.5}, brake=brake)
    kmh = 3.6 * found.speed_mps
    level = 2000.0 + 30.0 * kmh + 0.5 * kmh**2
    np.testing.assert_allclose(found.resistance_n[0.0], level, rtol=1e-12)
    np.testing.assert_allclose(found.resistance_n[10.0], level + 200e3 * 9.80665 * 0.01, rtol=1e-12)
    expected = np.where(kmh > 10.0, np.minimum(100e3, 2e6 / np.maximum(found.speed_mps, 1e-9)), 0.0)
    np.testing.assert_allclose(found.electric_brake_n, expected, rtol=1e-12)
    assert (found.speed_mps[0], found.speed_mps[-1]) == (0.0, pytest.approx(160.0 / 3.6))
    assert (found.mass_kg, found.length_m, np.isinf(found.adhesion_n).all()) == (200e3, 100.0, True)


def test_voltages_between_the_limits_of_the_system():
    volts = [curve.voltage_v for curve in curves().curves]
    assert volts == sorted(volts)
    assert {2000.0, 2700.0, 3000.0, 3600.0} <= set(volts)


def test_a_train_without_a_drive():
    found = curves([3000.0], drive=None)
    assert not found.curves[0].effort_n.any()
