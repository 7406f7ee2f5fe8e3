"""Loads of devices against brute force and profiles worked by hand, however the rows come in."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces

from tractionpower.kernels.device_loads import BINS, FINEST_A
from tractionpower.results import device_loads
from tractionpower.results.device_loads import DeviceLoads, steps_of
from tractionpower.results.windows import WINDOWS_S, SlidingWindows

RESULTS = ("peak_a", "peak_s", "signed_peak_a", "mean_a", "mean_magnitude_a", "rms_a", "best_rms", "from_s", "best_mean")


def currents(rng, shape):
    """Return rows with many ties, or with sums that round; some series rest for long, as feeders do."""
    if rng.random() < 0.5:
        return rng.integers(-5, 6, shape) * rng.choice([1.0, 500.0])
    return rng.normal(0.0, 1.0, shape) * 10.0 ** rng.uniform(-3, 4, shape[1]) * (rng.random(shape) < rng.uniform(0.1, 1.0))


def best_window(values, steps):
    """Return the greatest mean of a window, and the first row of the first one of equals."""
    sums = [math.fsum(values[k : k + steps]) for k in range(len(values) - steps + 1)]
    return (max(sums) / steps, sums.index(max(sums))) if sums else (np.nan, None)


def loads_of(time_s, amps, step_s, windows_s, cuts=()):
    found = DeviceLoads(amps.shape[1], step_s, windows_s)
    for piece in pieces(len(amps), cuts):
        found.add(time_s[piece], amps[piece])
    return found


@settings(deadline=None, derandomize=True)
@given(
    seed=SEEDS,
    rows=st.integers(0, 300),
    width=st.integers(0, 3),
    step_s=st.sampled_from([0.5, 1.0, 4.0]),
    room=st.integers(1, 70),
)
def test_against_brute_force(seed, rows, width, step_s, room):
    rng = np.random.default_rng(seed)
    amps, time_s = currents(rng, (rows, width)), 600.0 + step_s * np.arange(rows)
    kept, device_loads._ROOM = device_loads._ROOM, room  # rings of any length must do
    try:
        found = loads_of(time_s, amps, step_s, (10.0, 60.0, 17.0, 200.0))
    finally:
        device_loads._ROOM = kept
    for c in range(width):
        magnitude = np.abs(amps[:, c])
        for values, best, from_s in (
            (magnitude**2, found.best_rms**2, found.from_s),
            (magnitude, found.best_mean, found.mean_from_s),
        ):
            for w, window in enumerate(found.windows_s):
                steps = math.floor(window / step_s)
                mean, first = best_window(values, steps)
                np.testing.assert_allclose(best[w, c], mean, rtol=1e-13)
                if first is None:
                    assert np.isnan(from_s[w, c])
                else:  # of windows whose sums differ by a rounding either may be told
                    at = round((from_s[w, c] - 600.0) / step_s)
                    assert math.fsum(values[at : at + steps]) / steps == pytest.approx(mean, rel=1e-13)
        if rows:
            np.testing.assert_allclose(found.rms_a[c], math.sqrt(math.fsum(magnitude**2) / rows), rtol=1e-13)
            np.testing.assert_allclose(found.mean_a[c], math.fsum(amps[:, c]) / rows, rtol=1e-13, atol=1e-13)
            np.testing.assert_allclose(found.mean_magnitude_a[c], math.fsum(magnitude) / rows, rtol=1e-13)
            assert found.peak_a[c] == magnitude.max()
            if magnitude.any():
                first = int(magnitude.argmax())
                assert (found.peak_s[c], found.signed_peak_a[c]) == (time_s[first], amps[first, c])


@settings(deadline=None, derandomize=True, max_examples=40)
@given(seed=SEEDS, cuts=CUTS)
def test_pieces_do_not_matter_to_the_last_bit(seed, cuts):
    rng = np.random.default_rng(seed)
    amps, time_s = currents(rng, (400, 3)), np.arange(400.0)
    found, whole = (loads_of(time_s, amps, 1.0, (10.0, 60.0), each) for each in (cuts, ()))
    for name in RESULTS:
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name))
    np.testing.assert_array_equal(found.load_duration([0.0, 0.1, 0.5, 1.0]), whole.load_duration([0.0, 0.1, 0.5, 1.0]))


@pytest.mark.interpreted
def test_the_profile_worked_by_hand():
    """300 s at 1000 A, 60 s at 3000 A, 540 s at 500 A."""
    amps = np.repeat([1000.0, -3000.0, 500.0], [300, 60, 540])[:, np.newaxis]
    found = loads_of(np.arange(900.0), amps, 1.0, WINDOWS_S)
    rms = dict(zip(found.windows_s, found.best_rms[:, 0].tolist(), strict=True))
    assert rms[900.0] == pytest.approx(1040.8330, abs=5e-5)
    assert rms[60.0] == pytest.approx(3000.0)
    assert rms[300.0] == pytest.approx(math.sqrt((240 * 1000.0**2 + 60 * 3000.0**2) / 300))
    assert math.isnan(rms[1800.0])  # the run is shorter
    assert found.best_mean[found.windows_s.index(900.0), 0] == pytest.approx(833.3333, abs=5e-5)
    assert found.mean_a[0] == pytest.approx((300 * 1000.0 - 60 * 3000.0 + 540 * 500.0) / 900)
    assert found.from_s[found.windows_s.index(60.0), 0] == 300.0


def test_a_day_does_not_drift():
    """The best windows come after a day of currents that round at every addition; and they are those of other code."""
    rng = np.random.default_rng(1)
    amps = np.concatenate([rng.uniform(0.0, 1e4, 60_000), np.zeros(2000), 1e4 + rng.random(20)])[:, np.newaxis]
    found, other = loads_of(np.arange(len(amps)), amps, 1.0, WINDOWS_S), SlidingWindows(1, 1.0, squares=True)
    assert found.best_rms[0, 0] ** 2 == pytest.approx(best_window(amps[-20:, 0] ** 2, 10)[0], rel=3e-16)
    other.add(np.arange(float(len(amps))), amps)
    np.testing.assert_array_equal(found.best_rms, other.best)
    np.testing.assert_array_equal(found.from_s, other.best_from_s)


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, rows=st.integers(1, 400), share=st.floats(0.0, 1.0))
def test_load_duration_against_sorting(seed, rows, share):
    rng = np.random.default_rng(seed)
    amps = currents(rng, (rows, 2))
    found = loads_of(np.arange(float(rows)), amps, 1.0, (10.0,)).load_duration([share])[0]
    falling = -np.sort(-np.abs(amps), axis=0)
    rank = max(1, math.ceil(share * rows - 1e-6))
    expected = falling[rank - 1] if share > 0.0 else falling[0]
    tolerance = np.maximum(falling[0] / 500.0, FINEST_A)
    assert (np.abs(found - expected) <= tolerance).all()


def test_the_peak_is_reached_for_no_time_and_nothing_for_all():
    amps = np.array([[0.0, 2000.0], [0.0, 1000.0], [0.0, 1000.0], [0.0, 0.0]])
    found = loads_of(np.arange(4.0), amps, 1.0, (10.0,)).load_duration([0.0, 0.25, 0.5, 0.75, 1.0])
    np.testing.assert_array_equal(found[:, 0], 0.0)
    np.testing.assert_allclose(found[:, 1], [2000.0, 2000.0, 1000.0, 1000.0, 0.0], atol=2000.0 / (BINS / 2))


def test_a_window_is_never_longer_than_asked_for():
    """A pulse of 8 s every 12 s at steps of 4 s: over 10 s only two steps fit, in which the current never rests."""
    amps = np.tile([2000.0, 2000.0, 0.0], 10)[:, np.newaxis]
    found = loads_of(4.0 * np.arange(30), amps, 4.0, (10.0, 12.0, 3.0))
    assert found.windows_s == (10.0, 12.0)
    np.testing.assert_allclose(found.best_rms[:, 0], [2000.0, 2000.0 * math.sqrt(2.0 / 3.0)])
    assert [steps_of(0.3, 0.1), steps_of(7.0, 0.7), steps_of(7.0, 0.71)] == [3, 10, 9]


def test_without_rows_nothing_is_known():
    found = DeviceLoads(1, 1.0)
    assert np.isnan([found.rms_a[0], found.mean_a[0], found.load_duration([0.5])[0, 0]]).all()
    assert found.peak_a[0] == 0.0
