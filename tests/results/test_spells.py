"""Spells beyond a limit against brute force, however the rows come in."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces, ragged, runs_of

from tractionpower.results.spells import Spells, TrainSpells


def spells_of(time_s, beyond, step_s):
    """Return (length, start) of the longest spell and the total time of rows that are beyond a limit."""
    steps = np.rint(time_s / step_s).astype(int)[beyond]
    runs = runs_of(list(steps))
    if not runs:
        return 0.0, np.nan, 0.0
    longest = max(runs, key=len)  # the first one
    return len(longest) * step_s, time_s[beyond][longest[0]], len(steps) * step_s


def compare(found, column, expected):
    got = [found.longest_s[column], found.longest_from_s[column], found.total_s[column]]
    np.testing.assert_allclose(got, expected, rtol=1e-12)


@settings(deadline=None, derandomize=True)
@given(
    seed=SEEDS,
    trains=st.integers(1, 4),
    steps=st.integers(0, 80),
    step_s=st.sampled_from([0.5, 1.0, 5.0]),
    above=st.booleans(),
    cuts=CUTS,
)
def test_spells_of_trains(seed, trains, steps, step_s, above, cuts):
    rng = np.random.default_rng(seed)
    step, train, time_s = ragged(rng, trains, steps, step_s)
    values = 3600.0 + rng.choice([-1.0, -0.05, 0.0, 0.05, 1.0], len(step))
    found, whole = (TrainSpells(trains, 3600.0, above) for _ in range(2))
    for piece in pieces(len(step), cuts):
        found.add(time_s[piece], train[piece], values[piece], step_s)
    whole.add(time_s, train, values, step_s)
    beyond = values > 3600.5 if above else values < 3599.5
    for t in range(trains):
        compare(found, t, spells_of(time_s[train == t], beyond[train == t], step_s))
    for name in ("longest_s", "longest_from_s", "total_s"):
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name))


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, rows=st.integers(0, 80), width=st.integers(0, 3), above=st.booleans(), cuts=CUTS)
def test_spells(seed, rows, width, above, cuts):
    rng = np.random.default_rng(seed)
    values, time_s = 2000.0 + rng.choice([-5.0, 0.0, 5.0], (rows, width)), 100.0 + np.arange(rows)
    found = Spells(width, 2000.0, above, tolerance=1.0)
    for piece in pieces(rows, cuts):
        found.add(time_s[piece], values[piece], 1.0)
    assert found.longest_s.shape == found.total_s.shape == found.longest_from_s.shape == (width,)
    for c in range(width):
        compare(found, c, spells_of(time_s, values[:, c] > 2000.0 if above else values[:, c] < 2000.0, 1.0))


@pytest.mark.parametrize(("voltage_v", "expected"), [(3600.0, 0.0), (3600.1, 0.0), (3600.2, 60.0)])
def test_a_voltage_at_the_limit_is_not_beyond_it(voltage_v, expected):
    found = Spells(1, 3600.0)
    found.add(np.arange(60.0), np.full((60, 1), voltage_v), 1.0)
    assert found.longest_s[0] == found.total_s[0] == expected


def test_a_train_that_leaves_and_comes_again():
    found = TrainSpells(1, 3600.0)
    time_s = np.array([*range(10), *range(20, 25)], float)
    found.add(time_s, np.zeros(15, int), np.full(15, 3700.0), 1.0)
    assert (found.longest_s[0], found.longest_from_s[0], found.total_s[0]) == (10.0, 0.0, 15.0)
