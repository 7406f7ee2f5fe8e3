"""Stops: from the brake command to standstill, between recorded rows too."""

import numpy as np
import pytest

from tractionpower.kernels.chain_tables import CONTROL, PIPE
from tractionpower.results.stops import braking_spells, find_stops

INF = float("inf")


def braked(v0, b, t_brake, end_s, every=0.05):
    """Return rows of a train that runs with `v0` and brakes with `b` from a time on."""
    time_s = np.arange(0.0, end_s, every)
    since = np.clip(time_s - t_brake, 0.0, v0 / b)
    speed = v0 - b * since
    place = v0 * np.minimum(time_s, t_brake) + v0 * since - 0.5 * b * since**2
    return time_s, place, speed, np.abs(speed) <= 1e-9


@pytest.mark.parametrize("t_brake", [10.0, 10.0123, 10.0499])
def test_constant_braking_takes_half_the_square_of_the_speed(t_brake):
    v0, b = 20.0, 0.8
    (stop,) = find_stops(*braked(v0, b, t_brake, 60.0), [(t_brake, INF)])
    assert stop.is_braked
    # the row between which the command falls has a kink: the cubic through it is off by b h^2 at most
    assert stop.distance_m == pytest.approx(v0**2 / (2 * b), abs=b * 0.05**2)
    assert stop.time_s == pytest.approx(v0 / b, abs=0.05)
    assert stop.speed_mps == pytest.approx(v0, abs=b * 0.05)
    assert stop.mean_deceleration_mps2 == pytest.approx(b, rel=3e-3)


def test_place_between_rows_is_exact_where_the_motion_is_smooth():
    b = 0.5
    time_s = np.arange(0.0, 30.0, 0.5)
    speed = np.maximum(10.0 - b * time_s, 0.0)
    place = np.where(time_s <= 20.0, 10.0 * time_s - 0.5 * b * time_s**2, 100.0)
    (stop,) = find_stops(time_s, place, speed, speed <= 0.0, [(3.21, INF)])
    assert stop.braked_at_m == pytest.approx(10.0 * 3.21 - 0.25 * 3.21**2, abs=1e-12)
    assert stop.speed_mps == pytest.approx(10.0 - 0.5 * 3.21, abs=1e-12)


def test_the_spell_that_reaches_to_the_stop_counts():
    rows = braked(10.0, 1.0, 20.0, 40.0)
    (stop,) = find_stops(*rows, [(5.0, 6.0), (20.0, INF)])
    assert stop.braked_at_s == 20.0
    (stop,) = find_stops(*rows, [(5.0, 6.0)])
    assert not stop.is_braked
    assert stop.as_dict()["stopping_distance_m"] is None
    assert stop.as_dict()["stopped_at_s"] == pytest.approx(30.0, abs=0.05)


def test_each_stop_is_told_and_settling_is_none():
    t1, s1, v1, held1 = braked(10.0, 1.0, 5.0, 20.0)
    bounce = 0.05 * np.sin(np.arange(100) * 0.3)  # settles in its couplings after the stop
    t = np.concatenate([t1, 20.0 + 0.05 * np.arange(100), 25.0 + t1])
    s = np.concatenate([s1, np.full(100, s1[-1]), s1[-1] + s1])
    v = np.concatenate([v1, bounce, v1])
    held = np.concatenate([held1, bounce == 0.0, held1])
    stops = find_stops(t, s, v, held, [(5.0, 24.0), (30.0, INF)])
    assert [stop.braked_at_s for stop in stops] == [5.0, 30.0]
    assert [stop.distance_m for stop in stops] == pytest.approx([50.0, 50.0], abs=0.01)


def test_a_train_that_stands_or_never_stops_has_no_stop():
    time_s = np.arange(0.0, 5.0, 0.1)
    still = np.zeros_like(time_s)
    assert find_stops(time_s, still, still, still == 0.0, [(0.0, INF)]) == []
    assert find_stops(time_s, 3.0 * time_s, still + 3.0, still > 0.0, []) == []
    assert find_stops(np.empty(0), np.empty(0), np.empty(0), np.empty(0, bool), []) == []


def test_a_train_may_stand_in_its_first_row_of_motion():
    time_s = np.array([0.0, 1.0, 2.0])
    assert find_stops(time_s, np.zeros(3), np.array([0.5, 0.0, 0.0]), np.array([False, True, True]), [(0.0, INF)])[
        0
    ].time_s == pytest.approx(1.0)


def controls(*rows):
    return np.array([(at_s, 0, electric, independent, 0) for at_s, electric, independent in rows], CONTROL)


def pipe(*rows):
    return np.array([(from_s, 0.0, target, 1.0, False) for from_s, target in rows], PIPE)


def test_spells_join_what_brakes_in_whatever_way():
    made = braking_spells(controls((0.0, 0.0, 0.0), (4.0, 0.5, 0.0), (9.0, 0.0, 0.0)), pipe((0.0, 0.0), (8.0, 5e4), (12.0, 0.0)))
    assert made == [(4.0, 12.0)]
    assert braking_spells(controls((0.0, 0.0, 1e5)), pipe((0.0, 0.0))) == [(0.0, INF)]
    assert braking_spells(controls((0.0, 0.0, 0.0)), pipe((0.0, 0.0))) == []
    twice = pipe((0.0, 0.0), (2.0, 5e4), (3.0, 1e5), (5.0, 0.0), (7.0, 5e4))
    assert braking_spells(controls((0.0, 0.0, 0.0)), twice) == [(2.0, 5.0), (7.0, INF)]
