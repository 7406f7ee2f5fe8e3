"""The air brake: exact exponentials and delays, cylinders against a second solver, friction by hand, stopping distances."""

import math

import numpy as np
import pytest
from brake_reference import Reference
from hypothesis import given, settings
from hypothesis import strategies as st
from small_controls import GEAR, LENGTH_M, brake_force_at, compiled, friction_at, pressures, reduction, scenario

BAR = 1e5
PSI = 6894.757293168361

FREE = {"pipe_pressure_bar": 5.0, "gain": 1.0, "cylinder_pressure_bar": 5.0}
"""A pipe whose cylinders repeat its reduction: nothing but Z(3)."""


def braked(*commands, wagons=2, **air):
    rows = [{"time_s": at} | (how if isinstance(how, dict) else {"brake": how}) for at, how in commands]
    return scenario(*rows, wagons=wagons, air_brake=air)


# --- the pipe ----------------------------------------------------------------------------------------------------


@pytest.mark.interpreted
def test_the_reduction_is_equation_3():
    # Z(3): p = p* exp(-t/T) + p_stac (1 - exp(-t/T)), and from p* again where a command comes before the last has settled
    given_ = braked((2.0, {"reduction_bar": 1.2}), (3.0, {"reduction_bar": 0.3}), application_time_constant_s=2.0,
                    release_time_constant_s=4.0, **FREE)  # fmt: skip
    chain, state = compiled(given_)
    for time in (2.1, 2.5, 2.9):
        assert reduction(chain, state, time) == pytest.approx(1.2e5 * (1.0 - math.exp(-(time - 2.0) / 2.0)), rel=1e-13)
    prevailing = 1.2e5 * (1.0 - math.exp(-0.5))
    assert prevailing > 0.3e5
    for time in (3.0, 4.0, 30.0):
        left = math.exp(-(time - 3.0) / 4.0)
        assert reduction(chain, state, time) == pytest.approx(prevailing * left + 0.3e5 * (1.0 - left), rel=1e-13)
    assert reduction(chain, state, 0.0) == reduction(chain, state, 1.999) == 0.0


@pytest.mark.parametrize("step", [0.0007, 0.01, pytest.param(0.37, marks=pytest.mark.interpreted), 3.0])
def test_each_vehicle_sees_the_reduction_later_exact_to_rounding(step):
    given_ = braked((1.0, 10), (2.5, 3), (2.6, "full_service"), (9.0, "release"), wagons=4, propagation_mps=50.0, **FREE)
    times = np.append(np.arange(0.0, 5.0 if step < 0.01 else 20.0, step), 20.0)
    cylinders, _ = pressures(given_, times)
    chain, state = compiled(given_)
    for i in range(5):
        late = times - i * LENGTH_M / 50.0
        expected = [reduction(chain, state, time) for time in late]
        np.testing.assert_allclose(cylinders[:, i], expected, rtol=1e-11, atol=1e-6)
    assert np.ptp(cylinders[:, 4]) > 1e5


def test_time_to_95_percent_is_three_time_constants():
    given_ = braked((0.0, "full_service"), wagons=0, application_time_constant_s=2.0, **FREE)
    times = np.linspace(0.0, 8.0, 80_001)
    cylinders, _ = pressures(given_, times)
    t95 = times[np.argmax(cylinders[:, 0] >= 0.95 * 1.5e5)]
    assert t95 / 2.0 == pytest.approx(-math.log(0.05), abs=1e-4)  # 2.9957


BANDS = {"P": ({}, (3.0, 5.0), (15.0, 20.0)),
         "G": ({"application_time_constant_s": 8.0, "release_time_constant_s": 17.5}, (18.0, 30.0), (45.0, 60.0))}  # fmt: skip


@pytest.mark.parametrize("regime", BANDS)
@pytest.mark.parametrize("word", ["full_service", "emergency"])
def test_times_of_the_regimes_lie_in_the_bands_of_uic(regime, word):
    # fill to 95 % in 3-5 s (P) or 18-30 s (G), release of 95 % in 15-20 s or 45-60 s: T = t95 / 3
    air, fill, release = BANDS[regime]
    times = np.linspace(0.0, 200.0, 20_001)
    filling, _ = pressures(braked((0.0, word), wagons=0, **air), times)
    t95 = times[np.argmax(filling[:, 0] >= 0.95 * 3.8e5)]
    assert fill[0] <= t95 <= fill[1]
    emptying, _ = pressures(braked((0.0, "full_service"), (100.0, "release"), wagons=0, **air), times)
    t95 = times[(times > 100.0) & (emptying[:, 0] <= 0.05 * 3.8e5)][0] - 100.0
    assert release[0] <= t95 <= release[1]


