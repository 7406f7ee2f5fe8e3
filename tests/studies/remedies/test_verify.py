import math

import pytest
from remedy_cases import judged, small_study

from tractionpower.studies.remedies.allowance import Allowance
from tractionpower.studies.remedies.remedy import Remedy
from tractionpower.studies.remedies.verify import verify


def remedy(cap, cost, *, feasible=True):
    change = f"timetable.trains[Y].max_current_a={cap}"
    return Remedy("current_cap", "Y", cost, "%", "A cap.", (change,), feasible, False, 0.0, 30.0, math.nan, cost)


def judge_by_cap(late, overlaps=0):
    """Return what judges a study by the cap on Y: how late X is with it."""

    def judge(scenario):
        seconds = late[scenario.runs[1].max_current_a]
        return judged({"X": seconds, "Y": 0.0}, lost_s=seconds + 5.0, overlaps=overlaps)

    return judge


BASE = judged({"X": 20.0, "Y": 0.0})


def test_the_cheapest_that_the_whole_run_confirms_comes_first():
    rows = verify([remedy(800, 10.0), remedy(700, 20.0)], small_study(), BASE, judge_by_cap({800.0: 4.0, 700.0: 0.0}))
    assert [(row.cost, row.feasible, row.verified) for row in rows] == [(20.0, True, True), (10.0, False, False)]
    assert (rows[0].lost_before_s, rows[0].lost_after_s) == (30.0, pytest.approx(5.0))
    assert rows[1].lateness_after_s == 4.0


def test_trains_that_run_on_one_another_are_no_remedy():
    (row,) = verify([remedy(800, 10.0)], small_study(), BASE, judge_by_cap({800.0: 0.0}, overlaps=1))
    assert not row.feasible
    assert "run on one another" in row.words
    before = judged({"X": 20.0, "Y": 0.0}, overlaps=1)
    (row,) = verify([remedy(800, 10.0)], small_study(), before, judge_by_cap({800.0: 0.0}, overlaps=1))
    assert row.feasible


def test_only_as_many_are_verified_as_the_bounds_say():
    study = small_study(remedies={"most_verified": 1})
    rows = verify([remedy(800, 10.0), remedy(700, 20.0)], study, BASE, judge_by_cap({800.0: 0.0}))
    assert [row.verified for row in rows] == [True, False]


def test_what_does_not_hold_anyway_is_not_run():
    rows = verify([remedy(800, 10.0, feasible=False)], small_study(), BASE, judge_by_cap({}))
    assert not rows[0].feasible


def test_a_change_that_is_refused_is_not_feasible():
    (row,) = verify([remedy(-1, 10.0)], small_study(), BASE, judge_by_cap({}))
    assert (row.feasible, row.verified) == (False, False)


def three():
    return [remedy(800, 10.0), remedy(700, 20.0), remedy(600, 30.0)]


def test_when_time_is_over_only_the_best_is_verified():
    late = dict.fromkeys((800.0, 700.0, 600.0), 0.0)
    rows = verify(three(), small_study(), BASE, judge_by_cap(late), Allowance(-1.0))
    assert [(row.cost, row.feasible, row.verified) for row in rows] == [
        (10.0, True, True), (20.0, True, False), (30.0, True, False),
    ]  # fmt: skip
    assert math.isnan(rows[1].lost_after_s)
    rows = verify(three(), small_study(), BASE, judge_by_cap(late | {800.0: 5.0}), Allowance(-1.0))
    assert [(row.cost, row.feasible, row.verified) for row in rows] == [
        (20.0, True, False), (30.0, True, False), (10.0, False, False),
    ]  # fmt: skip


def test_ctrl_c_keeps_what_was_verified():
    def judge(scenario):
        if scenario.runs[1].max_current_a == 700.0:
            raise KeyboardInterrupt
        return judge_by_cap({800.0: 0.0, 600.0: 0.0})(scenario)

    allowance = Allowance()
    rows = verify(three()[:2], small_study(remedies={"workers": 1}), BASE, judge, allowance)
    assert [(row.cost, row.verified) for row in rows] == [(10.0, True), (20.0, False)]
    assert allowance.stopped
    rows = verify(three(), small_study(), BASE, judge, allowance)
    assert not any(row.verified for row in rows)  # not even the first one
