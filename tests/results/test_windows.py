"""Sliding windows and the demand by the clock against brute force, however the rows come in."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces, ragged, runs_of

from tractionpower.results.windows import WINDOWS_S, ClockDemand, SlidingWindows, TrainWindows, window_label

PICKS = st.sampled_from(["highest", "lowest"])
STEPS = st.sampled_from([0.5, 1.0, 4.0, 5.0])


def series(rng, shape):
    """Return rows with many ties; whole numbers, so that the sums of the reference are exact."""
    return rng.integers(-5, 6, shape) * rng.choice([1.0, 1e6]) + rng.choice([0.0, 3000.0])


def best_window(values, steps, pick):
    """Return the best mean and the position after the window's last row, the first one of equals, of all windows."""
    sums = [math.fsum(values[k : k + steps]) for k in range(len(values) - steps + 1)]
    if not sums:
        return np.nan, None
    position = int(np.argmax(sums) if pick == "highest" else np.argmin(sums))
    return sums[position] / steps, position + steps


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, rows=st.integers(0, 300), width=st.integers(0, 3), step_s=STEPS, pick=PICKS, squares=st.booleans(), cuts=CUTS)
def test_sliding_windows(seed, rows, width, step_s, pick, squares, cuts):
    rng = np.random.default_rng(seed)
    values, time_s = series(rng, (rows, width)), 600.0 + step_s * np.arange(rows)
    windows_s = (10.0, 1.0, 60.0, 17.0)
    found, whole = (SlidingWindows(width, step_s, windows_s, pick, squares) for _ in range(2))
    for piece in pieces(rows, cuts):
        found.add(time_s[piece], values[piece])
    whole.add(time_s, values)
    assert found.windows_s == tuple(window for window in windows_s if window >= step_s)
    for w, window in enumerate(found.windows_s):
        steps = math.floor(window / step_s + 0.5)
        for c in range(width):
            mean, end = best_window(values[:, c] ** 2 if squares else values[:, c], steps, pick)
            np.testing.assert_allclose(found.best[w, c], np.sqrt(mean) if squares else mean, rtol=1e-14)
            until_s = np.nan if end is None else time_s[end - 1] + step_s
            np.testing.assert_equal(found.best_until_s[w, c], until_s)
            np.testing.assert_equal(found.best_from_s[w, c], until_s - steps * step_s)
    for name in ("best", "best_from_s", "best_until_s"):  # to the last bit
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name))


@settings(deadline=None, derandomize=True, max_examples=30)
@given(seed=SEEDS, cuts=CUTS)
def test_pieces_do_not_matter_to_the_last_bit(seed, cuts):
    """Values whose sums round at every addition."""
    rng = np.random.default_rng(seed)
    values, time_s = rng.uniform(-1.0, 1.0, (400, 3)) * 10.0 ** rng.uniform(-8, 8, (400, 3)), np.arange(400.0)
    found, whole = [(SlidingWindows(3, 1.0, (10.0, 60.0)), ClockDemand(3, 1.0, 60.0)) for _ in range(2)]
    for a, b in zip(found, whole, strict=True):
        for piece in pieces(400, cuts):
            a.add(time_s[piece], values[piece])
        b.add(time_s, values)
        np.testing.assert_array_equal(a.best, b.best)
        np.testing.assert_array_equal(a.best_from_s, b.best_from_s)


def test_a_load_cycle_of_a_quarter_of_an_hour():
    """Worked by hand: 300 s at 1000 A, 60 s at 3000 A, 540 s at 500 A."""
    current = np.repeat([1000.0, 3000.0, 500.0], [300, 60, 540])[:, np.newaxis]
    time_s = np.arange(900.0)
    mean, rms, demand = SlidingWindows(1, 1.0), SlidingWindows(1, 1.0, squares=True), ClockDemand(1, 1.0)
    for device in (mean, rms, demand):
        device.add(time_s, current)
    quarter, minute = WINDOWS_S.index(900), WINDOWS_S.index(60)
    assert mean.best[quarter, 0] == pytest.approx(833.333, abs=5e-4)
    assert rms.best[quarter, 0] == pytest.approx(1040.833, abs=5e-4)
    assert rms.best[minute, 0] == 3000.0
    assert (rms.best_from_s[minute, 0], rms.best_until_s[minute, 0]) == (300.0, 360.0)
    assert demand.best[0] == pytest.approx(833.333, abs=5e-4)
    assert demand.best_from_s[0] == 0.0
    assert np.isnan(mean.best[WINDOWS_S.index(1800) :]).all()


def test_a_window_is_rounded_to_whole_steps_and_never_shorter_than_one():
    found = SlidingWindows(1, 4.0, (3.0, 4.0, 10.0))
    found.add(np.array([0.0, 4.0, 8.0, 12.0]), np.array([[1.0], [2.0], [3.0], [4.0]]))
    assert found.windows_s == (4.0, 10.0)
    np.testing.assert_array_equal(found.best[:, 0], [4.0, 3.0])  # of 1 and of 3 steps
    np.testing.assert_array_equal(found.best_from_s[:, 0], [12.0, 4.0])


def test_lowest_of_zeros_is_not_minus_zero():
    found = SlidingWindows(1, 1.0, (2.0,), "lowest")
    found.add(np.arange(3.0), np.zeros((3, 1)))
    assert not np.signbit(found.best[0, 0])


def test_rows_of_another_width_are_refused():
    for device in (SlidingWindows(2, 1.0), ClockDemand(2, 1.0)):
        with pytest.raises(ValueError, match="reshape"):
            device.add(np.zeros(1), np.zeros((1, 3)))


