"""Laws of controls in a running train: lags and delays exact with any method and step, stops as closed forms tell."""

import math

import numpy as np
import pytest
from chains import LOCOMOTIVE, WAGON, advanced, make_chain, spring

METHODS = ("symplectic", "rk4", "euler", "variable")
BRAKE = {"cylinder_area_cm2": 1000.0, "rigging_ratio": 5.0, "rigging_efficiency": 1.0, "friction": {"law": "constant"}}
DECELERATION = 3.8e5 * 0.5 * 0.3 / 80e3
"""Of every vehicle with `BRAKE` in full service [m/s2]."""

TRAIN = [{"id": "loco"}, {"id": "wagon", "count": 4}]


def train(commands, run, **case):
    return make_chain(TRAIN, spring(20.0, damping_kns_per_m=200.0), (LOCOMOTIVE, WAGON), run, commands=commands, **case)


def reduction(rows, time):
    """Return the reduction [Pa] by rows of (from, target, time constant), each from where the one before has come."""
    start = 0.0
    for k, (begin, target, constant) in enumerate(rows):
        end = rows[k + 1][0] if k + 1 < len(rows) else math.inf
        if time < end:
            return target + (start - target) * math.exp(-(time - begin) / constant) if time > begin else start
        start = target + (start - target) * math.exp(-(end - begin) / constant)
    raise AssertionError


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("step", [0.002, 0.02])
def test_effort_and_cylinders_follow_their_exponentials(method, step):
    # Z(2) with T = 0.01 s, where an explicit step of 0.02 s would swing for ever; Z(3) with the delay of each vehicle
    traction = {"levels": 4, "starting_effort_kn": 200.0, "power_kw": 1e9, "time_constant_s": 0.01}
    commands = [
        {"time_s": 0.5, "drive": 4},
        {"time_s": 0.515, "drive": 1, "brake": 10},  # before the effort has settled
        {"time_s": 1.7, "brake": 3},
    ]
    air = {"application_time_constant_s": 1.5, "release_time_constant_s": 6.0, "propagation_mps": 60.0}
    run = {"method": method, "step_s": step, "record_every_s": 0.02, "duration_s": 4.0}
    chained = advanced(train(commands, run, traction=traction, brake=BRAKE, air_brake=air), 4.0)
    time, rows = chained.rows["time_s"], chained.vehicle_rows
    assert time[-1] == pytest.approx(4.0)
    came = 200e3 * (1.0 - math.exp(-1.5))
    first, second = np.exp(-np.clip(time - 0.5, 0.0, None) / 0.01), np.exp(-np.clip(time - 0.515, 0.0, None) / 0.01)
    expected = np.where(time < 0.515, 200e3 * (1.0 - first), came * second + 50e3 * (1.0 - second))
    np.testing.assert_allclose(rows["traction_n"][:, 0], expected, rtol=1e-9, atol=1e-3)
    pipe = [(0.515, 1e5, 1.5), (1.7, 0.3e5, 6.0)]
    for k in range(5):
        late = [3.8 / 1.5 * reduction(pipe, now - k * 15.0 / 60.0) for now in time]
        np.testing.assert_allclose(rows["cylinder_pa"][:, k], late, rtol=1e-9, atol=1e-3)


@pytest.mark.parametrize(("method", "tolerance"), [("symplectic", 1e-5), ("rk4", 1e-5), ("euler", 1e-3), ("variable", 1e-5)])
def test_the_train_stops_in_the_distance_of_the_closed_form(method, tolerance):
    # All vehicles alike and at once: v = v0 - a (t - T (1 - e(-t/T))) from the command on
    start, lag, begin = 20.0, 4.0 / 3.0, 1.0
    case = {"start": {"speed_kmh": start * 3.6}, "brake": BRAKE, "air_brake": {"propagation_mps": 1e12}}
    run = {"method": method, "step_s": 0.005, "record_every_s": 0.01, "duration_s": 60.0}
    chained = advanced(train([{"time_s": begin, "brake": "full_service"}], run, **case), 60.0)
    low, high = 0.0, 60.0
    for _ in range(80):  # halved until it is the time of the stop
        middle = 0.5 * (low + high)
        lost = DECELERATION * (middle - lag * (1.0 - math.exp(-middle / lag)))
        low, high = (middle, high) if lost < start else (low, middle)
    gone = 0.5 * low**2 - lag * low + lag**2 * (1.0 - math.exp(-low / lag))
    distance = start * (begin + low) - DECELERATION * gone
    movers = chained.movers
    assert not movers["v_mps"].any()
    np.testing.assert_allclose(movers["s_m"] - movers["start_m"], distance, rtol=tolerance)
    stopped = chained.rows["time_s"][np.argmax(chained.vehicle_rows["v_mps"][:, 0] == 0.0)]
    assert stopped == pytest.approx(begin + low, abs=0.011)


def test_a_train_braked_from_its_front_is_bunched_by_the_delay():
    # the first vehicles brake before the last ones do: compression, the more the slower the pipe
    forces = []
    for propagation in (280.0, 70.0):
        case = {"start": {"speed_kmh": 72.0}, "brake": BRAKE, "air_brake": {"propagation_mps": propagation}}
        run = {"record_every_s": 0.01, "duration_s": 10.0}
        chained = advanced(train([{"time_s": 0.0, "brake": "emergency"}], run, **case), 6.0)
        forces.append(chained.link_rows["force_n"].min())
    assert forces[1] < 1.5 * forces[0] < 0.0
