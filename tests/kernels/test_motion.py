"""Motion against closed forms: v2 linear in s, stops and ceilings met exactly, whatever the step."""

import itertools
import math

import numpy as np
import pytest
from small_trains import INVERTER, Stepper, call, make_run, make_trains, passing, run

from tractionpower.kernels.train_tables import DWELLING, GONE, RUNNING, STANDING, STAYING, WAITING

G = 9.80665
STRONG = INVERTER | {"power_kw": 1e6, "max_current_a": 1e6}
POWER = INVERTER | {"starting_effort_kn": 1e4, "max_current_a": 1e6}
FREE = {"limits": [(-1.0, 60.0, 600.0)], "max_speed_kmh": 600.0}
STEPS = [0.02, 0.3, 1.0, 5.0]


def column(found, name, at):
    """Return the value of a column when a quantity passes a value, straight between rows."""
    return float(np.interp(at[1], found.rows[at[0]], found.rows[name]))


def squares(found, s):
    piece = found.ceiling[np.searchsorted(found.ceiling["from_m"], s, side="right") - 1]
    return piece["w"] + piece["dw"] * (s - piece["from_m"])


# --- closed forms ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("step_s", STEPS)
def test_constant_force(step_s):
    # 200 kN on 200 t from rest: 2 km take sqrt(2 * 2000) s, whatever the step.
    found = run(2.0, drive=STRONG, step_s=step_s, **FREE)
    assert found.finished_s == pytest.approx(math.sqrt(4000.0), abs=1e-9)


def test_constant_power():
    # 500 t, 3 MW from 20 to 40 m/s: M (v2^2 - v1^2) / 2 P = 100 s, M (v2^3 - v1^3) / 3 P = 3111.11 m.
    found = run(8.0, drive=POWER, mass_t=500.0, speed_kmh=72.0, step_s=0.1, **FREE)
    assert column(found, "time_s", ("v_mps", 40.0)) == pytest.approx(100.0, abs=1e-4)
    assert column(found, "s_m", ("v_mps", 40.0)) == pytest.approx(28000.0 / 9.0, abs=2e-3)


def coasting(a, b, c, v0, v):
    """Return time and distance from v0 to v by M dv/dt = -(A + B v + C v2), with M = 1."""
    root = math.sqrt(4 * a * c - b * b)
    time = 2 / root * (math.atan((2 * c * v0 + b) / root) - math.atan((2 * c * v + b) / root))
    return time, (math.log((a + b * v0 + c * v0 * v0) / (a + b * v + c * v * v)) - b * time) / (2 * c)


@pytest.mark.parametrize(("step_s", "tolerance"), [(0.1, 1e-5), (1.0, 1e-3)])
def test_coasting(step_s, tolerance):
    a, b, c = 4000.0, 20.0 * 3.6, 1.5 * 3.6**2
    train = {"resistance": {"a_n": 4000.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 1.5}, "rotating_mass_factor": 1.1}
    found = run(5.0, drive=None, speed_kmh=180.0, step_s=step_s, **train, **FREE)
    for v in (45.0, 35.0, 32.0):
        time, distance = (220e3 * x for x in coasting(a, b, c, 50.0, v))
        if distance < 5000.0:
            rows = found.rows[::-1]
            assert np.interp(v, rows["v_mps"], rows["time_s"]) == pytest.approx(time, abs=0.02 * step_s + tolerance)
            assert np.interp(v, rows["v_mps"], rows["s_m"]) == pytest.approx(distance, abs=step_s + tolerance)
    k = round(60.0 / step_s)  # at one time, without interpolation
    v, s = found.rows["v_mps"][k], found.rows["s_m"][k]
    time, distance = (220e3 * x for x in coasting(a, b, c, 50.0, v))
    assert time == pytest.approx(60.0, abs=tolerance)
    assert s == pytest.approx(distance, abs=10 * tolerance)


@pytest.mark.parametrize("step_s", STEPS)
def test_constant_deceleration(step_s):
    # 20 m/s to the braking curve 400 m before the stop, then 40 s with 0.5 m/s2.
    line = {"limits": [(-1.0, 5.0, 72.0)], "stations": {"A": 2.0}}
    found = run(2.0, speed_kmh=72.0, calls=[call("A")], step_s=step_s, brake={"service_rate_mps2": 0.5}, **line)
    assert found.calls[0].arrival_s == pytest.approx(80.0 + 40.0, abs=1e-6 / step_s + 2e-3)
    assert found.finished_s == found.calls[0].departure_s


# --- masses, gradients, curves, tunnels --------------------------------------------------------------------------


