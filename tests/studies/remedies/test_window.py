import math

import pytest
from remedy_cases import case_of, planned, small_study

from tractionpower.studies.remedies.candidate import Candidate
from tractionpower.studies.remedies.window import AFTER_S, BEFORE_S, NEAR_S, reaches_all, window

DAY_S = 86_400.0
EVENT = {"time": 3600.0, "device": "C", "state": "open"}


def day(*runs, step_s=1.0, **more):
    return small_study(*(runs or (planned("X", 30_000.0), planned("Y", 50_000.0))), end_s=DAY_S, step_s=step_s, **more)


def test_it_reaches_from_before_the_start_of_the_late_train_to_after_its_end():
    study = day(remedies={"greatest_shift_s": 180.0, "greatest_reserve_s": 300.0})
    clock = window(study, {"X": 20.0}).clock
    assert clock.start == 30_000.0 - BEFORE_S - 180.0
    assert clock.end == 30_900.0 + AFTER_S + 300.0
    assert window(study, {"X": 20.0}).timetable == study.timetable


@pytest.mark.parametrize("step", [0.7, 4.0])
def test_its_start_lies_on_a_step(step):
    clock = window(day(step_s=step), {"X": 20.0}).clock
    assert clock.start / step == pytest.approx(round(clock.start / step), abs=1e-4)
    assert clock.start <= 30_000.0 - BEFORE_S


def test_it_covers_all_late_trains():
    clock = window(day(), {"X": 20.0, "Y": 5.0}).clock
    assert clock.start < 30_000.0
    assert clock.end > 50_900.0


def test_a_study_that_is_not_longer_stays_whole():
    study = small_study()
    assert window(study, {"X": 20.0}) is study
    assert window(day(), {}).clock.end == DAY_S


def test_the_window_stays_within_the_clock():
    study = day(planned("X", 85_000.0))
    assert window(study, {"X": math.inf}).clock.end == DAY_S


def test_states_that_were_switched_before_count():
    clock = window(day(switch_events=[EVENT]), {"X": 20.0}).clock
    assert clock.start == 0.0
    assert clock.end < 40_000.0


def candidate(*trains):
    changes = tuple(f"timetable.trains[{train}].max_current_a=500" for train in trains)
    return Candidate("current_cap", "-".join(trains), "%", 2.0, 5, lambda size: changes, str, float)


def test_what_runs_at_another_time_does_not_reach_a_late_train():
    study = day(planned("X", 30_000.0), planned("Y", 50_000.0), planned("Z", 30_000.0 + 900.0 + NEAR_S - 1.0))
    both, one = case_of(study, {"X": 20.0, "Y": 5.0}), case_of(study, {"X": 20.0})
    assert reaches_all(both, candidate("X", "Y"))
    assert not reaches_all(both, candidate("X", "Z"))
    assert not reaches_all(one, candidate("Y"))
    assert reaches_all(one, candidate("Z"))


def test_a_run_that_the_same_train_makes_later_is_reached():
    study = day(timetable={"rotations": [{"id": "R", "runs": ["X", "Y"]}]})
    assert reaches_all(case_of(study, {"Y": 20.0}), candidate("X"))
    assert not reaches_all(case_of(study, {"X": 20.0}), candidate("Y"))
