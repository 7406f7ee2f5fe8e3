"""Extremes against brute force, however the rows come in."""

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.results.extremes import Extremes

SEEDS = st.integers(0, 2**32)
CUTS = st.lists(st.integers(0, 40), max_size=6)


def pieces(rows, cuts):
    bounds = [0, *sorted(min(cut, rows) for cut in cuts), rows]
    return list(itertools.pairwise(bounds))


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, rows=st.integers(1, 40), width=st.integers(0, 4), cuts=CUTS)
def test_extremes(seed, rows, width, cuts):
    rng = np.random.default_rng(seed)
    values = rng.integers(-5, 6, (rows, width)) * rng.choice([1.0, 0.1, 1e6])  # ties are likely
    time_s = np.cumsum(rng.uniform(0.1, 2.0, rows))
    found, whole = Extremes(width), Extremes(width)
    for first, end in pieces(rows, cuts):
        found.add(time_s[first:end], values[first:end])
    whole.add(time_s, values)
    np.testing.assert_array_equal(found.lowest, values.min(axis=0))
    np.testing.assert_array_equal(found.highest, values.max(axis=0))
    np.testing.assert_array_equal(found.lowest_s, time_s[values.argmin(axis=0)])  # the first time
    np.testing.assert_array_equal(found.highest_s, time_s[values.argmax(axis=0)])
    if width:
        assert found.count == rows
    np.testing.assert_allclose(found.mean, values.mean(axis=0), atol=1e-9)
    np.testing.assert_allclose(found.rms, np.sqrt((values**2).mean(axis=0)), atol=1e-9)
    np.testing.assert_array_equal(found.total, whole.total)  # to the last bit, wherever the pieces end
    np.testing.assert_array_equal(found.squares, whole.squares)


def test_extremes_of_nothing():
    found = Extremes(2)
    found.add(np.zeros(0), np.zeros((0, 2)))
    assert found.count == 0
    np.testing.assert_array_equal(found.mean, 0.0)
    np.testing.assert_array_equal(found.rms, 0.0)
