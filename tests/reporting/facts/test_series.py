"""Fewer points of long series: no peak is lost; sliding means against plain ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.reporting.facts.series import envelope, interval, peaks_kept, sliding_mean

VALUES = st.lists(st.floats(-1e4, 1e4), min_size=1, max_size=400).map(np.array)


@settings(deadline=None, derandomize=True)
@given(values=VALUES, most=st.integers(3, 60))
def test_points_that_are_drawn_are_few_and_hold_every_extreme(values, most):
    kept = peaks_kept(values, most)
    assert len(kept) <= max(most, 3) + 1
    assert {0, len(values) - 1} <= set(kept)
    assert np.all(np.diff(kept) > 0)
    assert (values[kept].min(), values[kept].max()) == (values.min(), values.max())


def test_a_single_peak_of_a_day_is_kept_where_it_stands_and_gaps_are_no_peaks():
    values = np.zeros(86400)
    values[54321], values[100:200] = 7.0, np.nan
    kept = peaks_kept(values, 900)
    assert 54321 in kept
    assert np.nanmax(values[kept]) == 7.0


@settings(deadline=None, derandomize=True)
@given(values=VALUES, buckets=st.integers(1, 50))
def test_a_band_holds_every_value_of_its_spell(values, buckets):
    time_s = 10.0 * np.arange(len(values))
    starts, low, high = envelope(time_s, values, buckets)
    spell = np.searchsorted(starts, time_s, side="right") - 1
    assert np.all((low[spell] <= values) & (values <= high[spell]))
    assert (low.min(), high.max()) == (values.min(), values.max())
    assert len(starts) <= buckets


@settings(deadline=None, derandomize=True)
@given(values=VALUES, window=st.integers(1, 40))
def test_a_sliding_mean_is_the_mean_of_the_last_values(values, window):
    mean = sliding_mean(values, window)
    for k in range(len(values)):
        if k < window - 1:
            assert np.isnan(mean[k])
        else:
            assert mean[k] == pytest.approx(values[k - window + 1 : k + 1].mean(), abs=1e-6)


def test_the_interval_of_rows_is_the_usual_one():
    assert interval(np.array([0.0, 5.0, 10.0, 15.0, 30.0])) == 5.0
    assert interval(np.array([7.0])) == 1.0
