"""What a train takes in a step, against a plain reckoning in Python."""

import numpy as np
import pytest
from small_trains import BRAKE, INVERTER, Stepper, call, make_trains

from tractionpower.kernels.demand import demand_current
from tractionpower.kernels.jit import njit
from tractionpower.kernels.train_step import wish

STOPS = {"stations": {"A": 2.0, "Z": 6.0}, "calls": [call("A", min_dwell_s=20.0), call("Z")]}
OWN = {"power_kw": 90.0, "heating_kw": 60.0}
U_MIN2, U_N = 2000.0, 3000.0
VOLTAGES = (
    -10.0,
    0.0,
    500.0,
    1500.0,
    1999.0,
    2001.0,
    2300.0,
    2699.0,
    2701.0,
    3000.0,
    3400.0,
    3599.0,
    3650.0,
    3800.0,
    3899.0,
    3950.0,
)


@njit
def current_at(tables, state, t, u):
    wish(tables, state, 0, t, 1.0)
    return demand_current(tables, tables.trains[0], state.trials[0], state.demands[0], u)


def auxiliaries(u):
    """Return power of auxiliaries and heating [W]: constant and resistive, below U_min2 with the square of the voltage."""
    if u <= 0.0:
        return 0.0
    return 90e3 * min(1.0, (u / U_MIN2) ** 2) + 60e3 * (u / U_N) ** 2


def limit(u):
    """Return the train's current limit [A]: falls from 0.9 U_n to the auxiliaries' current at U_min2."""
    if u <= U_MIN2:
        return 0.0
    foot = auxiliaries(U_MIN2) / U_MIN2
    return min(1000.0, foot + (1000.0 - foot) * (u - U_MIN2) / (0.9 * U_N - U_MIN2))


def expected(demand, u):
    """Return the current that physics says [A]: traction within the limit, braking netted, the rest folded back."""
    if u <= 0.0:
        return 0.0
    brakes = demand["gained_w"] > 0.0
    at = max(u, U_MIN2) if brakes else u
    own = auxiliaries(at) * demand["on_line"]
    traction = min(demand["need_w"], at * max(limit(at) - auxiliaries(at) / at, 0.0)) * demand["moving"]
    left = own + traction - demand["gained_w"]
    if left < 0.0:
        left *= min(max((3900.0 - at) / 300.0, 0.0), 1.0)
    return left / at * u / at


@pytest.mark.parametrize("volts", [2400.0, 3300.0])
def test_inverter_trains_take_what_physics_says(volts):
    drive = INVERTER | {"max_current_a": 1000.0, "knee_factor": 0.9}
    stepper = Stepper(make_trains(6.0, drive=drive, brake=BRAKE, auxiliaries=OWN, **STOPS))
    kinds = set()
    while not stepper.gone and stepper.time_s < 400.0:
        for u in VOLTAGES:
            found, _ = current_at(stepper.tables, stepper.state, stepper.time_s, u)
            demand = stepper.state.demands[0]
            assert found == pytest.approx(expected(demand, u), rel=1e-9, abs=1e-9), (stepper.time_s, u)
        kinds.add((demand["need_w"] > 0.0, demand["gained_w"] > 0.0))
        stepper.step(volts)
    assert kinds >= {(True, False), (False, True), (False, False)}


def test_the_regime_changes_where_the_characteristic_has_a_kink():
    """Within a regime the current is smooth: second differences are small against those across a kink."""
    drive = INVERTER | {"max_current_a": 1200.0, "knee_factor": 0.9}
    stepper = Stepper(make_trains(6.0, drive=drive, auxiliaries=OWN, **STOPS))
    for _ in range(30):
        stepper.step(3300.0)
    volts = np.arange(2700.0, 3590.0, 1.0)
    current, regime = np.array([current_at(stepper.tables, stepper.state, stepper.time_s, u) for u in volts]).T
    bend = np.abs(np.diff(current, 2))
    same = (regime[2:] == regime[1:-1]) & (regime[1:-1] == regime[:-2])
    assert len(set(regime.tolist())) == 2
    assert bend[same].max() < 1e-3
    assert bend[~same].max() > 0.1


def test_braking_covers_the_own_needs_first():
    stepper = Stepper(make_trains(6.0, drive=INVERTER, brake=BRAKE, auxiliaries={"power_kw": 3000.0}, **STOPS))
    while stepper.step(3300.0)["brake_w"] == 0.0:
        pass
    found, _ = current_at(stepper.tables, stepper.state, stepper.time_s, 3950.0)
    gained = stepper.state.demands[0]["gained_w"]
    assert 0.0 < gained < 3000e3
    assert found == pytest.approx((3000e3 - gained) / 3950.0)  # above the fold-back: it is used on the train
