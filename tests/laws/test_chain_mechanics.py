"""Laws of a chain of vehicles that closed forms tell: momentum, impact, modes, forces of steady pulling, slack taken up."""

import math

import numpy as np
import pytest
from chains import AT_ONCE, FULL, LOCOMOTIVE, WAGON, WEDGE, Chained, G, advanced, free, make_chain, pulled, spring
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

METHODS = ("symplectic", "rk4", "euler", "variable")
LAW = settings(max_examples=12, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


def momentum(chained):
    return float((chained.chain.vehicles["inertia_kg"] * chained.movers["v_mps"]).sum())


@LAW
@given(seed=st.integers(0, 10**6), method=st.sampled_from(METHODS), gear=st.sampled_from(["wedge", "damped spring"]))
def test_forces_between_vehicles_keep_the_momentum(seed, method, gear):
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 12))
    coupling = WEDGE if gear == "wedge" else spring(10.0, damping_kns_per_m=30.0, slack_mm=40.0)
    run = {"method": method, "step_s": 0.002, "tolerance": 1e-7}
    scenario = free(random.uniform(20.0, 120.0, n), coupling, rotating=random.uniform(1.0, 1.3, n), run=run)
    chained = Chained(scenario)
    chained.movers["v_mps"] = speeds = random.uniform(8.0, 10.0, n)
    before = momentum(chained)
    chained.advance(5.0)
    assert momentum(chained) == pytest.approx(before, rel=1e-12)
    assert np.abs(chained.movers["v_mps"] - speeds).max() > 0.05  # they have met
    assert np.abs(chained.links["least_n"]).max() > 1000.0


@pytest.mark.parametrize(("method", "within"), [("rk4", 1e-5), ("variable", 1e-5), ("symplectic", 1e-4)])
def test_two_masses_meet_and_exchange_their_speeds(method, within):
    # 90 t each, 10 MN/m, closing at 1 m/s: half a swing of omega = sqrt(2 k / m) = 14.907 rad/s
    k, m, slack = 10e6, 90e3, 0.2
    scenario = free([90.0, 90.0], spring(10.0, slack_mm=1000.0 * slack),
                    start={"couplings": "stretched"}, run={"method": method, "step_s": 2e-4, "tolerance": 1e-9})  # fmt: skip
    chained = advanced(scenario, slack + 0.25, speeds=[5.0, 6.0])
    omega = math.sqrt(2.0 * k / m)
    assert omega == pytest.approx(14.907, abs=5e-4)
    assert math.pi / omega == pytest.approx(0.21074, abs=5e-6)
    assert float(chained.links["least_n"][0]) == pytest.approx(-670.82e3, rel=within)
    assert float(chained.links["least_at_s"][0]) == pytest.approx(slack + 0.5 * math.pi / omega, abs=3e-4)
    np.testing.assert_allclose(chained.movers["v_mps"], [6.0, 5.0], atol=20.0 * within)
    assert float(chained.links["greatest_n"][0]) <= 0.0
    met = chained.rows["time_s"][chained.link_rows["force_n"][:, 0] < 0.0]
    assert slack - 1e-9 <= met.min()
    assert met.max() <= slack + 0.21074 + 3e-4


@pytest.mark.parametrize(
    ("n", "mode", "omega"), [(10, 1, 4.9469), (10, 9, 31.2334), (50, 1, 0.99330), (50, 49, 31.6072)], ids=str
)
def test_a_free_chain_swings_in_its_modes(n, mode, omega):
    # omega_n = 2 sqrt(k/m) sin(n pi / 2N), shape cos(n pi (i - 1/2) / N): 80 t, 20 MN/m
    k, m = 20e6, 80e3
    exact = 2.0 * math.sqrt(k / m) * math.sin(mode * math.pi / (2 * n))
    assert exact == pytest.approx(omega, rel=2e-5)
    period = 2.0 * math.pi / exact
    shape = 0.01 * np.cos(mode * np.pi * (np.arange(n) + 0.5) / n)
    chained = Chained(free([80.0] * n, spring(20.0), run={"method": "rk4", "step_s": 0.001, "record_every_s": 0.01}))
    rest = chained.movers["s_m"].copy()
    chained.movers["s_m"] += shape
    chained.advance(2.5 * period)
    swings = chained.vehicle_rows["s_m"] - rest
    at = np.cos(exact * chained.rows["time_s"])
    np.testing.assert_allclose(swings, at[:, None] * shape, atol=2e-7)
    # the frequency by itself: least squares of the swing in its shape
    found = swings @ shape / (shape @ shape)
    assert np.interp(0.0, -found[: int(0.45 * period / 0.01)], chained.rows["time_s"][: int(0.45 * period / 0.01)]) == (
        pytest.approx(0.25 * period, rel=2e-3)
    )


