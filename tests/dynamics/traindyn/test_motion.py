"""The motion of a point mass against closed forms, scipy, and the theoretical journey of the co-simulation."""

import math

import numpy as np
import pytest
from point_trains import RUNNING, add, characteristics, constant_effort, line, run_to
from scipy.integrate import solve_ivp
from small_trains import make_trains

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.movement.journey import theoretical_journeys

KMH = 3.6


@pytest.mark.parametrize("method", ["euler", "fine"])
@pytest.mark.parametrize("period_s", [0.3, 1.0, 5.0])
def test_a_stop_takes_v2_over_2b_whatever_the_period(method, period_s):
    core = TrainDynamics(method=method)
    train = add(core, characteristics(), speed_kmh=97.0)
    train.stop()
    run_to(core, 120.0, period_s)
    v = 97.0 / KMH
    assert train.place_m == pytest.approx(v * v / (2 * 0.5), rel=1e-12)
    assert train.stood_since_s == pytest.approx(v / 0.5, rel=1e-12)
    assert (train.speed_mps, train.state, train.acceleration_mps2) == (0.0, "standing", 0.0)


def test_a_stop_that_is_sampled_only_would_be_wrong_by_b_h2_over_8():
    b, h, worst = 0.5, 1.0, 0.0
    for v0 in np.linspace(20.0, 20.5, 41):
        v, s = v0, 0.0
        while v > 0.0:  # D(21) and D(22), the speed kept from falling below 0
            after = max(v - b * h, 0.0)
            v, s = after, s + (v + after) / 2 * h
        worst = max(worst, abs(s - v0 * v0 / (2 * b)))
    assert worst == pytest.approx(b * h * h / 8, rel=0.01)
    core = TrainDynamics()
    train = add(core, characteristics(), speed_mps=20.26)
    train.stop()
    run_to(core, 60.0)
    assert abs(train.place_m - 20.26**2 / (2 * b)) < 1e-9


@pytest.mark.parametrize("period_s", [0.1, 1.0, 7.0])
def test_constant_acceleration_is_exact(period_s):
    core = TrainDynamics()
    train = add(core, constant_effort(100.0))
    train.accelerate(speed_kmh=100.0)
    run_to(core, 70.0, period_s)
    a = 100e3 / 500e3
    assert train.speed_mps == pytest.approx(a * 70.0, rel=1e-12)
    assert train.place_m == pytest.approx(a * 70.0**2 / 2, rel=1e-12)
    run_to(core, 210.0, period_s)
    v = 100.0 / KMH
    assert (train.speed_mps, train.state) == (v, "cruising")
    assert train.place_m == pytest.approx(v * v / (2 * a) + v * (210.0 - v / a), rel=1e-12)


def test_speeds_held_between_samples_lose_a_h2_over_2_at_each():
    """What AnyLogic's constant speed between samples costs: V h / 2 over an acceleration to V, 13.9 m for 100 km/h."""
    v, h = 100.0 / KMH, 1.0
    a = v / 50.0  # 50 whole samples
    places = {}
    for method in ("euler", "held_speed"):
        core = TrainDynamics(method=method)
        train = add(core, constant_effort(500.0 * a))
        train.accelerate(v)
        run_to(core, h)
        one = train.place_m
        run_to(core, 50.0)
        assert train.speed_mps == pytest.approx(v)
        places[method] = np.array([one, train.place_m])
    lost = places["euler"] - places["held_speed"]
    assert lost == pytest.approx([a * h * h / 2, v * h / 2], rel=1e-9)
    assert lost[1] == pytest.approx(13.9, abs=0.05)


