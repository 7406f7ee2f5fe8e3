"""A driving plan that is slower than its timetable is told with the seconds that it needs more."""

import re

import pytest
from small_trains import call, journey, make_run, make_trains

from tractionpower.movement.checks import check_movement

STATIONS = {"stations": {"A": 0.0, "B": 4.0, "C": 8.0}}
SLOW = {"kind": "rules", "speed_percent": 60.0}


def study(*calls, **more):
    return make_trains(resistance={"a_n": 2000.0}, calls=list(calls), **STATIONS | more)


def times(**more):
    """Return when the train comes to B and C [s]; it waits nowhere."""
    found = journey(study(call("A", departure=0.0), call("B"), call("C"), **more), step_s=0.1)
    return [item.arrival_s for item in found.calls[1:]]


def told(problems):
    return [(problem.code, problem.path, problem.severity) for problem in problems]


def missing(problem):
    return float(re.search(r"([0-9.]+) s (more|are missing)", problem.found)[1])


@pytest.mark.parametrize("spare", [-12.0, 5.0])
def test_rules_that_do_not_make_the_timetable_are_told(spare):
    b, _ = times(driving=SLOW)
    calls = [call("A", departure=0.0), call("B", arrival=b + spare), call("C")]
    problems = check_movement(study(*calls, driving=SLOW))
    assert told(problems) == [("plan_too_slow", "timetable.trains[x].driving", "warning")] * (spare < 0.0)
    if problems:
        assert missing(problems[0]) == pytest.approx(-spare, abs=0.5)  # steps of 1 s against steps of 0.1 s
        assert "from A to B the plan of train x" in problems[0].found
    assert check_movement(study(*calls, driving={"kind": "to_time"})) == []


@pytest.mark.parametrize(("driving", "needs"), [({"percent": 10.0}, 1.1), ({"seconds": 30.0}, None)])
def test_a_reserve_that_the_timetable_does_not_give_is_told(driving, needs):
    b, c = times()
    needs = b * needs - b if needs is not None else 30.0 * b / c
    (problem,) = check_movement(
        study(call("A", departure=0.0), call("B", arrival=b + 5.0), call("C"), driving={"kind": "reserve"} | driving)
    )
    assert problem.code == "plan_too_slow"
    assert missing(problem) == pytest.approx(needs - 5.0, abs=0.5)


def test_what_the_train_itself_cannot_do_is_told_once():
    b, _ = times()
    problems = check_movement(study(call("A", departure=0.0), call("B", arrival=b - 20.0), call("C"), driving=SLOW))
    assert [problem.code for problem in problems] == ["faster_than_train"]


def test_a_running_time_that_is_shorter_than_possible_is_told():
    _, c = times()
    (problem,) = check_movement(study(*[call("A"), call("B"), call("C")], driving={"kind": "eco", "running_time": c - 40.0}))
    assert told([problem]) == [("faster_than_train", "timetable.trains[x].driving.running_time", "warning")]
    assert missing(problem) == pytest.approx(40.0, abs=0.5)
    assert check_movement(study(call("A"), call("B"), call("C"), driving={"kind": "eco", "running_time": c + 1.0})) == []


def test_many_trains_are_told_once():
    b, _ = times(driving=SLOW)
    due = [60.0 * k + b - 12.0 - 0.5 * k for k in range(20)]
    runs = [
        make_run(f"x{k:02d}", 8.0, calls=[call("A", departure=60.0 * k), call("B", arrival=due[k]), call("C")])
        | {"start": None, "driving": SLOW}
        for k in range(20)
    ]
    (problem,) = check_movement(study(runs=runs))
    assert problem.path == "timetable.trains[x19].driving"
    assert "train x18" in problem.found
    assert "(19 in all)" in problem.found
