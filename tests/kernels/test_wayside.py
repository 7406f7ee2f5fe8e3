"""What the track does to a train, against integrals taken anew."""

import numpy as np
import pytest
from small_trains import INVERTER, call, run

G = 9.80665
STRONG = INVERTER | {"power_kw": 1e5, "max_current_a": 1e6}
SLOPES = [(-1.0, 1.0, 0.0), (1.0, 1.3, 20.0), (1.3, 1.35, -30.0), (1.35, 4.0, 6.0)]
MOVING = {"limits": [(-1.0, 4.0, 72.0)], "speed_kmh": 72.0, "drive": STRONG}
STEP = 0.05


def along(found):
    """Return where the middle of each step of constant speed lies, and the resistance there."""
    rows = found.rows[:-1]
    return rows["s_m"] + 0.5 * STEP * rows["v_mps"], rows["resistance_n"]


def mean_of(value, s, length):
    """Return the mean of a function of the place under a train."""
    under = np.linspace(0.0, length, 2001)
    return np.array([np.trapezoid(value(place - under), under) / length for place in s])


def slope(s):
    found = np.zeros_like(s)
    for low, high, permille in SLOPES:
        found[(s >= 1e3 * low) & (s < 1e3 * high)] = permille / 1e3
    return found


@pytest.mark.parametrize("length", [37.0, 400.0])
def test_the_gradient_acts_under_the_whole_train(length):
    s, resistance = along(run(3.0, step_s=STEP, slopes=SLOPES, length_m=length, rotating_mass_factor=1.3, **MOVING))
    some = slice(0, None, 20)
    np.testing.assert_allclose(resistance[some], 200e3 * G * mean_of(slope, s[some], length), atol=0.002 * 200e3 * G * 0.03)


def test_the_gradient_acts_under_the_front_of_a_point():
    s, resistance = along(run(3.0, step_s=STEP, slopes=SLOPES, mass_distribution="point", **MOVING))
    np.testing.assert_allclose(resistance, 200e3 * G * slope(s), atol=1e-3)


def test_gradients_turn_with_the_direction():
    _s, there = along(run(3.0, step_s=STEP, slopes=[(-1.0, 4.0, 5.0)], **MOVING))
    _, back = along(run(3.0, step_s=STEP, slopes=[(-1.0, 4.0, 5.0)], backwards=True, **MOVING))
    np.testing.assert_allclose(there, 200e3 * G * 0.005, rtol=1e-9)
    np.testing.assert_allclose(back, -200e3 * G * 0.005, rtol=1e-9)


@pytest.mark.parametrize(("radius", "per_mille"), [(600.0, 650.0 / 545.0), (300.0, 650.0 / 245.0), (250.0, 500.0 / 220.0)])
def test_curves_act_on_the_part_of_the_train_in_them(radius, per_mille):
    curves = [{"from_km": 1.0, "to_km": 1.1, "radius_m": radius}]
    for backwards, start in ((False, 1000.0), (True, 1900.0)):
        s, resistance = along(run(3.0, step_s=STEP, curves=curves, length_m=400.0, backwards=backwards, **MOVING))
        inside = np.clip(s - start, 0.0, 100.0) - np.clip(s - 400.0 - start, 0.0, 100.0)
        np.testing.assert_allclose(resistance, 200.0 * G * per_mille * inside / 400.0, atol=1e-6)


@pytest.mark.parametrize(("kind", "factor_name", "per_kn"), [("single_track", "tunnel_factor_single_track", 2.0),
                                                          ("double_track", "tunnel_factor_double_track", 1.0)])  # fmt: skip
def test_tunnels_by_weight_or_by_factor(kind, factor_name, per_kn):
    tunnels = [{"from_km": 1.0, "to_km": 2.0, "kind": kind}]
    c = 2.0  # N/(km/h)2
    plain = {"tunnels": tunnels, "length_m": 200.0, "step_s": STEP}
    s, added = along(run(3.0, resistance={"c_n_per_kmh2": c}, **plain, **MOVING))
    share = (np.clip(s - 1000.0, 0.0, 1000.0) - np.clip(s - 1200.0, 0.0, 1000.0)) / 200.0
    np.testing.assert_allclose(added, c * 72.0**2 + share * per_kn * 200.0 * G, rtol=1e-9)
    s, scaled = along(run(3.0, resistance={"c_n_per_kmh2": c, factor_name: 2.5}, **plain, **MOVING))
    np.testing.assert_allclose(scaled, c * 72.0**2 * (1.0 + 1.5 * share), rtol=1e-9)


def test_train_current_limits_of_the_line():
    limits = [{"from_km": 0.5, "to_km": 1.5, "max_current_a": 500.0, "standstill_current_a": 200.0}]
    drive = INVERTER | {"power_kw": 6000.0, "max_current_a": 1500.0}
    train = {"drive": drive, "auxiliaries": {"power_kw": 300.0}, "train_current_limits": limits}
    rows = run(3.0, **train, step_s=0.2, mass_t=400.0).rows
    inside = (rows["s_m"] > 510.0) & (rows["s_m"] < 1490.0)
    assert rows["current_a"][inside] == pytest.approx(500.0)
    assert (rows["limited_by"][inside] == 4).all()
    after = (rows["s_m"] > 1510.0) & (rows["v_mps"] < 40.0)
    assert rows["current_a"][after].max() == pytest.approx(1500.0)
    stop = run(3.0, **train, stations={"A": 1.0}, calls=[call("A", min_dwell_s=20.0)]).rows
    stands = stop[stop["v_mps"] == 0.0][5:-1]
    assert stands["current_a"] == pytest.approx(100.0)  # auxiliaries