def test_cylinders_of_arshad():
    # 2.5 times the reduction, at most 64 psi: 7, 15 and 26 psi from 90 psi
    psi = PSI / BAR
    air = {"pipe_pressure_bar": 90.0 * psi, "full_service_reduction_bar": 26.0 * psi, "gain": 2.5,
           "cylinder_pressure_bar": 64.0 * psi}  # fmt: skip
    found = []
    for asked in (7.0, 15.0, 26.0):
        cylinders, _ = pressures(braked((0.0, {"reduction_bar": asked * psi}), **air), [0.0, 300.0])
        found.append(cylinders[1] / PSI)
    np.testing.assert_allclose(found, np.repeat([[17.5], [37.5], [64.0]], 3, axis=1), rtol=1e-12)


# --- cylinders ---------------------------------------------------------------------------------------------------


times_ = st.floats(0.0, 12.0).map(lambda t: round(t, 3))
constants = st.sampled_from([0.2, 1.0, 1.5, 4.0])
asked_ = st.one_of(st.floats(0.0, 2.5).map(lambda r: round(r, 2)), st.just("emergency"))


@given(
    commands=st.lists(st.tuples(times_, asked_), min_size=1, max_size=5, unique_by=lambda each: each[0]),
    lags=st.tuples(constants, constants, constants, constants),
    cuts=st.lists(times_, max_size=12),
    emergency=st.sampled_from([3.0, 4.5]),
)
@settings(max_examples=25, deadline=None, derandomize=True)
def test_cylinders_against_a_second_solver(commands, lags, cuts, emergency):
    commands = sorted(commands)
    air = {"gain": 2.0, "cylinder_pressure_bar": 3.0, "cylinder_emergency_bar": emergency, "propagation_mps": 40.0}
    names = ("application_time_constant_s", "release_time_constant_s", "cylinder_fill_s", "cylinder_release_s")
    air |= dict(zip(names, lags, strict=True))
    rows = [(at, how if isinstance(how, str) else {"reduction_bar": how}) for at, how in commands]
    given_ = braked(*rows, wagons=1, **air)
    times = sorted({0.0, 15.0, *cuts})
    cylinders, _ = pressures(given_, times)
    reference = Reference(given_.case.air_brake, commands)
    for i in range(2):
        np.testing.assert_allclose(cylinders[:, i] / BAR, reference.cylinder(i * LENGTH_M / 40.0, times), atol=2e-6)
    once, _ = pressures(given_, [0.0, 15.0])
    np.testing.assert_allclose(cylinders[-1], once[-1], rtol=1e-12, atol=1e-6)  # however the time is cut


@pytest.mark.interpreted
@pytest.mark.parametrize("fill", [0.0, 1.0, 4.0 / 3.0])  # at once, unlike and like the time constant of the pipe
def test_a_cylinder_that_meets_its_falling_aim_empties_with_the_other_time_constant(fill):
    # By hand: filling follows 1 - e(-t/T); released before it is full, the cylinder still fills until it meets its aim.
    air = {"cylinder_fill_s": fill, "cylinder_release_s": 2.0, "release_time_constant_s": 4.0, **FREE}
    given_ = braked((0.0, {"reduction_bar": 1.5}), (3.0, "release"), wagons=0, **air)
    fine, _ = pressures(given_, np.linspace(0.0, 12.0, 1201))
    coarse, _ = pressures(given_, [0.0, 12.0])
    assert coarse[-1, 0] == pytest.approx(fine[-1, 0], rel=1e-12)
    reference = Reference(given_.case.air_brake, [(0.0, 1.5), (3.0, 0.0)])
    if fill > 0.0:
        expected = reference.cylinder(0.0, np.linspace(0.0, 12.0, 13))
        np.testing.assert_allclose(fine[::100, 0] / BAR, expected, atol=1e-7)
        after = fine[301:, 0]
        assert after.argmax() > 0  # it rose on
    else:
        assert fine[300, 0] == pytest.approx(1.5e5 * (1.0 - math.exp(-3.0 * 0.75)), rel=1e-12)


