"""Bands of voltages: their times and longest spells against brute force over random rows."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces, ragged

from tractionpower.model.limits import SystemVoltages
from tractionpower.results.voltage_bands import VoltageDurations, bands_of

VOLTAGES = SystemVoltages(u_min2=2000.0, u_min1=2200.0, u_n=3000.0, u_max1=3600.0, u_max2=3900.0)
SAME = SystemVoltages(u_min2=2000.0, u_min1=2000.0, u_n=3000.0, u_max1=3600.0, u_max2=3900.0)


def of(volts, voltages=VOLTAGES, step_s=1.0, **times):
    durations = VoltageDurations(1, bands_of(voltages, **times), voltages.u_n, step_s)
    rows = np.array(volts)
    durations.add(100.0 + np.arange(len(rows)) * step_s, np.zeros(len(rows), int), rows)
    return durations


def test_bands_without_a_width_are_left_out():
    assert [band.name for band in bands_of(VOLTAGES)] == [
        "below U_min2", "U_min2 to U_min1", "U_min1 to U_n", "U_n to U_max1", "U_max1 to U_max2", "above U_max2",
    ]  # fmt: skip
    assert [band.name for band in bands_of(SAME)] == [
        "below U_min2", "U_min1 to U_n", "U_n to U_max1", "U_max1 to U_max2", "above U_max2",
    ]  # fmt: skip


def test_each_step_is_in_one_band_and_limits_have_their_tolerance():
    durations = of([1999.95, 1999.85, 2199.95, 2199.85, 2999.99, 3000.0, 3600.05, 3600.15, 3900.05, 3900.15])
    np.testing.assert_allclose(durations.total_s[0], [1.0, 2.0, 2.0, 2.0, 2.0, 1.0])
    assert durations.total_s.sum() == durations.time_s.sum() == 10.0


def test_what_lies_further_away_counts_for_how_long_it_lasts():
    """Above U_max1 for 4 s, of which 1 s above U_max2: the spell is not broken by that."""
    durations = of([3500.0, 3700.0, 3950.0, 3700.0, 3700.0, 3500.0], high_s=3.0)
    assert durations.longest_s[0].tolist() == [0.0, 0.0, 0.0, 6.0, 4.0, 1.0]
    assert durations.longest_from_s[0, 4:].tolist() == [101.0, 102.0]
    assert durations.total_s[0].tolist() == [0.0, 0.0, 0.0, 2.0, 3.0, 1.0]
    met = durations.met(durations.longest_s)[0]
    np.testing.assert_array_equal(met, [1.0, np.nan, np.nan, np.nan, 0.0, 0.0])


@settings(deadline=None, derandomize=True, max_examples=40)
@given(seed=SEEDS, cuts=CUTS, voltages=st.sampled_from([VOLTAGES, SAME]))
def test_random_rows(seed, cuts, voltages):
    rng = np.random.default_rng(seed)
    step, train, time_s = ragged(rng, 3, 40, 0.5)
    levels = [1500.0, 1999.95, 2100.0, 2500.0, 3000.0, 3300.0, 3650.0, 3900.05, 4000.0]
    volts = rng.choice(levels, len(train), p=[0.2, 0.1, *[0.1] * 7])
    bands = bands_of(voltages, 120.0, 300.0)
    found = VoltageDurations(3, bands, voltages.u_n, 0.5)
    for piece in pieces(len(train), cuts):
        found.add(time_s[piece], train[piece], volts[piece])
    for k in range(3):
        mine = {int(n): float(u) for n, u in zip(step[train == k], volts[train == k], strict=True)}
        for b, band in enumerate(bands):
            low = not band.from_v >= voltages.u_n
            edges = [-np.inf if np.isnan(band.from_v) else band.from_v, np.inf if np.isnan(band.to_v) else band.to_v]
            slack = [0.0 if edge == voltages.u_n else 0.1 * (1 if edge > voltages.u_n else -1) for edge in edges]
            start, end = edges[0] + slack[0], edges[1] + slack[1]
            inside = [n for n, u in mine.items() if (start <= u < end if low or edges[0] == voltages.u_n else start < u <= end)]
            assert found.total_s[k, b] == pytest.approx(0.5 * len(inside))
            beyond = {n for n, u in mine.items() if (u < end if low else (u >= start if edges[0] == voltages.u_n else u > start))}
            longest = max((m for m in range(len(mine) + 41) for n in beyond if beyond.issuperset(range(n, n + m))), default=0)
            assert found.longest_s[k, b] == pytest.approx(0.5 * longest)


def test_the_table_has_all_trains_first_and_passes_over_those_without_a_voltage():
    bands = bands_of(SAME, high_s=300.0)
    durations = VoltageDurations(3, bands, 3000.0, 1.0)
    time_s = np.arange(400.0)
    durations.add(np.repeat(time_s, 2), np.tile([0, 2], 400), np.tile([3700.0, 2900.0], 400))
    frame = durations.table(["a", "b", "c"]).to_pandas()
    assert frame["train"].tolist() == [""] * 5 + ["a"] * 5 + ["c"] * 5
    row = frame[frame["band"] == "U_max1 to U_max2"].set_index("train")
    assert row["total_s"].tolist() == [400.0, 400.0, 0.0]
    assert row["share_percent"].tolist() == [50.0, 100.0, 0.0]
    assert row["met"].tolist() == ["no", "no", "yes"]
    assert frame[frame["train"] == ""]["share_percent"].sum() == pytest.approx(100.0)
    assert VoltageDurations(2, bands, 3000.0, 1.0).table(["a", "b"]).num_rows == 0