def coast_down(period_s, method="euler"):
    """Return speed and distance after 200 s of coasting from 100 km/h, and the closed forms of both."""
    given = constant_effort(0.0, resistance={"a_n_per_kn": 1.6, "c_n_per_kn_per_kmh2": 0.00044}, rotating_mass_factor=1.08)
    core = TrainDynamics(method=method)
    train = add(core, given, speed_kmh=100.0)
    run_to(core, 200.0, period_s)
    m, weight_kn, v0 = 500e3 * 1.08, 500.0 * GRAVITY, 100.0 / KMH
    a, c = 1.6 * weight_kn, 0.00044 * weight_kn * KMH**2
    v = math.sqrt(a / c) * math.tan(math.atan(v0 * math.sqrt(c / a)) - math.sqrt(a * c) * 200.0 / m)
    return np.array([train.speed_mps, train.place_m]), np.array([v, m / (2 * c) * math.log((a + c * v0**2) / (a + c * v**2))])


def test_coasting_tends_to_arctan_and_logarithm_by_the_order_of_euler():
    errors = []
    for period_s in (4.0, 2.0, 1.0, 0.5):
        found, closed = coast_down(period_s)
        errors.append(np.abs(found - closed))
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert ratios == pytest.approx(np.full((3, 2), 2.0), abs=0.06)
    found, closed = coast_down(1.0, "fine")
    assert found == pytest.approx(closed, rel=1e-8)


def test_coasting_comes_to_a_stand_in_the_closed_time_and_stays():
    given = constant_effort(0.0, resistance={"a_n_per_kn": 3.0, "c_n_per_kn_per_kmh2": 0.0005})
    core = TrainDynamics(method="fine")
    train = add(core, given, speed_kmh=60.0)
    run_to(core, 1000.0)
    a, c, v0 = 3.0e-3 * GRAVITY, 0.0005e-3 * GRAVITY * KMH**2, 60.0 / KMH
    assert train.stood_since_s == pytest.approx(math.atan(v0 * math.sqrt(c / a)) / math.sqrt(a * c), rel=1e-5)
    place = train.place_m
    assert place == pytest.approx(math.log(1 + c * v0**2 / a) / (2 * c), rel=1e-6)
    run_to(core, 11_000.0, 10.0)
    assert (train.place_m, train.speed_mps) == (place, 0.0)


def test_the_specific_form_is_that_of_forces():
    """D(16) in N/kN gives the acceleration of D(9) in N; D(6), (10), (13) to (15) and tunnels by hand."""
    parts = [{"mass_t": 1.1, "radius_of_gyration_m": 0.4, "wheel_radius_m": 0.46, "count": 40},
             {"mass_t": 2.0, "radius_of_gyration_m": 0.25, "ratio": 3.5, "wheel_radius_m": 0.6, "count": 4}]  # fmt: skip
    hauled = {"a_n_per_kn": 1.9, "c_n_per_kn_per_kmh2": 0.0003}
    given = characteristics(rotating_mass_factor=None, rotating_parts=parts, hauled_resistance=hauled)
    core, way = TrainDynamics(), line()
    core.add_inclination(way, 12.0)
    core.add_arc(way, 400.0)
    core.add_tunnel(way, 1)
    train = add(core, given, route=(way,), speed_kmh=72.0)
    train.accelerate(speed_kmh=110.0)
    core.calculate_speeds(1e-9)  # what acts now
    rho = 1 + (40 * 1.1 * 0.4**2 / 0.46**2 + 4 * 2.0 * 0.25**2 * 3.5**2 / 0.6**2) / 480.0
    weight_kn = 480.0 * GRAVITY
    effort = 2220.0 / 20.0 * 1e3 / weight_kn
    vehicles = (80.0 * (1.6 + 0.004 * 72 + 0.00044 * 72**2) + 400.0 * (1.9 + 0.0003 * 72**2)) / 480.0
    track = 12.0 + 650.0 / (400.0 - 55.0) + 2.0
    assert train.acceleration_mps2 == pytest.approx((effort - vehicles - track) / (rho * 1e3 / GRAVITY), rel=1e-8)
    assert train.resistance_kn == pytest.approx((vehicles + track) * weight_kn / 1e3, rel=1e-8)
    assert train.tractive_force_kn == pytest.approx(effort * weight_kn / 1e3, rel=1e-8)