def test_emergency_fills_no_faster_than_full_service_and_its_limit_holds_until_the_next_application():
    given_ = braked((0.0, "emergency"), (30.0, 3), (60.0, 9), wagons=0, cylinder_emergency_bar=4.2)
    times = np.linspace(0.0, 90.0, 9001)
    cylinders, _ = pressures(given_, times)
    bar = cylinders[:, 0] / BAR
    assert bar[2999] == pytest.approx(4.2, rel=1e-8)
    assert np.abs(np.diff(bar)).max() < 4.2 * 0.01 / (4.0 / 3.0)  # no leap, neither up nor down
    assert np.all(np.diff(bar[3000:6000]) < 1e-9)
    assert bar[-1] == pytest.approx(0.9 * 3.8 / 1.5, rel=1e-6)
    own, _ = pressures(braked((0.0, "emergency"), wagons=0, cylinder_emergency_fill_s=0.0), [0.0, 0.3])
    assert own[-1, 0] == 3.8e5


def test_the_independent_brake_has_its_own_lag_and_the_greater_pressure_acts():
    set_twice = [{"time_s": at, "independent_bar": bar} for at, bar in ((1.0, 2.0), (3.0, 0.5))]
    given_ = scenario(*set_twice, {"time_s": 3.0, "brake": 8}, air_brake={"independent_time_constant_s": 1.25})
    _, own = pressures(given_, [0.0, 0.9, 2.0, 3.7, 5.0])
    rising = 2e5 * (1.0 - math.exp(-1.0 / 1.25)), 2e5 * (1.0 - math.exp(-2.0 / 1.25))
    falling = [0.5e5 + (rising[1] - 0.5e5) * math.exp(-t / 1.25) for t in (0.7, 2.0)]
    np.testing.assert_allclose(own[:, 0], [0.0, 0.0, rising[0], *falling], rtol=1e-12)
    assert not own[:, 1:].any()  # wagons have none
    chain, _ = compiled(given_)
    greater = [brake_force_at(chain, 0, cylinder, independent, 10.0) for cylinder, independent in ((1e5, 2e5), (2e5, 1e5))]
    assert greater == [30e3, 30e3]


# --- blocks ------------------------------------------------------------------------------------------------------


@pytest.mark.interpreted
@pytest.mark.parametrize(
    ("kn", "kmh", "mu"), [(0.0, 0.0, 0.6), (9.81, 20.0, 0.6 * 116 / 180 * 120 / 200), (29.43, 100.0, 0.6 * 148 / 340 * 200 / 600)]
)
def test_karwatzki_by_hand(kn, kmh, mu):
    # 0.6 (16 F + 100)/(80 F + 100) (V + 100)/(5 V + 100), F [t], V [km/h]; 9.81 kN are 1 t
    chain, _ = compiled(scenario(brake=GEAR | {"friction": {"law": "karwatzki"}}))
    assert friction_at(chain, 0, kn * 1e3, kmh / 3.6) == pytest.approx(mu, rel=1e-14)


@pytest.mark.interpreted
def test_a_table_of_friction_is_bilinear_and_held_at_its_edges():
    speeds, forces = (0.0, 50.0, 100.0), (10.0, 40.0)
    mu = {(v, f): 0.4 - 0.001 * v - 0.002 * f + 2e-5 * v * f for v in speeds for f in forces}  # bilinear itself
    points = [{"speed_kmh": v, "block_force_kn": f, "friction": mu[v, f]} for f in reversed(forces) for v in speeds]
    chain, _ = compiled(scenario(brake=GEAR | {"friction": {"law": "table", "points": points}}))
    for v, f in ((25.0, 20.0), (50.0, 10.0), (99.0, 39.0), (100.0, 40.0), (0.0, 10.0)):
        expected = 0.4 - 0.001 * v - 0.002 * f + 2e-5 * v * f
        assert friction_at(chain, 0, f * 1e3, v / 3.6) == pytest.approx(expected, rel=1e-12)
    assert friction_at(chain, 0, 99e3, 200.0 / 3.6) == pytest.approx(mu[100.0, 40.0], rel=1e-12)
    assert friction_at(chain, 0, 1e3, 25.0 / 3.6) == pytest.approx(0.5 * (mu[0.0, 10.0] + mu[50.0, 10.0]), rel=1e-12)
    one = [{"speed_kmh": v, "block_force_kn": 20.0, "friction": 0.1 + 0.001 * v} for v in (0.0, 100.0)]
    chain, _ = compiled(scenario(brake=GEAR | {"friction": {"law": "table", "points": one}}))
    assert friction_at(chain, 0, 33e3, 30.0 / 3.6) == pytest.approx(0.13, rel=1e-12)


