"""Laws of dry friction in a chain of vehicles: it holds, it stops, it never drives; coasting by closed forms."""

import math

import numpy as np
import pytest
from chains import LOCOMOTIVE, WAGON, WEDGE, Chained, G, advanced, make_chain, spring

METHODS = ("symplectic", "rk4", "euler", "variable")
DRAG = {"specific_a_n_per_kn": 2.0}
BRAKE = {"brake_ratio": 0.3, "rigging_efficiency": 1.0, "friction": {"law": "constant", "friction": 0.2}}


def on_slope(permille, n=5, coupling=WEDGE, drag=DRAG, track=(), **more):
    wagon = WAGON | {"resistance": drag}
    gradients = [{"from_m": -5000.0, "to_m": 5000.0, "permille": permille}]
    return make_chain(
        [{"id": "wagon", "count": n}],
        coupling,
        (wagon,),
        track={"gradients": gradients, "rounding_radius_m": 0.0} | dict(track),
        **more,
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("permille", [1.9, -1.9])
def test_a_train_that_friction_holds_stays_for_hours(method, permille):
    run = {"duration_s": 20_000.0, "step_s": 0.05, "method": method, "record_every_s": 1000.0}
    chained = Chained(on_slope(permille, run=run))
    start = chained.movers["s_m"].copy()
    chained.advance(1e4)
    assert float(chained.ledger["time_s"]) == pytest.approx(1e4)
    assert np.abs(chained.movers["s_m"] - start).max() < 1e-6
    assert (chained.movers["v_mps"] == 0.0).all()


def test_the_brake_and_a_curve_hold_what_resistance_alone_does_not():
    run = {"duration_s": 20_000.0, "step_s": 0.05, "record_every_s": 1000.0}
    curve = {"curves": [{"from_m": -2000.0, "to_m": 2000.0, "radius_m": 300.0}]}  # 650/245 = 2.65 N/kN
    for more, holds in (({}, False), ({"track": curve}, True), ({"brake": BRAKE, "start": {"brake": "full_service"}}, True)):
        chained = Chained(on_slope(4.0, run=run, **more))
        start = chained.movers["s_m"].copy()
        chained.advance(1e4 if holds else 50.0)
        moved = chained.movers["s_m"] - start
        assert (np.abs(moved).max() < 1e-6) == holds
        if not holds:
            assert moved.max() < -1.0  # downhill, that is backwards


@pytest.mark.parametrize("method", METHODS)
def test_a_train_that_nothing_holds_rolls_as_the_slope_less_resistance(method):
    chained = advanced(on_slope(-5.0, run={"step_s": 0.01, "method": method}), 30.0)
    np.testing.assert_allclose(chained.movers["v_mps"], G * 3e-3 * 30.0, rtol=1e-3)


@pytest.mark.parametrize("step_s", [1e-3, 5e-3, 1e-2, 5e-2])
@pytest.mark.parametrize("method", METHODS)
def test_a_stop_is_a_stop(method, step_s):
    # Uphill, with a brake: all come to a stand, stay there, and no speed is ever negative
    soft = spring(2.0, damping_kns_per_m=80.0)
    scenario = on_slope(
        2.0, coupling=soft, brake=BRAKE, start={"speed_kmh": 20.0, "brake": "full_service"},
        run={"step_s": step_s, "method": method, "record_every_s": step_s},
    )  # fmt: skip
    chained = advanced(scenario, 30.0)
    v = chained.vehicle_rows["v_mps"]
    assert v.min() >= -1e-3  # springs may push a vehicle back by a hair as they relax
    assert (v[-1] == 0.0).all()
    rate = G * (0.3 * 0.2 + 0.002 + 0.002)
    assert chained.movers["s_m"][0] - chained.movers["start_m"][0] == pytest.approx((20 / 3.6) ** 2 / (2 * rate), rel=0.02)
    standing = np.argmax((v == 0.0).all(axis=1))
    assert (v[standing:] == 0.0).all()  # no chatter


@pytest.mark.parametrize("step_s", [1e-3, 1e-2, 5e-2])
@pytest.mark.parametrize("method", METHODS)
def test_a_vehicle_that_is_not_held_turns_once(method, step_s):
    # Uphill at 6 permille, resistance of 2 N/kN: it slows at 8 permille, turns, and rolls back at 4 permille
    scenario = on_slope(6.0, n=1, start={"speed_kmh": 10.0}, run={"step_s": step_s, "method": method, "record_every_s": step_s})
    chained = advanced(scenario, 80.0)
    v = chained.vehicle_rows["v_mps"][:, 0]
    signs = np.sign(v[v != 0.0])
    assert (np.diff(signs) != 0.0).sum() == 1
    turned = (10 / 3.6) / (G * 8e-3)
    assert v[-1] == pytest.approx(-G * 4e-3 * (80.0 - turned), rel=3e-3 + step_s / 10)


@pytest.mark.parametrize("threshold_mps", [1e-4, 1e-3, 1e-2, 0.1])
def test_the_speed_below_which_friction_holds_does_not_matter(threshold_mps):
    # Zobory and Bekefi, eq. 1: epsilon
    scenario = on_slope(
        2.0, brake=BRAKE, start={"speed_kmh": 20.0, "brake": "full_service"}, standstill_mps=threshold_mps,
        run={"step_s": 0.005, "method": "rk4"},
    )  # fmt: skip
    chained = advanced(scenario, 30.0)
    rate = G * (0.3 * 0.2 + 0.002 + 0.002)
    assert float(chained.movers["s_m"][0] - chained.movers["start_m"][0]) == pytest.approx((20 / 3.6) ** 2 / (2 * rate), rel=2e-3)
    assert (chained.movers["v_mps"] == 0.0).all()


A, C, MASS = 1500.0, 6.0, 80e3
"""Resistance A + C v2 [N, v in m/s] of a vehicle that coasts."""


def coasting(**run):
    vehicle = WAGON | {"resistance": {"a_n": A, "c_n_per_kmh2": C / 3.6**2}, "rotating_mass_factor": 1.1}
    return make_chain([{"id": "wagon"}], spring(1.0), (vehicle,), start={"speed_kmh": 90.0}, run={"duration_s": 2000.0} | run)


def coasted_mps(t):
    """Return the speed after a time: the closed form by arctan [m/s]."""
    root = math.sqrt(A * C)
    return math.sqrt(A / C) * math.tan(math.atan(25.0 * math.sqrt(C / A)) - t * root / (1.1 * MASS))


def coasted_m(v):
    """Return the way until a speed: the closed form by log [m]."""
    return 1.1 * MASS / (2.0 * C) * math.log((A + C * 625.0) / (A + C * v * v))


@pytest.mark.parametrize(("method", "within"), [("rk4", 1e-9), ("variable", 1e-6), ("symplectic", 1e-4), ("euler", 1e-3)])
def test_coasting_down_follows_arctan_and_log(method, within):
    chained = advanced(coasting(method=method, step_s=0.05, tolerance=1e-9), 200.0)
    v = coasted_mps(200.0)
    assert 15.0 < v < 20.0
    assert float(chained.movers["v_mps"][0]) == pytest.approx(v, rel=within)
    assert float(chained.movers["s_m"][0] - chained.movers["start_m"][0]) == pytest.approx(coasted_m(v), rel=within)


def test_coasting_to_a_stand_takes_the_time_and_way_of_the_closed_form():
    ends = 1.1 * MASS / math.sqrt(A * C) * math.atan(25.0 * math.sqrt(C / A))
    chained = Chained(coasting(method="rk4", step_s=0.01, record_every_s=0.1, ends="standstill"))
    chained.advance(1999.0)
    assert float(chained.ledger["time_s"]) == pytest.approx(ends, abs=0.02)
    assert float(chained.movers["v_mps"][0]) == 0.0
    assert float(chained.movers["s_m"][0] - chained.movers["start_m"][0]) == pytest.approx(coasted_m(0.0), rel=1e-6)


def test_the_error_of_euler_falls_with_the_step():
    errors = []
    for step_s in (0.4, 0.2, 0.1):
        chained = advanced(coasting(method="euler", step_s=step_s), 200.0)
        errors.append(abs(float(chained.movers["v_mps"][0]) - coasted_mps(200.0)))
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.1)


def test_adhesion_caps_the_brake_or_all_resistance_as_printed():
    # Zobory and Bekefi, eq. 6: as printed the cap holds for air drag too
    vehicle = LOCOMOTIVE | {
        "adhesive_mass_t": 80.0, "resistance": {"a_n": 150e3}, "adhesion": {"a_kmh": 0.0, "b_kmh": 44.0, "c": 0.1},
    }  # fmt: skip
    strong = {"brake_ratio": 2.0, "rigging_efficiency": 1.0, "friction": {"law": "constant", "friction": 0.3}}
    cap = 0.1 * 80e3 * G
    for mode, expected in (("brake_only", 150e3 + cap), ("paper", cap)):
        scenario = make_chain([{"id": "loco"}], spring(1.0), (vehicle,), brake=strong, unified_resistance=mode,
                              start={"speed_kmh": 80.0, "brake": "full_service"})  # fmt: skip
        chained = advanced(scenario, 2.0)
        row = chained.vehicle_rows[-1, 0]
        assert -row["a_mps2"] * 80e3 == pytest.approx(expected, rel=1e-3)
        assert row["brake_n"] + row["resistance_n"] == pytest.approx(expected, rel=1e-3)