def test_rows_that_may_not_be_written_or_are_not_contiguous():
    values = np.arange(20.0).reshape(10, 2)
    values.flags.writeable = False
    found = SlidingWindows(1, 1.0, (2.0,))
    found.add(np.arange(10), values[:, 1:])
    assert found.best[0, 0] == 18.0


def test_labels():
    labels = [window_label(window) for window in WINDOWS_S]
    assert labels == ["10_s", "15_s", "1_min", "5_min", "15_min", "30_min", "60_min", "120_min", "180_min"]
    assert [window_label(window) for window in (90, 0.5)] == ["90_s", "0.5_s"]


@settings(deadline=None, derandomize=True)
@given(
    seed=SEEDS,
    rows=st.integers(0, 200),
    start_s=st.floats(0.0, 100.0),
    step_s=st.sampled_from([0.02, 0.1, 0.7, 1.0, 5.0, 45.0]),
    period_s=st.sampled_from([1.0, 10.0, 30.0]),
    cuts=CUTS,
)
def test_demand_by_the_clock(seed, rows, start_s, step_s, period_s, cuts):
    rng = np.random.default_rng(seed)
    start_s = round(start_s / step_s) * step_s
    values, time_s = rng.uniform(-100.0, 100.0, (rows, 2)), start_s + step_s * np.arange(rows)
    found, whole = (ClockDemand(2, step_s, period_s) for _ in range(2))
    for piece in pieces(rows, cuts):
        found.add(time_s[piece], values[piece])
    whole.add(time_s, values)
    begins = period_s * np.arange(int((start_s + rows * step_s) / period_s) + 2)
    overlap = np.minimum(time_s + step_s, begins[:, np.newaxis] + period_s) - np.maximum(time_s, begins[:, np.newaxis])
    overlap = np.maximum(overlap, 0.0)  # (periods, rows)
    complete = overlap.sum(axis=1) > period_s - 1e-5 * step_s
    if not complete.any():
        assert np.isnan(found.best).all()
        assert np.isnan(found.best_from_s).all()
    else:
        means = (overlap @ values / period_s)[complete]
        np.testing.assert_allclose(found.best, means.max(axis=0), rtol=1e-6, atol=1e-6)
        np.testing.assert_array_equal(found.best_from_s, begins[complete][means.argmax(axis=0)])
    np.testing.assert_array_equal(found.best, whole.best)
    np.testing.assert_array_equal(found.best_from_s, whole.best_from_s)


def test_a_period_with_a_missing_row_does_not_count():
    demand = ClockDemand(1, 1.0, 10.0)
    time_s = np.delete(np.arange(30.0), 13)
    demand.add(time_s, np.where(time_s < 10.0, 1.0, np.where(time_s < 20.0, 7.0, 2.0))[:, np.newaxis])
    assert (demand.best[0], demand.best_from_s[0]) == (2.0, 20.0)


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, trains=st.integers(1, 5), steps=st.integers(0, 60), step_s=STEPS, pick=PICKS, cuts=CUTS)
def test_windows_of_trains(seed, trains, steps, step_s, pick, cuts):
    rng = np.random.default_rng(seed)
    step, train, time_s = ragged(rng, trains, steps, step_s)
    values, at = series(rng, len(step)), rng.uniform(0.0, 20.0, len(step))
    windows_s = (2.0 * step_s, 7.0 * step_s)
    found, whole = (TrainWindows(trains, step_s, windows_s, pick) for _ in range(2))
    for piece in pieces(len(step), cuts):
        found.add(time_s[piece], train[piece], values[piece], at[piece])
    whole.add(time_s, train, values, at)
    for w, length in enumerate((2, 7)):
        for t in range(trains):
            mine = np.flatnonzero(train == t)
            candidates = [(*best_window(values[mine[run]], length, pick), run) for run in runs_of(step[mine])]
            candidates = [candidate for candidate in candidates if candidate[1] is not None]
            if not candidates:
                assert np.isnan([found.best[w, t], found.best_until_s[w, t], found.best_at[w, t]]).all()
                continue
            mean, end, run = (max if pick == "highest" else min)(candidates, key=lambda candidate: candidate[0])
            last = mine[run[end - 1]]
            assert found.best[w, t] == pytest.approx(mean, rel=1e-14)
            assert found.best_until_s[w, t] == time_s[last] + step_s
            assert found.best_from_s[w, t] == time_s[last] - (length - 1) * step_s
            assert found.best_at[w, t] == at[last]
    for name in ("best", "best_from_s", "best_until_s", "best_at"):
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name))


def test_trains_that_left_hand_their_rings_on():
    """Memory does not grow with the trains of a day: each of them alone on the line for a minute."""
    found = TrainWindows(200, 1.0, (10.0, 3600.0))
    for train in range(200):
        time_s = 61.0 * train + np.arange(60.0)
        found.add(time_s, np.full(60, train), np.full(60, 3000.0 + train), time_s)
    assert len(found._sliding.high) <= 2
    np.testing.assert_array_equal(found.best[0], 3000.0 + np.arange(200))
    assert np.isnan(found.best[1]).all()


def test_rows_of_unknown_trains_are_refused():
    for train in (-1, 2):
        with pytest.raises(ValueError, match=r"negative|broadcast"):
            TrainWindows(2, 1.0).add(np.zeros(1), np.array([train]), np.zeros(1), np.zeros(1))