def system_matrix(masses, k, d):
    """Return the matrix of Zobory and Bekefi, eq. 9, for Y = [v, x]: springs and dampers of a chain that is free at both ends."""
    n = len(masses)
    pattern = np.diag(np.r_[1.0, np.full(n - 2, 2.0), 1.0]) - np.eye(n, k=1) - np.eye(n, k=-1)
    assert np.abs(pattern.sum(axis=1)).max() == 0.0
    inverse = np.diag(1.0 / np.asarray(masses))
    return np.block([[-inverse @ (d * pattern), -inverse @ (k * pattern)], [np.eye(n), np.zeros((n, n))]])


@pytest.mark.parametrize(("method", "within"), [("rk4", 1e-8), ("variable", 1e-6)])
def test_a_linear_chain_moves_by_the_system_matrix_of_the_paper(method, within):
    random = np.random.default_rng(7)
    masses, factors = random.uniform(20.0, 90.0, 8), random.uniform(1.0, 1.2, 8)
    run = {"method": method, "step_s": 0.001 if method == "rk4" else 0.1, "tolerance": 1e-9}
    chained = Chained(free(masses, spring(5.0, damping_kns_per_m=60.0), rotating=factors, run=run))
    rest = chained.movers["s_m"].copy()
    v, x = random.uniform(9.8, 10.2, 8), random.uniform(-0.02, 0.02, 8)
    chained.movers["v_mps"] = v
    chained.movers["s_m"] += x
    chained.advance(3.0)
    exact = expm(3.0 * system_matrix(1e3 * masses * factors, 5e6, 60e3)) @ np.r_[v, x]
    np.testing.assert_allclose(np.r_[chained.movers["v_mps"], chained.movers["s_m"] - rest], exact, atol=within)


def test_a_pull_travels_along_the_train_at_the_speed_of_the_chain():
    # pitch sqrt(k/m): 15 m, 20 MN/m, 80 t: 237.2 m/s; the front of a wave in a chain is where half of its final speed is reached
    n = 60
    speed = 15.0 * math.sqrt(20e6 / 80e3)
    assert speed == pytest.approx(237.2, abs=0.05)
    chained = Chained(pulled(n, spring(20.0), run={"method": "rk4", "step_s": 0.002, "record_every_s": 0.01}))
    chained.advance(0.9 * n * 15.0 / speed)
    force = chained.link_rows["force_n"]
    half = [chained.rows["time_s"][np.argmax(force[:, j] >= 100e3)] for j in (9, 49)]
    assert 40 * 15.0 / (half[1] - half[0]) == pytest.approx(speed, rel=0.02)


DAMPED = {"damping_kns_per_m": 4000.0}


def steady(scenario, until_s=14.0):
    chained = advanced(scenario, until_s)
    np.testing.assert_allclose(
        chained.vehicle_rows["a_mps2"][-1], chained.vehicle_rows["a_mps2"][-1].mean(), rtol=1e-6, atol=1e-9
    )
    return chained


@pytest.mark.parametrize("stiffness", [2.0, 20.0, 60.0])
def test_steady_pull_falls_to_the_tail_as_the_mass_behind(stiffness):
    # F_j = F (mass behind j) / (mass of the train), whatever the springs
    chained = steady(pulled(9, spring(stiffness, **DAMPED), run={"method": "rk4", "step_s": 0.002}), 40.0)
    np.testing.assert_allclose(chained.link_rows["force_n"][-1], 200e3 * np.arange(9, 0, -1) / 10.0, rtol=1e-6)
    assert float(chained.movers["v_mps"][0]) == pytest.approx(200e3 * 40.0 / 800e3, rel=1e-3)


