"""Trains that stand in each other, against all pairs of trains looked at one by one."""

from itertools import combinations, pairwise

import numpy as np
import pytest

from tractionpower.cosimulation.overlaps import Overlaps
from tractionpower.cosimulation.places import Placed

TRACKS = ("1", "2")


def random_rows(seed):
    rng = np.random.default_rng(seed)
    trains = int(rng.integers(2, 12))
    lengths = rng.choice([0.02, 0.1, 0.4, 2.0], trains)
    times, train, track, km, sign = [], [], [], [], []
    for step in range(int(rng.integers(1, 25))):
        for k in range(trains):
            if rng.random() < 0.8:
                times.append(float(step))
                train.append(k)
                track.append(int(rng.integers(0, 2)))
                km.append(float(rng.uniform(0.0, 5.0)))
                sign.append(int(rng.choice([-1, 1])))
    placed = Placed(np.array(track, np.int64), np.array(km, float), np.array(sign, np.int64))
    return lengths, np.array(times, float), np.array(train, np.int64), placed


def all_pairs(lengths, time_s, train, placed):
    """Return steps and first time of every pair that shares a stretch of a track, and the metre where it begins."""
    ends = []
    for k, km, sign in zip(train, placed.km, placed.sign, strict=True):
        tail = km - sign * lengths[k]
        ends.append((min(km, tail), max(km, tail)))
    found = {}
    for a, b in combinations(range(len(train)), 2):
        if (
            time_s[a] == time_s[b]
            and placed.track[a] == placed.track[b]
            and max(ends[a][0], ends[b][0]) < min(ends[a][1], ends[b][1])
        ):
            pair = tuple(sorted((int(train[a]), int(train[b]))))
            steps, first, _, _ = found.get(pair, (0, float(time_s[a]), int(placed.track[a]), 0.0))
            at = found[pair][3] if pair in found else max(ends[a][0], ends[b][0])
            where = found[pair][2] if pair in found else int(placed.track[a])
            found[pair] = (steps + 1, first, where, at)
    return found


def pairs_of(overlaps):
    return {pair: (each.steps, each.time_s, each.track, each.km) for pair, each in overlaps.pairs.items()}


@pytest.mark.parametrize("seed", range(40))
def test_every_pair_is_found_once_per_step(seed):
    lengths, time_s, train, placed = random_rows(seed)
    overlaps = Overlaps([f"T{k}" for k in range(len(lengths))], lengths, TRACKS)
    overlaps.add(time_s, train, placed)
    expected = all_pairs(lengths, time_s, train, placed)
    found = pairs_of(overlaps)
    assert set(found) == set(expected)
    for pair, (steps, first, track, km) in expected.items():
        assert found[pair][:3] == (steps, first, track)
        assert found[pair][3] == pytest.approx(km)
    assert overlaps.summary()["count"] == len(expected)


def test_the_seeds_overlap_often_enough():
    assert sum(len(all_pairs(*random_rows(seed))) for seed in range(40)) > 300


@pytest.mark.parametrize("seed", range(5))
def test_pieces_make_no_difference(seed):
    lengths, time_s, train, placed = random_rows(seed)
    whole, parts = (Overlaps([str(k) for k in range(len(lengths))], lengths, TRACKS) for _ in range(2))
    whole.add(time_s, train, placed)
    bounds = np.searchsorted(time_s, [0, 1, 5, 6, 100])
    for first, end in pairwise(bounds.tolist()):
        part = Placed(placed.track[first:end], placed.km[first:end], placed.sign[first:end])
        parts.add(time_s[first:end], train[first:end], part)
    assert pairs_of(parts) == pairs_of(whole)


def test_many_short_trains_within_a_long_one_are_all_told():
    lengths = np.array([1.0, 0.01, 0.01, 0.01, 0.01])
    overlaps = Overlaps(list("abcde"), lengths, TRACKS)
    km = np.array([2.0, 1.2, 1.4, 1.6, 1.8])
    overlaps.add(np.zeros(5), np.arange(5), Placed(np.zeros(5, np.int64), km, np.ones(5, np.int64)))
    assert sorted(overlaps.pairs) == [(0, 1), (0, 2), (0, 3), (0, 4)]


def test_trains_that_only_touch_or_meet_on_other_tracks_do_not_overlap():
    overlaps = Overlaps(["a", "b", "c"], np.array([0.5, 0.5, 0.5]), TRACKS)
    km, track = np.array([1.0, 1.5, 1.0]), np.array([0, 0, 1])
    overlaps.add(np.zeros(3), np.arange(3), Placed(track, km, np.ones(3, np.int64)))
    assert overlaps.summary() == {"count": 0, "message": ""}


def test_the_message_names_the_first_five():
    overlaps = Overlaps([f"T{k}" for k in range(8)], np.full(8, 0.2), TRACKS)
    km = np.repeat([1.0, 2.0, 3.0, 4.0], 2) + np.tile([0.0, 0.05], 4)
    overlaps.add(np.full(8, 3661.0), np.arange(8), Placed(np.zeros(8, np.int64), km, np.ones(8, np.int64)))
    told = overlaps.summary()
    assert told["count"] == 4
    assert "T0 and T1 (01:01:01, track 1, km 0.9, 1 steps)" in told["message"]
    everyone = Overlaps([f"T{k}" for k in range(4)], np.full(4, 0.2), TRACKS)
    everyone.add(np.zeros(4), np.arange(4), Placed(np.zeros(4, np.int64), np.full(4, 1.0), np.ones(4, np.int64)))
    assert everyone.summary()["count"] == 6
    assert everyone.summary()["message"].endswith("and 1 more pairs")


def test_of_a_run_they_are_those_of_the_rows(busy):
    lengths = {train.id: 0.1 for train in busy.scenario.timetable.trains}
    rows, found = busy.trains, {}
    signs = {
        planned.id: 1 if planned.route[0].to_km > planned.route[0].from_km else -1 for planned in busy.scenario.timetable.trains
    }
    for _, step in rows.groupby(["time_s", "track"]):
        for a, b in combinations(step.itertuples(), 2):
            low = [min(row.position_km, row.position_km - signs[row.train] * lengths[row.train]) for row in (a, b)]
            if max(low) < min(low) + 0.1:
                pair = tuple(sorted((a.train, b.train)))
                found[pair] = found.get(pair, 0) + 1
    told = busy.results.run["overlaps"]
    assert told["count"] == len(found) > 0
    for (a, b), steps in found.items():
        assert f"{a} and {b} (" in told["message"]
        assert f"{steps} steps" in told["message"]


def test_portions_of_one_train_may_stand_together():
    time_s, train = np.zeros(3), np.array([2, 0, 1])
    placed = Placed(np.zeros(3, np.int64), np.array([1.0, 1.02, 1.04]), np.ones(3, np.int64))
    found = Overlaps("abc", np.full(3, 0.1), TRACKS, {(0, 2)})
    found.add(time_s, train, placed)
    assert sorted(found.pairs) == [(0, 1), (1, 2)]
