import math

import pytest
from remedy_cases import planned, small_study

from tractionpower.studies.remedies.window import AFTER_S, BEFORE_S, window

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
