"""Samples as functions: integrals are kept by any windows, gaps stay gaps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.studies.measured.samples import in_order, samples_of

KINDS = ("instant", "mean_after", "mean_before")


def brute_mean(time_s, values, kind, low, high):
    """Return the mean of a window without gaps by a very fine midpoint rule."""
    at = np.linspace(low, high, 20001)
    at = (at[1:] + at[:-1]) / 2.0
    if kind == "instant":
        return np.interp(at, time_s, values).mean()
    side = "right" if kind == "mean_after" else "left"
    index = np.searchsorted(time_s, at, side=side) - (kind == "mean_after")
    return values[np.clip(index, 0, len(values) - 1)].mean()


@pytest.mark.parametrize("kind", KINDS)
def test_means_of_windows_are_those_of_a_fine_rule(kind):
    draw = np.random.default_rng(5)
    time_s, values = np.cumsum(draw.uniform(0.1, 1.0, 80)), draw.normal(100.0, 50.0, 80)
    samples = samples_of(time_s, values, kind, gap=10.0)
    for low, width in [(5.0, 1.0), (7.3, 0.05), (11.11, 13.7)]:
        exact = brute_mean(time_s, values, kind, low, low + width)
        assert samples.means(np.array([low]), width)[0] == pytest.approx(exact, abs=0.05 * width + 0.02)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    st.lists(st.tuples(st.floats(0.01, 3.0), st.floats(-5000.0, 5000.0)), min_size=3, max_size=60),
    st.floats(0.05, 7.0),
    st.sampled_from(KINDS),
    st.floats(-50.0, 50.0),
)
def test_the_energy_is_kept_whatever_the_windows_and_wherever_they_begin(rows, width, kind, begin):
    """What the windows hold, each mean times its measured part, is the integral over all pieces."""
    time_s = np.cumsum([step for step, _ in rows])
    values = np.array([value for _, value in rows])
    samples = samples_of(time_s, values, kind, gap=2.0)
    edges = np.arange(min(begin, -4.0), time_s[-1] + 10.0, width)
    area, covered = samples.totals(np.append(edges, time_s[-1] + 10.0))
    direct = sum(
        (b - a) * (u + v) / 2.0 for a, b, u, v in zip(samples.begin, samples.end, samples.first, samples.last, strict=True)
    )
    assert np.diff(area).sum() == pytest.approx(direct, rel=1e-9, abs=1e-6)
    assert (np.diff(covered) >= -1e-9).all()
    means = samples.means(edges, width)
    known = np.isfinite(means)
    if known.any() and values.size:
        assert means[known].min() >= values.min() - 1e-6
        assert means[known].max() <= values.max() + 1e-6


@settings(deadline=None, derandomize=True, max_examples=30)
@given(st.floats(-500.0, 500.0), st.floats(0.3, 4.0))
def test_moving_the_samples_moves_the_windows(shift, width):
    time_s = np.array([0.0, 0.7, 1.1, 2.9, 3.0, 9.0, 9.5, 10.5])
    values = np.array([1.0, 4.0, -3.0, 8.0, 2.0, 0.5, 7.0, 1.0])
    begin = np.arange(-1.0, 11.0, 0.37)
    here = samples_of(time_s, values, gap=3.0).means(begin, width)
    there = samples_of(time_s + shift, values, gap=3.0).means(begin + shift, width)
    np.testing.assert_allclose(there, here, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(("kind", "seen"), [("instant", (9.0, 21.0)), ("mean_after", (10.0, 21.0)), ("mean_before", (9.0, 20.0))])
def test_a_gap_is_not_filled(kind, seen):
    time_s = np.concatenate([np.arange(0.0, 10.0), np.arange(21.0, 30.0)])
    samples = samples_of(time_s, np.full(19, 5.0), kind)
    assert samples.gaps.tolist() == [[9.0, 21.0]]
    means = samples.means(np.arange(0.0, 29.0), 1.0)
    dark = np.flatnonzero(np.isnan(means))
    assert (dark[0], dark[-1] + 1.0) == seen


def test_coarse_samples_are_no_gaps_and_a_given_gap_counts():
    time_s = np.arange(0.0, 600.0, 10.0)
    assert not len(samples_of(time_s, time_s).gaps)
    assert samples_of(time_s, time_s).means(np.array([3.0, 104.5]), 1.0) == pytest.approx([3.5, 105.0])
    assert len(samples_of(time_s, time_s, gap=9.0).gaps) == 59


def test_rows_of_a_coarse_clock_are_averaged_and_keep_the_integral():
    time_s = np.repeat(np.arange(5.0), 4)
    values = np.arange(20.0)
    at, (mean,), back, twice = in_order(time_s, values)
    assert (at.tolist(), back, twice) == ([0.0, 1.0, 2.0, 3.0, 4.0], 0, 15)
    assert mean.tolist() == [1.5, 5.5, 9.5, 13.5, 17.5]
    shuffled = np.random.default_rng(1).permutation(20)
    at, (again,), back, _ = in_order(time_s[shuffled], values[shuffled])
    assert back > 0
    assert again.tolist() == mean.tolist()
    nothing = np.where(np.arange(20) < 4, np.nan, values)
    assert np.isnan(in_order(time_s, nothing)[1][0][0])