def test_the_resistance_of_a_period_is_that_of_its_beginning():
    """D(21) takes the track at L_{i-1}: a period that begins before a gradient does not feel it."""
    core, way = TrainDynamics(), line()
    core.add_inclination(way, 10.0, between_m=(25.0, 20_000.0))
    train = add(core, constant_effort(0.0), route=(way,), speed_mps=20.0)
    core.calculate_speeds(2.0)
    assert (train.speed_mps, train.place_m) == (20.0, 40.0)
    core.calculate_speeds(3.0)
    assert train.speed_mps == pytest.approx(20.0 - GRAVITY / 100.0, rel=1e-12)


@pytest.mark.parametrize("method", ["euler", "fine"])
def test_a_place_to_stop_is_met(method):
    rng = np.random.default_rng(7)
    for _ in range(40):
        core, way = TrainDynamics(method=method), line(6000.0)
        for k in range(6):
            core.add_inclination(way, float(rng.uniform(-15, 15)), between_m=(1000.0 * k, 1000.0 * (k + 1)))
        core.add_arc(way, 350.0, between_m=(2500.0, 4700.0))
        train = add(core, characteristics(braking_mps2=float(rng.uniform(0.4, 1.0))), route=(way,))
        train.accelerate(speed_kmh=float(rng.uniform(30, 120)))
        place = float(rng.uniform(50, 5900))
        train.stop(at_m=place)
        run_to(core, 1000.0, float(rng.choice([0.7, 1.0, 3.0])))
        assert train.is_standing
        assert abs(train.place_m - place) < 1e-6
        assert not train.is_stalled


@pytest.mark.parametrize("method", ["euler", "fine"])
def test_a_place_to_be_slower_is_met(method):
    core = TrainDynamics(method=method)
    train = add(core, characteristics(), speed_kmh=100.0)
    train.accelerate(speed_kmh=40.0, at_m=3000.0)
    v, u = 100.0 / KMH, 40.0 / KMH
    begins = 3000.0 - (v * v - u * u) / (2 * 0.5)
    reaches = begins / v + (v - u) / 0.5
    run_to(core, math.floor(begins / v))
    assert (train.state, train.speed_mps) == ("cruising", v)
    run_to(core, math.floor(reaches) - 5.0)
    assert train.state == "decelerating"
    run_to(core, math.floor(reaches) + 10.0)
    assert (train.state, train.speed_mps) == ("cruising", u)
    assert train.place_m == pytest.approx(3000.0 + u * (core.time_s - reaches), rel=1e-12)


def test_a_train_below_a_goals_speed_does_not_pass_it_faster():
    core = TrainDynamics()
    train = add(core, constant_effort(500.0))
    train.accelerate(speed_kmh=100.0)
    train.accelerate(10.0, at_m=50.0)  # met on the way up: v2 = 2 a s
    run_to(core, 32.0, 4.0)
    assert train.speed_mps == 10.0
    assert train.place_m == pytest.approx(50.0 + 10.0 * (32.0 - 10.0), rel=1e-12)


def test_what_a_gradient_takes_beyond_braking_is_no_jump():
    """On 40 permille a weak train slows down faster than it brakes: it never passes its place, and does not roll back."""
    for method in ("euler", "fine"):
        core, way = TrainDynamics(method=method), line()
        core.add_inclination(way, 40.0)
        train = add(
            core, characteristics(starting_effort_kn=60.0, power_kw=500.0, braking_mps2=0.2), route=(way,), speed_kmh=60.0
        )
        train.stop(at_m=2000.0)
        run_to(core, 300.0)
        assert train.is_standing
        assert train.is_stalled
        assert 0.0 < train.place_m < 2000.0
        before = train.place_m
        run_to(core, 400.0)
        assert train.place_m == before


def test_downhill_the_brakes_hold_the_speed():
    core, way = TrainDynamics(), line()
    core.add_inclination(way, -20.0)
    train = add(core, characteristics(), route=(way,), speed_kmh=80.0)
    run_to(core, 60.0)
    assert (train.state, train.speed_kmh, train.tractive_force_kn) == ("cruising", pytest.approx(80.0), 0.0)
    assert train.braking_force_kn == pytest.approx(-train.resistance_kn)
    assert train.braking_force_kn > 50.0


