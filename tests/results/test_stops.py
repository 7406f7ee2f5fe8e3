"""Stops: from the brake command to standstill, as the steps have marked them."""

import numpy as np
import pytest

from tractionpower.kernels.chain_state import MARK
from tractionpower.kernels.chain_tables import CONTROL, PIPE
from tractionpower.results.stops import braking_spells, find_stops

INF = float("inf")
START = (-7.0, 0.0)


def marks(*rows):
    return np.array(list(rows), MARK)


def stand(time_s, s_m):
    return (time_s, s_m, 0.0, -1)


def test_constant_braking_takes_half_the_square_of_the_speed():
    v0, b, at_s = 20.0, 0.8, 10.0123
    at_m = v0 * at_s
    rows = marks((2.0, 40.0, v0, 1), (at_s, at_m, v0, 2), stand(at_s + v0 / b, at_m + v0**2 / (2 * b)))
    (stop,) = find_stops(rows, (0.0, v0), [(at_s, INF)])
    assert stop.is_braked and not stop.is_backwards
    assert (stop.braked_at_s, stop.braked_at_m, stop.speed_mps) == (at_s, at_m, v0)
    assert stop.distance_m == pytest.approx(v0**2 / (2 * b))
    assert stop.time_s == pytest.approx(v0 / b)
    assert stop.mean_deceleration_mps2 == pytest.approx(b)


def test_rolling_backwards_has_magnitudes():
    v0, b = -3.0, 0.5
    rows = marks((5.0, -20.0, v0, 1), stand(11.0, -20.0 - v0**2 / (2 * b)))
    (stop,) = find_stops(rows, START, [(5.0, INF)])
    assert stop.is_backwards
    assert stop.distance_m == pytest.approx(9.0) and stop.mean_deceleration_mps2 == pytest.approx(b)
    told = stop.as_dict()
    assert told["braked_from_kmh"] == pytest.approx(10.8) and told["stopping_distance_m"] == pytest.approx(9.0)
    assert told["backwards"] is True and told["braked_at_m"] == -20.0


def test_a_train_that_rolls_back_after_the_command_has_no_mean_deceleration():
    (stop,) = find_stops(marks((5.0, 0.0, 2.0, 1), stand(40.0, -30.0)), START, [(5.0, INF)])
    assert stop.is_backwards and stop.distance_m == 30.0
    assert stop.as_dict()["mean_deceleration_mps2"] is None


def test_the_spell_that_reaches_to_the_stop_counts():
    rows = marks((5.0, 50.0, 10.0, 1), (6.0, 60.0, 10.0, 2), (20.0, 200.0, 10.0, 3), stand(30.0, 250.0))
    (stop,) = find_stops(rows, (0.0, 10.0), [(5.0, 6.0), (20.0, INF)])
    assert (stop.braked_at_s, stop.braked_at_m) == (20.0, 200.0)
    (stop,) = find_stops(rows, (0.0, 10.0), [(5.0, 6.0)])
    assert not stop.is_braked
    assert stop.as_dict()["stopping_distance_m"] is None and stop.as_dict()["backwards"] is None
    assert stop.as_dict()["stopped_at_s"] == 30.0


def test_a_command_at_the_very_start_is_not_marked():
    (stop,) = find_stops(marks(stand(12.5, 125.0)), (0.0, 20.0), [(0.0, INF)])
    assert (stop.braked_at_s, stop.braked_at_m, stop.speed_mps) == (0.0, 0.0, 20.0)
    assert stop.distance_m == 125.0


def test_each_stop_is_told_and_settling_is_none():
    rows = marks(
        (5.0, 50.0, 10.0, 1), stand(15.0, 100.0), stand(15.4, 100.02), (24.0, 100.02, 0.0, 2),
        (30.0, 150.0, 10.0, 3), stand(40.0, 200.0),
    )  # fmt: skip
    stops = find_stops(rows, (0.0, 10.0), [(5.0, 24.0), (30.0, INF)])
    assert [stop.braked_at_s for stop in stops] == [5.0, 30.0]
    assert [stop.distance_m for stop in stops] == [50.0, 50.0]


def test_a_train_that_stands_or_never_stops_has_no_stop():
    assert find_stops(marks(stand(0.2, -6.99)), START, [(0.0, INF)]) == []
    assert find_stops(marks((5.0, 50.0, 10.0, 1)), (0.0, 10.0), [(5.0, INF)]) == []
    assert find_stops(marks(), START, []) == []


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