def test_rotating_masses_are_inertia_and_no_weight():
    def acceleration(**more):
        return Stepper(make_trains(5.0, drive=STRONG, mass_t=150.0, load_t=80.0, rotating_mass_factor=1.2, **more)).step(3000.0)

    parts = [{"id": "car", "load_percent": 50.0}]
    inertia = 1.2 * 150e3 + 40e3  # the load does not rotate
    level, rise = acceleration(vehicles=parts), acceleration(vehicles=parts, slopes=[(-1.0, 6.0, 10.0)])
    assert level["acceleration_mps2"] == pytest.approx(200e3 / inertia, rel=1e-12)
    assert rise["acceleration_mps2"] == pytest.approx((200e3 - 190e3 * G * 0.010) / inertia, rel=1e-9)


def test_a_train_that_cannot_hold_its_speed_falls_below_the_ceiling():
    # 20 permille, 200 t: 39.2 kN; 3 MW hold 76.5 m/s, 500 kW hold 12.7 m/s.
    weak = INVERTER | {"power_kw": 500.0}
    found = run(30.0, drive=weak, slopes=[(-1.0, 31.0, 20.0)], limits=[(-1.0, 31.0, 72.0)], speed_kmh=72.0)
    assert found.rows["v_mps"][-1] == pytest.approx(500e3 / (200e3 * G * 0.020), rel=1e-6)
    assert (np.diff(found.rows["v_mps"]) < 1e-12).all()


def test_a_train_that_comes_to_a_stand_holds_itself():
    found = run(5.0, drive=INVERTER | {"starting_effort_kn": 30.0}, slopes=[(-1.0, 6.0, 20.0)], speed_kmh=36.0)
    assert found.status == "stuck"
    assert found.rows["v_mps"][-1] == 0.0
    # v2 / 2 a with a = (m g i - F) / M
    assert found.rows["s_m"][-1] == pytest.approx(50.0 * 200e3 / (200e3 * G * 0.02 - 30e3), rel=1e-6)


# --- ceilings, calls, ends ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("step_s", [0.3, 1.0, 5.0])
def test_the_ceiling_is_never_passed(step_s):
    limits = [(-1.0, 2.0, 100.0), (2.0, 2.2, 40.0), (2.2, 4.0, 120.0), (4.0, 4.02, 60.0), (4.02, 7.0, 140.0)]
    found = run(6.0, limits=limits, stations={"A": 1.0, "B": 1.05, "Z": 6.0}, calls=[call("A"), call("B"), call("Z")],
                step_s=step_s, slopes=[(-1.0, 3.0, -8.0), (3.0, 7.0, 12.0)])  # fmt: skip
    rows = found.rows
    assert (rows["v_mps"] ** 2 <= squares(found, rows["s_m"]) + 1e-7).all()
    assert (np.diff(rows["s_m"]) >= 0.0).all()
    assert found.status == "complete"


def test_the_tail_clears_a_limit():
    limits = [(-1.0, 1.0, 36.0), (1.0, 9.0, 72.0)]
    for length in (50.0, 400.0):
        found = run(3.0, limits=limits, speed_kmh=36.0, length_m=length, step_s=0.5, drive=STRONG)
        faster = found.rows["s_m"][found.rows["v_mps"] > 10.0 + 1e-9]
        assert 1000.0 + length < faster[0] < 1000.0 + length + 8.0


@pytest.mark.parametrize("step_s", STEPS)
def test_stops_exactly_with_dwell_and_departure(step_s):
    stations = {"A": 1.2344, "B": 2.0, "C": 3.0}
    calls = [call("A", min_dwell_s=12.3), call("B", departure=400.0), call("C")]
    stepper = Stepper(make_trains(3.0, stations=stations, calls=calls, slopes=[(-1.0, 4.0, -5.0)]))
    stood = {}
    while not stepper.gone:
        stepper.step(3000.0, step_s)
        if stepper.mover["status"] == STANDING:
            stood[int(stepper.mover["stop"])] = (float(stepper.mover["s_m"]), float(stepper.mover["v_mps"]))
    assert stood[0] == (1234.4, 0.0)
    assert stood[1] == (2000.0, 0.0)
    arrived, left = stepper.state.arrived_s, stepper.state.left_s
    assert left[0] - arrived[0] == pytest.approx(12.3, abs=1e-9)
    assert left[1] == 400.0 > arrived[1]
    assert left[2] == arrived[2]  # no dwell, no departure
    assert float(stepper.mover["finished_s"]) == left[2]
    assert stepper.mover["status"] == GONE