def test_rotating_parts_count_in_the_mass_behind():
    heavy = WAGON | {"rotating_mass_factor": 1.25}
    chained = steady(pulled(9, spring(20.0, **DAMPED), vehicles=(LOCOMOTIVE, heavy), run={"method": "rk4", "step_s": 0.002}))
    behind = 1.25 * np.arange(9, 0, -1)
    np.testing.assert_allclose(chained.link_rows["force_n"][-1], 200e3 * behind / (1.0 + behind[0]), rtol=1e-6)


def test_power_in_several_places_gives_triangles_with_steps():
    parts = [{"id": "loco"}, {"id": "wagon", "count": 5}, {"id": "loco"}, {"id": "wagon", "count": 4}, {"id": "loco"}]
    scenario = make_chain(parts, spring(20.0, **DAMPED), run={"method": "rk4", "step_s": 0.002}, traction=AT_ONCE, commands=FULL)
    chained = steady(scenario)
    pull = np.zeros(12)
    pull[[0, 6, 11]] = 200e3
    expected = np.cumsum(pull)[:-1] - 600e3 * np.arange(1, 12) / 12.0
    np.testing.assert_allclose(chained.link_rows["force_n"][-1], expected, rtol=1e-6, atol=1.0)
    assert expected.min() < 0.0 < expected.max()  # some are pushed


def test_the_same_rate_of_braking_everywhere_loads_no_coupling():
    brake = {"brake_ratio": 0.3, "rigging_efficiency": 1.0, "friction": {"law": "constant", "friction": 0.3}}
    air = {"propagation_mps": 1e9}
    commands = [{"time_s": 1.0, "brake": "full_service"}]
    scenario = make_chain(
        [{"id": "wagon", "count": 12}], WEDGE, (WAGON,), brake=brake, air_brake=air, commands=commands, start={"speed_kmh": 60.0}
    )
    chained = advanced(scenario, 15.0)
    # lag of T = 4/3 s: the rate comes later by T
    assert float(chained.movers["v_mps"][0]) == pytest.approx(60.0 / 3.6 - 0.3 * 0.3 * G * (14.0 - 4.0 / 3.0), rel=1e-3)
    assert np.abs(chained.link_rows["force_n"]).max() < 1.0
    assert np.ptp(chained.movers["v_mps"]) < 1e-6


def test_slack_is_taken_up_one_wagon_after_the_other():
    # Plastic pick-up: u' = v (M + n m)/(M + (n+1) m), v^2 = u^2 + 2 F d/(M + n m); a gear that gives nothing back
    wagons, slack, m, pull = 6, 0.1, 80e3, 200e3
    coupling = {
        "slack_mm": 1000.0 * slack,
        "draw": {"stiffness_kn_per_mm": 20_000.0, "damping_percent": 100.0, "blending_mps": 3e-3},
    }
    scenario = pulled(
        wagons, coupling, start={"couplings": "bunched"}, run={"method": "variable", "step_s": 1e-3, "record_every_s": 1e-3}
    )
    chained = Chained(scenario, rows=8000)
    chained.advance(5.0)
    u = 0.0
    times, speeds = [], []
    for n in range(wagons):
        v = math.sqrt(u * u + 2.0 * pull * slack / (m + n * m))
        times.append(v * (n + 1) * m / pull)  # the momentum is F t
        speeds.append(v)
        u = v * (n + 1) / (n + 2)
    force = chained.link_rows["force_n"]
    took = [chained.rows["time_s"][np.argmax(force[:, j] > 1e3)] for j in range(wagons)]
    np.testing.assert_allclose(took, times, rtol=5e-3)
    found = [np.interp(times[j] - 2e-3, chained.rows["time_s"], chained.vehicle_rows["v_mps"][:, j]) for j in range(wagons)]
    np.testing.assert_allclose(found, speeds, rtol=2e-2)
    assert force.min() > -1e3  # nothing bounces back