@pytest.mark.interpreted
def test_the_braking_force_is_equations_4_and_5():
    gear = GEAR | {"blocks": 10, "friction": {"law": "karwatzki"}}
    chain, _ = compiled(scenario(brake=gear))
    block_force = 2e5 * 0.1 * 5.0  # p_c A_c k
    mu = friction_at(chain, 0, block_force / 10.0, 15.0)
    assert brake_force_at(chain, 1, 2e5, 0.0, -15.0) == pytest.approx(block_force * mu, rel=1e-15)
    assert brake_force_at(chain, 1, 0.0, 0.0, 15.0) == 0.0
    isolated, _ = compiled(scenario(brake=gear | {"in_use": False}))
    assert brake_force_at(isolated, 1, 2e5, 0.0, 15.0) == 0.0


# --- stopping distances ------------------------------------------------------------------------------------------

MASS_KG = 80e3
FULL_N = 0.5 * 3.8e5 * 0.3
"""Braking force of full cylinders of `GEAR`."""


def test_stop_with_a_linear_build_up():
    # s = v0 T_b/2 + v0^2/2a - a T_b^2/24; the mean-value form of EN 14531-1 lacks the last term
    chain, _ = compiled(scenario(wagons=0))
    start, build_up, step = 25.0, 4.0, 2e-3
    time = distance = 0.0
    v = start
    while v > 0.0:
        middle = min((time + 0.5 * step) / build_up, 1.0)
        rate = brake_force_at(chain, 0, middle * 3.8e5, 0.0, v) / MASS_KG
        part = min(step, v / rate)
        distance += v * part - 0.5 * rate * part * part
        v, time = (v - rate * part if part == step else 0.0), time + part
    full = FULL_N / MASS_KG
    mean_values = start * build_up / 2.0 + start**2 / (2.0 * full)
    assert distance == pytest.approx(mean_values - full * build_up**2 / 24.0, rel=1e-6)
    assert mean_values - distance == pytest.approx(0.475, abs=1e-3)


@pytest.mark.parametrize("step", [0.01, 0.05])
def test_stop_with_the_exponential_of_the_paper(step):
    # v = v0 - a (t - T (1 - e(-t/T))) from the delay on; its integral is the stopping distance
    given_ = braked((0.0, "full_service"), wagons=1, propagation_mps=10.0)
    times = np.arange(0.0, 60.0, step)
    cylinders, _ = pressures(given_, times)
    chain, _ = compiled(given_)
    lag, full = 4.0 / 3.0, FULL_N / MASS_KG
    for i, delay in enumerate((0.0, 2.0)):
        rate = np.array([brake_force_at(chain, i, pressure, 0.0, 20.0) for pressure in cylinders[:, i]]) / MASS_KG
        lost = np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * step)))
        k = int(np.argmax(lost >= 20.0))
        stop = times[k - 1] + step * (20.0 - lost[k - 1]) / (lost[k] - lost[k - 1])
        v = 20.0 - lost[:k]
        distance = np.sum(0.5 * (v[1:] + v[:-1]) * step) + 0.5 * v[-1] * (stop - times[k - 1])
        since = stop - delay
        assert full * (since - lag * (1.0 - math.exp(-since / lag))) == pytest.approx(20.0, rel=1e-4)
        gone = 0.5 * since**2 - lag * since + lag**2 * (1.0 - math.exp(-since / lag))
        assert distance == pytest.approx(20.0 * stop - full * gone, rel=1e-4)
