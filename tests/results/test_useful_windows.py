"""Mean useful voltages in windows, of zones that overlap, without trains that stayed too briefly: against brute force."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces, ragged

from tractionpower.results.useful_voltage import UsefulVoltage
from tractionpower.results.useful_windows import Window, WindowedUsefulVoltage, windows_of

MEMBERS = (np.array([0]), np.array([0, 1]), np.array([2]), np.array([], int))


def test_the_hours_of_a_run_are_those_by_the_clock():
    windows = windows_of(5.5 * 3600.0, 8.0 * 3600.0, [(0.0, 6.0 * 3600.0), (7 * 3600.0, 7.5 * 3600.0), (9 * 3600.0, 10 * 3600.0)])
    assert [(window.kind, window.from_s / 3600.0, window.to_s / 3600.0) for window in windows] == [
        ("run", 5.5, 8.0), ("hour", 6.0, 7.0), ("hour", 7.0, 8.0), ("given", 5.5, 6.0), ("given", 7.0, 7.5),
    ]  # fmt: skip
    assert windows_of(60.0, 660.0) == (Window("run", 60.0, 660.0),)  # shorter than an hour


def test_a_train_that_stays_too_briefly_does_not_count():
    """Train 0 is in the zone for 3 s, train 1 for 1 s: with 2 s as the shortest stay it is left out."""
    useful = UsefulVoltage(2, 1)
    voltage = np.array([3000.0, 2000.0, 3000.0, 3300.0])
    useful.add(np.array([0, 1, 0, 0]), np.zeros(4, int), voltage, np.array([100.0, 900.0, 100.0, 0.0]), np.ones(4, bool), 1.0)
    kept, brief = useful.of_zones([np.array([0])], 2.0), useful.of_zones([np.array([0])], 0.5)
    assert (kept.trains[0], kept.left_out[0]) == (1, 1)
    assert (brief.trains[0], brief.left_out[0]) == (2, 0)
    assert kept.current_weighted_v[0] == pytest.approx(3000.0)
    assert kept.time_mean_v[0] == pytest.approx(3100.0)
    np.testing.assert_allclose(
        [brief.current_weighted_v[0], brief.time_mean_v[0]], [useful.of_zones().current_weighted_v[0], 2825.0]
    )
    np.testing.assert_allclose(useful.of_trains(2.0).current_weighted_v, [3000.0, np.nan])
    assert useful.of_zones([np.array([0])], 3.0).trains[0] == 1  # as long as that is long enough


def expected_of(rows, members, shortest_s):
    """Return by brute force current-weighted mean, time mean, trains and trains left out, of rows with their weights."""
    inside = rows[rows["part"].isin(members) & (rows["h"] > 0.0)]
    above = below = volts = time = 0.0
    count = out = 0
    for _, mine in inside.groupby("train"):
        spent = mine["h"].sum()
        if spent < shortest_s - 1e-9:
            out += 1
            continue
        count += 1
        above += (mine["u"] * mine["i"].abs() * mine["h"]).sum() / spent
        below += (mine["i"].abs() * mine["h"]).sum() / spent
        volts, time = volts + (mine["u"] * mine["h"]).sum(), time + spent
    return above / below if below else np.nan, volts / time if time else np.nan, count, out


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=SEEDS, cuts=CUTS, step_s=st.sampled_from([0.5, 1.0, 3.7]), shortest_s=st.sampled_from([0.0, 4.0, 20.0]))
def test_random_rows(seed, cuts, step_s, shortest_s):
    rng = np.random.default_rng(seed)
    _, train, time_s = ragged(rng, 3, 60, step_s)
    count = len(train)
    rows = pd.DataFrame(
        {
            "time": time_s, "train": train, "part": rng.integers(-1, 3, count), "u": rng.uniform(2000.0, 3900.0, count),
            "i": rng.uniform(-800.0, 1500.0, count), "pulls": rng.random(count) < 0.5,
        }
    )  # fmt: skip
    end_s = 30_000.0 + 60 * step_s
    windows = (
        Window("run", 30_000.0, end_s), Window("hour", 30_000.0 + 11.3, 30_000.0 + 30.0),
        Window("given", 30_000.0 + 20.0, 30_000.0 + 21.0), Window("given", end_s, end_s + 5.0),
    )  # fmt: skip
    columns = [rows[name].to_numpy() for name in ("time", "train", "part", "u", "i", "pulls")]
    found, whole = (WindowedUsefulVoltage(3, 3, MEMBERS, windows, shortest_s) for _ in range(2))
    for piece in pieces(count, cuts):
        found.add(*(column[piece] for column in columns), step_s)
    whole.add(*columns, step_s)
    for means, same in zip(found.means(), whole.means(), strict=True):
        window = means.window
        weight = np.minimum(rows["time"] + step_s, window.to_s) - np.maximum(rows["time"], window.from_s)
        mine = rows.assign(h=step_s if window.kind == "run" else weight.clip(lower=0.0).where(weight > 1e-8, 0.0))
        expected = [expected_of(mine, members.tolist(), shortest_s) for members in MEMBERS]
        for values, wanted in zip(means.zones[:4], zip(*expected, strict=True), strict=True):
            np.testing.assert_allclose(values, wanted, rtol=1e-9)
        for got, again in zip((*means.zones, *means.trains), (*same.zones, *same.trains), strict=True):
            np.testing.assert_array_equal(got, again)  # to the last bit
        pulling = mine[mine["pulls"] & (mine["h"] > 0.0)]
        for k in range(3):
            mine_k, stay = pulling[pulling["train"] == k], mine[mine["train"] == k]["h"].sum()
            wanted = np.average(mine_k["u"], weights=mine_k["h"]) if len(mine_k) and stay >= shortest_s - 1e-9 else np.nan
            np.testing.assert_allclose(means.trains.time_mean_v[k], wanted, rtol=1e-9)
