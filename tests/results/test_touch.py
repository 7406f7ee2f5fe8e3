"""Touch voltages: which duration holds, against a rule that looks at every spell by itself."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces, runs_of

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.limits import Limit, common_limits, known_systems, overlay
from tractionpower.results.touch import TouchCheck, check_touch, touch_limits, touch_verdicts

TABLE = {np.inf: 120.0, 300.0: 150.0, 1.0: 160.0, 0.9: 165.0, 0.8: 170.0, 0.7: 175.0, 0.6: 360.0}
"""Voltages of the table [V] by duration [s], the first rows."""


def limits(step_s=1.0, *rows):
    return touch_limits(overlay(shipped_limits(), rows), "dc3000", step_s)


def check(volts, step_s=1.0, start_s=0.0):
    """Return the rows of a check by name, for one place."""
    found = TouchCheck(limits(step_s), 1, 0, step_s)
    found.add(start_s + np.arange(len(volts)) * step_s, np.array(volts, float)[:, np.newaxis])
    return {row["limit"]: row for row in found.rows(["here"], [], [])}


def test_the_shipped_table_is_that_of_its_source():
    found = [each for each in limits(0.02) if each.judged]
    assert {each.duration_s: each.voltage_v for each in found[:7]} == TABLE
    assert [each.voltage_v for each in found[7:]] == [385.0, 420.0, 460.0, 520.0, 625.0, 735.0, 870.0]
    assert {each.limit.status for each in found} == {"secondary"}
    assert [each.may_last_s for each in found] == [each.duration_s for each in found[1:]] + [0.0]


@pytest.mark.parametrize(("step_s", "names"), [(5.0, ["permanent", "300s"]), (1.0, ["permanent", "300s", "1s"])])
def test_durations_below_the_step_are_not_looked_at(step_s, names):
    found = limits(step_s)
    assert [each.limit.name for each in found] == [f"touch_{name}" for name in names] + ["touch_workshop"]


@pytest.mark.parametrize(
    ("volts", "seconds", "violated"),
    [
        (119.0, 1000, []),
        (121.0, 300, []),
        (121.0, 301, ["touch_permanent"]),
        (-121.0, 301, ["touch_permanent"]),
        (151.0, 1, []),
        (151.0, 2, ["touch_300s"]),  # between 1 s and 300 s the voltage of 300 s holds
        (161.0, 1, ["touch_1s"]),
        (155.0, 301, ["touch_permanent", "touch_300s"]),
        (120.1, 400, []),  # within the tolerance
    ],
)
def test_a_spell_may_last_as_long_as_the_next_shorter_duration(volts, seconds, violated):
    rows = check([0.0, *[volts] * seconds, 0.0])
    assert [name for name, row in rows.items() if row["met"] is False] == violated


def test_a_break_of_one_step_ends_a_spell_and_a_change_of_sign_does_not():
    row = check([*[130.0] * 200, 100.0, *[130.0] * 150, *[-130.0] * 140])["touch_permanent"]
    assert (row["longest_s"], row["time"], row["place"], row["met"]) == (290.0, "00:03:21", "here", True)


def test_the_voltage_of_workshops_is_told_and_not_judged():
    rows = check([70.0] * 400)
    assert (rows["touch_workshop"]["longest_s"], rows["touch_workshop"]["met"]) == (400.0, None)
    assert rows["touch_workshop"]["status"] == "recalled"
    assert "touch_workshop" not in {each["limit"] for each in touch_verdicts(rows.values())}


def allowed(seconds):
    """Return the voltage [V] that may last so long: that of the next longer duration of the table."""
    return TABLE[min(duration for duration in TABLE if duration >= seconds)]


def steps_above(volts, level):
    """Return the steps of each unbroken run above a level."""
    steps = np.flatnonzero(np.abs(volts) > level)
    return [steps[run] for run in runs_of(steps.tolist())]


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=SEEDS, rows=st.integers(1, 60), step_s=st.sampled_from([1.0, 60.0]), cuts=CUTS)
def test_violations_are_those_of_the_next_longer_duration(seed, rows, step_s, cuts):
    rng = np.random.default_rng(seed)
    volts = rng.choice([100.0, 130.0, -155.0, 170.0], (rows, 3), p=[0.2, 0.5, 0.2, 0.1])
    time_s = 3600.0 + np.arange(rows) * step_s
    found = TouchCheck(limits(step_s), 3, 0, step_s)
    for piece in pieces(rows, cuts):
        found.add(time_s[piece], volts[piece])
    violated = any(row["met"] is False for row in found.rows(["a", "b", "c"], [], []))
    expected = False
    for k in range(3):
        for level in (120.0, 150.0, 160.0):
            for spell in steps_above(volts[:, k], level):
                expected |= np.abs(volts[spell, k]).min() > allowed(len(spell) * step_s)
    assert violated == expected


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=SEEDS, steps=st.integers(1, 60), cuts=CUTS)
def test_trains_tell_where_their_longest_spell_began(seed, steps, cuts):
    rng = np.random.default_rng(seed)
    volts = rng.choice([100.0, 130.0, -130.0], (steps, 2), p=[0.3, 0.4, 0.3])
    time_s, train = np.repeat(np.arange(steps, dtype=float), 2), np.tile([0, 1], steps)
    km = 5.0 + time_s / 100.0 + train
    found = TouchCheck(limits(), 1, 2, 1.0)
    for piece in pieces(2 * steps, cuts):
        found.add_trains(time_s[piece], train[piece], volts.ravel()[piece], (train[piece], km[piece]))
    (row,) = [row for row in found.rows(["here"], ["X", "Y"], ["1", "2"]) if row["limit"] == "touch_permanent"]
    spells = [(spell, k) for k in range(2) for spell in steps_above(volts[:, k], 120.0)]
    longest = max((len(spell) for spell, _ in spells), default=0)
    assert row["longest_s"] == longest
    if longest:
        places = [f"train {'XY'[k]}, from track {k + 1}, km {5.0 + spell[0] / 100.0 + k:.2f}" for spell, k in spells
                  if len(spell) == longest]  # fmt: skip
        assert row["place"] == places[0]


def test_rows_of_the_system_replace_those_of_all():
    own = Limit(system="dc3000", name="touch_permanent", value=100.0)
    other = Limit(system="dc750", name="touch_300s", value=1.0)
    found = limits(1.0, own, other)
    assert [(each.voltage_v, each.limit.status) for each in found[:2]] == [(100.0, "user"), (150.0, "secondary")]
    assert common_limits(shipped_limits(), "dc3000", "u_").keys() >= {"u_n"}
    assert known_systems(shipped_limits()) == ["dc1500", "dc3000", "dc600", "dc750"]


def test_bad_rows_are_told():
    rows = [Limit(system="dc", name="touch_soon", value=1.0), Limit(system="dc3000", name="touch_1s", value=-1.0)]
    found = check_touch(overlay(shipped_limits(), rows), "dc3000")
    assert [(each.code, each.path) for each in found] == [
        ("touch_voltage", "limits[dc3000 touch_1s]"),
        ("unknown_limit", "limits[dc touch_soon]"),
    ]
    assert check_touch(shipped_limits(), "dc3000") == []
