"""Sliding sums that do not drift, and the small kernels beside them, by hand."""

import math

import numpy as np
import pytest

from tractionpower.kernels.windows import (
    DEMAND,
    SPELL,
    TRAIN_RING,
    Sliding,
    TrainSliding,
    add_demand,
    add_spells,
    slide,
    slide_trains,
)


def sliding(steps, width):
    found = (len(steps), width)
    ring = (max(steps) + 1, width)
    return Sliding(np.zeros(ring), np.zeros(ring), np.array(steps), np.full(found, -np.inf), np.full(found, np.nan))


def test_no_drift_over_a_day():
    rng = np.random.default_rng(1)
    values = rng.uniform(0.0, 1e7, 86_400)
    values[:1000] *= 1e5  # a running sum that has seen these has lost the digits of what follows
    values[-100:] = 2.0 / 3.0
    values[:-100] *= -1.0  # so that the windows looked for are among the last rows
    state = sliding([10, 60], 1)
    slide(state, 0, 1.0, np.arange(1.0, 86_401.0), values[:, np.newaxis].copy())
    expected = [math.fsum([2.0 / 3.0] * steps) for steps in (10, 60)]
    np.testing.assert_array_equal(state.best[:, 0], expected)
    np.testing.assert_array_equal(state.until_s[:, 0], [86_310.0, 86_360.0])
    plain = np.cumsum(values)
    assert abs((plain[-80] - plain[-90]) / expected[0] - 1.0) > 1e-6  # what this test would see


@pytest.mark.interpreted
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_of_equal_windows_the_first_is_taken(sign):
    state = sliding([3, 7], 2)
    slide(state, 0, sign, np.arange(1.0, 301.0), np.full((300, 2), 0.1))
    np.testing.assert_array_equal(state.until_s, [[3.0, 3.0], [7.0, 7.0]])
    np.testing.assert_allclose(sign * state.best, [[0.3, 0.3], [0.7, 0.7]], rtol=1e-15)


@pytest.mark.interpreted
def test_a_window_that_was_never_full():
    state = sliding([2, 4], 1)
    slide(state, 0, 1.0, np.array([1.0, 2.0, 3.0]), np.array([[1.0], [5.0], [2.0]]))
    np.testing.assert_array_equal(state.best[:, 0], [7.0, -np.inf])
    np.testing.assert_array_equal(state.until_s[:, 0], [3.0, np.nan])


@pytest.mark.interpreted
def test_a_train_that_was_away_begins_anew():
    trains = np.zeros(2, TRAIN_RING)
    trains["ring"], trains["last_s"] = [1, 0], -np.inf
    found = (1, 2)
    best, until_s, at = np.full(found, -np.inf), np.full(found, np.nan), np.zeros(found)
    left = np.full((2, 3), 1e60)  # what other trains have left in the rings
    state = TrainSliding(left, left.copy(), np.array([2]), best, until_s, at, trains)
    time_s = np.array([0.0, 0.0, 1.0, 3.0, 4.0])
    train = np.array([0, 1, 0, 0, 0])
    slide_trains(state, 1.0, 1.0, time_s, train, np.array([1.0, 9.0, 2.0, 50.0, -49.5]), np.arange(5.0))
    np.testing.assert_array_equal(state.best[0], [3.0, -np.inf])  # not 2 + 50 across the gap
    np.testing.assert_array_equal(state.until_s[0], [2.0, np.nan])
    assert state.at[0, 0] == 2.0
    assert trains["rows"].tolist() == [2, 1]


@pytest.mark.interpreted
def test_a_step_across_a_boundary_is_shared_out():
    state, total, best = np.array([(np.nan, 0.0)], DEMAND), np.zeros(1), np.array([[-np.inf], [np.nan]])
    time_s = 4.0 * np.arange(8.0)  # 0 to 32 s in periods of 10 s
    values = np.array([[0.0], [1.0], [8.0], [2.0], [0.0], [1.0], [1.0], [5.0]])
    add_demand(state, total, best, (4.0, 10.0), time_s, values)
    assert best[0, 0] == pytest.approx((8.0 * 2.0 + 2.0 * 4.0) / 10.0)  # 10 to 20 s
    assert best[1, 0] == 10.0
    assert state["period"][0] == 3.0
    assert state["covered_s"][0] == pytest.approx(2.0)
    assert total[0] == pytest.approx(10.0)


@pytest.mark.interpreted
def test_spells():
    spells = np.zeros(1, SPELL)
    spells["last_s"] = -np.inf
    time_s = np.array([0.0, 1.0, 2.0, 3.0, 5.0, 6.0])
    add_spells(spells, 0.1, 1.0, time_s, np.zeros(6, np.int64), np.array([0.2, 0.1, 0.2, 0.2, 0.2, 0.0]))
    assert spells[["longest_s", "longest_from_s", "total_s"]][0].item() == (2.0, 2.0, 4.0)
