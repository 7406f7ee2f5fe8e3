"""Mean useful voltage by both definitions: a case by hand, and brute force over random rows."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces

from tractionpower.results.useful_voltage import UsefulVoltage

NAMES = ("train_current_weighted_v", "train_time_mean_v", "zone_current_weighted_v", "zone_time_mean_v")


def means_of(useful):
    """Return the four means of all trains and zones."""
    return dict(zip(NAMES, (*useful.of_trains()[:2], *useful.of_zones()[:2]), strict=True))


def test_two_trains_by_hand():
    """Train 0: 2 s in zone 0 at 1000 A and 3000 V; train 1: 1 s there at 1000 A, 2700 V, then 1 s without current, 3300 V."""
    useful = UsefulVoltage(3, 2)
    useful.add(
        np.array([0, 1, 0, 1]),
        np.array([0, 0, 0, 0]),
        np.array([3000.0, 2700.0, 3000.0, 3300.0]),
        np.array([1000.0, -1000.0, 1000.0, 0.0]),
        np.array([True, False, True, True]),
        1.0,
    )
    np.testing.assert_allclose(useful.of_trains().current_weighted_v, [3000.0, 2700.0, np.nan])
    np.testing.assert_allclose(useful.of_trains().time_mean_v, [3000.0, 3300.0, np.nan])
    # T = 2 s for both: (3000 * 2000 + 2700 * 1000) / (2000 + 1000)
    np.testing.assert_allclose(useful.of_zones().current_weighted_v, [2900.0, np.nan])
    np.testing.assert_allclose(useful.of_zones().time_mean_v, [3000.0, np.nan])
    # The sums: train 0 draws 3 MW at 1000 A, train 1 on the mean half of 2.7 MW at 500 A.
    zones, trains = useful.of_zones(), useful.of_trains()
    np.testing.assert_allclose((zones.power_w[0], zones.current_a[0]), (3.0e6 + 1.35e6, 1500.0))
    np.testing.assert_allclose((zones.voltage_time_vs[0], zones.counted_s[0]), (12_000.0, 4.0))
    np.testing.assert_allclose(trains.current_a, [1000.0, 500.0, 0.0])
    np.testing.assert_allclose(trains.counted_s, [2.0, 1.0, 0.0])  # with traction effort


def test_a_train_counts_by_its_mean_current_in_the_zone():
    """One train is ten times as long in the zone as the other, with the same current: both count alike."""
    useful = UsefulVoltage(2, 1)
    train = np.array([0, *[1] * 10])
    voltage = np.where(train == 0, 2600.0, 3000.0)
    useful.add(train, np.zeros(11, int), voltage, np.full(11, 800.0), np.ones(11, bool), 1.0)
    assert useful.of_zones().current_weighted_v[0] == pytest.approx(2800.0)
    assert useful.of_zones().time_mean_v[0] == pytest.approx((2600.0 + 30_000.0) / 11.0)


def test_a_constant_voltage_is_its_own_mean():
    useful = UsefulVoltage(1, 1)
    useful.add(np.zeros(9, int), np.zeros(9, int), np.full(9, 3000.0), np.linspace(-500.0, 1500.0, 9), np.ones(9, bool), 0.1)
    for volts in means_of(useful).values():
        np.testing.assert_allclose(volts, [3000.0], rtol=1e-14)


def by_brute_force(rows, trains, zones):
    """Return the four means from a table of rows, group by group."""
    expected = {name: np.full(trains if name.startswith("train") else zones, np.nan) for name in NAMES}
    for train, mine in rows.groupby("train"):
        charge = (mine["i"].abs() * mine["h"]).sum()
        if charge:
            expected[NAMES[0]][train] = (mine["u"] * mine["i"].abs() * mine["h"]).sum() / charge
        pulling = mine[mine["tractive"]]
        if len(pulling):
            expected[NAMES[1]][train] = np.average(pulling["u"], weights=pulling["h"])
    for zone, inside in rows[rows["zone"] >= 0].groupby("zone"):
        above = below = 0.0
        for _, mine in inside.groupby("train"):
            spent = mine["h"].sum()
            above += (mine["u"] * mine["i"].abs() * mine["h"]).sum() / spent
            below += (mine["i"].abs() * mine["h"]).sum() / spent
        if below:
            expected[NAMES[2]][zone] = above / below
        expected[NAMES[3]][zone] = np.average(inside["u"], weights=inside["h"])
    return expected


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=SEEDS, count=st.integers(0, 60), trains=st.integers(1, 4), zones=st.integers(0, 3), cuts=CUTS)
def test_random_rows(seed, count, trains, zones, cuts):
    rng = np.random.default_rng(seed)
    rows = pd.DataFrame(
        {
            "train": rng.integers(0, trains, count),
            "zone": rng.integers(-1, zones, count),
            "u": rng.uniform(2000.0, 3900.0, count),
            "i": rng.uniform(-800.0, 1500.0, count) * rng.integers(0, 2, count),
            "tractive": rng.random(count) < 0.5,
            "h": rng.uniform(0.1, 1.0, count),
        }
    )
    found, whole = UsefulVoltage(trains, zones), UsefulVoltage(trains, zones)
    columns = [rows[name].to_numpy() for name in ("train", "zone", "u", "i", "tractive", "h")]
    for piece in pieces(count, cuts):
        found.add(*(column[piece] for column in columns))
    whole.add(*columns)
    expected = by_brute_force(rows, trains, zones)
    for name in NAMES:
        np.testing.assert_allclose(means_of(found)[name], expected[name], rtol=1e-12)
        np.testing.assert_array_equal(means_of(found)[name], means_of(whole)[name])  # to the last bit
