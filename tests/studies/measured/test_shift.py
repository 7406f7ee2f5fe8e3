"""The shift of a clock: found below a step, with noise, in every form of series; told where it is doubtful."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_files import COUNT, START, current_at, step_means

from tractionpower.studies.measured.computed import Computed
from tractionpower.studies.measured.samples import samples_of
from tractionpower.studies.measured.shift import Pair, _masked, correlation, find_shift

TIMES = START + np.arange(COUNT)
MEANS = step_means(current_at)


def pair_of(shift_s=0.0, every=0.5, noise=0.0, values=MEANS, first=40.0, last=1100.0, sign=1.0):
    time_s = START + np.arange(first, last, every)
    measured = sign * current_at(time_s) + noise * np.random.default_rng(2).normal(size=len(time_s))
    computed = Computed(TIMES, values, 1.0, 1.0, instant=False)
    return Pair(computed, samples_of(time_s - shift_s, measured))


@settings(deadline=None, derandomize=True, max_examples=25)
@given(st.floats(-100.0, 100.0))
def test_a_shift_is_found_to_a_hundredth_of_a_step(shift_s):
    found = find_shift([pair_of(shift_s)], 120.0)
    assert found.shift_s == pytest.approx(shift_s, abs=0.01)
    assert found.correlation > 0.99999
    assert found.doubts == ()


def test_noise_and_another_level_do_not_move_it():
    found = find_shift([pair_of(-33.4, noise=100.0, values=0.7 * MEANS + 200.0)], 120.0)
    assert found.shift_s == pytest.approx(-33.4, abs=0.6)
    assert 0.9 < found.correlation < 0.999
    assert 0.0 < found.width_s < 20.0


def test_the_correlation_of_every_lag_is_that_of_the_pairs():
    draw = np.random.default_rng(7)
    x, y = draw.normal(5.0, 2.0, 90), draw.normal(-3.0, 1.0, 130)
    x[draw.uniform(size=90) < 0.2] = np.nan
    y[draw.uniform(size=130) < 0.2] = np.nan
    direct = [correlation(x, y[m : m + 90]) for m in range(41)]
    np.testing.assert_allclose(_masked(x, y, 41), direct, atol=1e-12)


def test_missing_values_on_both_sides():
    values = MEANS.copy()
    values[300:420] = np.nan
    time_s = np.concatenate([START + np.arange(0.0, 500.0, 0.5), START + np.arange(640.0, 1200.0, 0.5)])
    measured = samples_of(time_s - 7.25, current_at(time_s))
    found = find_shift([Pair(Computed(TIMES, values, 1.0, 1.0, instant=False), measured)], 60.0)
    assert found.shift_s == pytest.approx(7.25, abs=0.02)


def test_values_of_an_instant_are_not_taken_for_means():
    """A speed is that at the start of a step: without that the shift would be wrong by half a step."""
    computed = Computed(TIMES, current_at(TIMES), 1.0, 1.0, instant=True)
    time_s = START + np.arange(40.0, 1100.0, 0.25)
    found = find_shift([Pair(computed, samples_of(time_s - 3.0, current_at(time_s)))], 20.0)
    assert found.shift_s == pytest.approx(3.0, abs=0.02)


def test_two_series_count_alike():
    steady = Pair(Computed(TIMES, np.full(COUNT, 3300.0), 1.0, 1.0, instant=False), pair_of(12.0).measured)
    assert find_shift([steady, pair_of(12.0)], 60.0).shift_s == pytest.approx(12.0, abs=0.02)


def test_a_periodic_signal_is_ambiguous():
    def wave(time_s):
        return 1000.0 + 300.0 * np.sin(2 * np.pi * time_s / 60.0)

    time_s = START + np.arange(200.0, 900.0)
    computed = Computed(TIMES, step_means(wave), 1.0, 1.0, instant=False)
    found = find_shift([Pair(computed, samples_of(time_s - 5.0, wave(time_s)))], 120.0)
    assert abs((found.shift_s - 5.0 + 30.0) % 60.0 - 30.0) < 0.2
    assert "ambiguous" in found.doubts[0]
    assert abs(abs(found.rival_s - found.shift_s) % 60.0) < 1.5 or abs(abs(found.rival_s - found.shift_s) % 60.0 - 60.0) < 1.5


@pytest.mark.parametrize("values", [np.full(COUNT, 3300.0), np.full(COUNT, np.nan)])
def test_constant_or_missing_signals_have_no_shift(values):
    found = find_shift([pair_of(5.0, values=values)], 120.0)
    assert found.shift_s == 0.0
    assert np.isnan(found.correlation)
    assert "constant" in found.doubts[0]


def test_doubts_are_told():
    assert "end of the range" in find_shift([pair_of(50.0)], 30.0).doubts[-1]
    noise = Pair(pair_of().computed, samples_of(TIMES.astype(float), np.random.default_rng(4).normal(size=COUNT)))
    assert "hardly resemble" in find_shift([noise], 60.0).doubts[0]
    slow = Computed(TIMES, TIMES - START, 1.0, 1.0, instant=False)
    ramp = find_shift([Pair(slow, samples_of(TIMES.astype(float), TIMES - START))], 100.0)
    assert any("flat" in doubt or "end of the range" in doubt for doubt in ramp.doubts)


def test_a_wrong_sign_does_not_spoil_the_shift():
    for pairs in ([pair_of(5.0, sign=-1.0)], [pair_of(5.0, sign=-1.0), pair_of(5.0)]):
        found = find_shift(pairs, 60.0)
        assert found.shift_s == pytest.approx(5.0, abs=0.02)
        assert found.doubts == ()


def test_series_that_do_not_meet():
    assert "do not overlap" in find_shift([pair_of(5000.0)], 60.0).doubts[0]