def test_the_fine_method_is_that_of_scipy_and_of_second_order():
    given = characteristics()
    weight_kn = 480.0 * GRAVITY

    def slope(_, y):
        s, v = y
        kmh = v * KMH
        specific = RUNNING["a_n_per_kn"] + RUNNING["b_n_per_kn_per_kmh"] * kmh + RUNNING["c_n_per_kn_per_kmh2"] * kmh**2
        track = 8.0 if 500.0 <= s < 1200.0 else 0.0
        force = min(270e3, 2220e3 / max(v, 1e-9)) - weight_kn * (specific + track)
        return [v, force / (480e3 * 1.06)]

    exact = solve_ivp(slope, (0.0, 120.0), [0.0, 0.0], method="DOP853", rtol=1e-10, atol=1e-8, max_step=0.02).y[:, -1]
    core, way = TrainDynamics(method="fine"), line()
    core.add_inclination(way, 8.0, between_m=(500.0, 1200.0))
    fine = add(core, given, route=(way,))
    fine.accelerate(speed_kmh=120.0)
    run_to(core, 120.0)
    assert [fine.place_m, fine.speed_mps] == pytest.approx(exact, rel=2e-6)
    errors = []
    for substep in (0.8, 0.4, 0.2):
        core = TrainDynamics(method="fine")
        core._method = (substep, False)
        core.add_inclination(way, 8.0, between_m=(500.0, 1200.0))
        train = add(core, given, route=(way,))
        train.accelerate(speed_kmh=120.0)
        run_to(core, 120.0, 8.0)
        errors.append(abs(train.place_m - exact[0]))
    assert (
        errors[0] / errors[2] > 8.0
    )  # 16 for second order; the kink of the characteristic and the break of the track disturb it


def test_it_runs_as_the_theoretical_journey_of_the_co_simulation():
    """The same train, line and stop computed by another kernel: eq. 1 and 2 of Krzysztozek in steps of 0.05 s.

    It stops on the level: there the service rate of the one and the deceleration of the other are the same.
    """
    resistance = {"specific_a_n_per_kn": 1.6, "specific_b_n_per_kn_per_kmh": 0.004, "specific_c_n_per_kn_per_kmh2": 0.00044}
    scenario = make_trains(
        8.0, slopes=[(-1.0, 3.0, 0.0), (3.0, 5.0, 9.0), (5.0, 9.0, 0.0)], stations={"S": 7.0}, calls=[{"station": "S"}],
        end="stop", mass_distribution="point", resistance=resistance, max_speed_kmh=110.0, rotating_mass_factor=1.08,
        brake={"service_rate_mps2": 0.6}, clock={"step_s": 0.05},
    )  # fmt: skip
    (journey,) = theoretical_journeys(scenario, step_s=0.05)
    given = characteristics(
        locomotive_mass_t=200.0, hauled_mass_t=0.0, rotating_mass_factor=1.08, max_speed_kmh=110.0, braking_mps2=0.6,
        starting_effort_kn=200.0, power_kw=3000.0,
    )  # fmt: skip
    core, way = TrainDynamics(method="fine"), line(9000.0)
    core.add_inclination(way, 9.0, between_m=(3000.0, 5000.0))
    train = add(core, given, route=(way,))
    train.accelerate(speed_kmh=110.0)
    train.stop(at_m=7000.0)
    times = np.arange(5.0, 200.0, 5.0)
    speeds, places = [], []
    for time_s in times:
        core.calculate_speeds(time_s)
        speeds.append(train.speed_mps)
        places.append(train.place_m)
    rows = journey.rows
    assert speeds == pytest.approx(np.interp(times, rows["time_s"], rows["v_mps"]), abs=0.01)
    assert places == pytest.approx(np.interp(times, rows["time_s"], rows["s_m"]), abs=0.5)
    run_to(core, 600.0)
    assert train.place_m == pytest.approx(7000.0, abs=1e-6)
    assert train.stood_since_s == pytest.approx(journey.calls[0].arrival_s, abs=0.1)