def test_passing_times_have_fractions_of_a_second():
    stations = {"A": 0.0, "P": 0.5005, "Q": 0.5006, "Z": 2.0}
    for step_s in STEPS:
        found = run(2.0, drive=STRONG, stations=stations, calls=[passing(name) for name in stations], step_s=step_s, **FREE)
        for one in found.calls:
            assert one.arrival_s == one.departure_s == pytest.approx(math.sqrt(2.0 * one.at_m), abs=1e-6)


@pytest.mark.parametrize(("end", "status", "speed"), [("leave", GONE, 40.0), ("stop", GONE, 0.0), ("stay", STAYING, 0.0)])
def test_ends(end, status, speed):
    stepper = Stepper(make_trains(4.0, limits=[(-1.0, 5.0, 144.0)], end=end))
    while not stepper.gone:
        stepper.step(3000.0)
    assert (stepper.mover["status"], stepper.mover["s_m"]) == (status, 4000.0)
    assert float(stepper.mover["v_mps"]) == pytest.approx(speed, abs=2e-3)
    row = stepper.step(3000.0)  # a train that stays keeps its auxiliaries; one that is gone takes nothing
    assert stepper.state.done[0]["on_line_s"] == (1.0 if end == "stay" else 0.0)
    assert row["traction_n"] == 0.0


def test_a_train_enters_within_a_step():
    scenario = make_trains(2.0, time=10.25, speed_kmh=36.0, limits=[(-1.0, 3.0, 36.0)], auxiliaries={"power_kw": 100.0})
    stepper = Stepper(scenario)
    stepper.time_s = 8.0
    before = stepper.step(3000.0)
    stepper.step(3000.0)
    assert (before["phase"], before["power_w"]) == (WAITING, 0.0)
    assert stepper.mover["status"] != RUNNING
    step = stepper.step(3000.0)
    assert float(stepper.mover["s_m"]) == pytest.approx(7.5, abs=1e-9)
    assert stepper.state.done[0]["on_line_s"] == pytest.approx(0.75)
    assert step["auxiliary_w"] == pytest.approx(75e3)


def test_a_train_starts_at_its_first_call():
    runs = [
        {
            "id": "x",
            "train": "t",
            "route": [{"track": "1", "from_km": 0.0, "to_km": 3.0}],
            "calls": [call("A", departure=100.5), call("Z")],
        }
    ]
    found = run(3.0, runs=runs, stations={"A": 0.0, "Z": 3.0})
    assert (found.start_s, found.calls[0].departure_s) == (100.5, 100.5)
    assert found.rows["s_m"][1] > 0.0
    waits = make_run("x", 3.0, time=60.0, calls=[call("A", departure=100.5), call("Z")])
    later = run(3.0, runs=[waits], stations={"A": 0.0, "Z": 3.0})
    assert later.calls[1].arrival_s == pytest.approx(found.calls[1].arrival_s, abs=0.01)
    assert (later.rows["phase"][:40] == DWELLING).all()


def test_the_order_of_the_method_is_two():
    # A smooth start with power and resistance: speed and place after 64 s against a step 64 times as fine.
    train = {"drive": INVERTER, "resistance": {"a_n": 3000.0, "c_n_per_kmh2": 2.0}, "speed_kmh": 72.0, **FREE}

    def after(step_s):
        found = run(30.0, step_s=step_s, **train)
        k = round(64.0 / step_s)
        assert found.seconds[k] == pytest.approx(step_s)
        return np.array([found.rows["v_mps"][k], found.rows["s_m"][k]])

    truth = after(1.0 / 64.0)
    errors = [np.abs(after(step) - truth) for step in (4.0, 2.0, 1.0)]
    for coarse, fine in itertools.pairwise(errors):
        assert (coarse / fine).min() > 3.5
        assert (coarse / fine).max() < 4.6


def test_the_dwell_does_not_count_where_a_run_begins():
    stops = {"stations": {"A": 0.0, "Z": 5.0}, "calls": [call("A", departure=100.0, min_dwell_s=30.0), call("Z")]}
    journey = run(5.0, time=100.0, **stops)
    assert (journey.calls[0].departure_s, journey.start_s) == (100.0, 100.0)


def test_a_run_whose_only_call_is_its_start_goes_to_the_end_of_its_route():
    journey = run(5.0, stations={"A": 0.0}, calls=[call("A", departure=60.0)])
    assert journey.status == "complete"
    assert journey.end_m == 5000.0
    assert journey.rows["v_mps"][-1] > 20.0
