"""A timetable that is faster than its trains is told with the seconds that are missing."""

import re

import pytest
from small_trains import call, journey, make_run, make_trains, passing

from tractionpower.model.driving import Rules
from tractionpower.model.feasibility import Feasibility
from tractionpower.model.timetable import Timetable
from tractionpower.movement.checks import check_movement

STATIONS = {"stations": {"A": 0.0, "B": 4.0, "C": 8.0}}


def study(*calls, **more):
    return make_trains(resistance={"a_n": 2000.0}, calls=list(calls), **STATIONS | more)


def shortest(*names, **more):
    """Return when the train comes to B and C if it waits nowhere [s]."""
    found = journey(study(*names, **more), step_s=0.1)
    return [item.arrival_s for item in found.calls[1:]]


ALONE = [call("A", departure=0.0), call("B"), call("C")]


def tight(missing, **more):
    """Return a study whose first section lacks `missing` seconds."""
    b, c = shortest(*ALONE)
    plan = [call("A", departure=0.0), call("B", arrival=b - missing, departure=b + 30.0), call("C", arrival=c + 30.0 + 5.0)]
    return study(*plan, **more)


@pytest.mark.parametrize(("missing", "is_told"), [(-5.0, False), (0.0, False), (0.5, False), (2.0, True), (25.0, True)])
def test_the_missing_seconds_are_told(missing, is_told):
    problems = check_movement(tight(missing))
    assert [problem.code for problem in problems] == ["faster_than_train"] * is_told
    if is_told:
        assert (problems[0].path, problems[0].severity) == ("timetable.trains[x].calls[1].arrival", "warning")
        seconds = float(problems[0].found.partition(": from A to B")[2].rpartition(": ")[2].removesuffix(" s are missing"))
        assert seconds == pytest.approx(missing, abs=0.3)  # steps of 1 s against steps of 0.1 s


def seconds_of(problem):
    return float(problem.found.partition("planned are ")[2].partition(": ")[2].partition(" s are missing")[0])


def test_each_section_is_told():
    b, c = shortest(*ALONE)
    plan = [call("A", departure=0.0), call("B", arrival=b - 10.0, departure=b - 10.0), call("C", arrival=c - 10.0 - 20.0)]
    first, second = check_movement(study(*plan))
    assert [first.path, second.path] == ["timetable.trains[x].calls[1].arrival", "timetable.trains[x].calls[2].arrival"]
    assert "from A to B" in first.found
    assert "from B to C" in second.found
    assert (seconds_of(first), seconds_of(second)) == (pytest.approx(10.0, abs=0.3), pytest.approx(20.0, abs=0.3))


@pytest.mark.parametrize(("tolerance_s", "is_told"), [(0.0, True), (4.0, True), (6.0, False)])
def test_what_the_study_tolerates_is_not_told(tolerance_s, is_told):
    scenario = tight(5.0).model_copy(update={"feasibility": Feasibility(tolerance_s=tolerance_s)})
    assert [problem.code for problem in check_movement(scenario)] == ["faster_than_train"] * is_told


def test_trains_that_lack_time_on_the_same_section_are_named_once_with_their_seconds():
    (c,) = shortest(call("A"), call("C"))
    runs = [
        make_run(name, 10.0, time=600.0 * k, calls=[call("A", departure=600.0 * k), call("C", arrival=600.0 * k + c - missing)])
        for k, (name, missing) in enumerate({"u": 7.0, "v": 30.0, "w": -5.0}.items())
    ]
    first = {**study(call("A", departure=0.0), call("C", arrival=c - 12.0)).timetable.trains[0].model_dump(by_alias=True)}
    scenario = study(call("A", departure=0.0), call("C", arrival=c))
    problems = check_movement(scenario.model_copy(update={"timetable": Timetable.model_validate({"trains": [first, *runs]})}))
    (problem,) = problems
    assert problem.path == "timetable.trains[v].calls[1].arrival"
    assert problem.found.startswith("faster than train v can: from A to C")
    assert seconds_of(problem) == pytest.approx(30.0, abs=1.1)
    named = dict(re.findall(r"train (\w) \(([\d.]+) s\)", problem.found))
    assert {name: float(value) for name, value in named.items()} == {
        "x": pytest.approx(12.0, abs=1.1), "u": pytest.approx(7.0, abs=1.1),
    }  # fmt: skip


def test_a_dwell_without_planned_times_takes_its_time():
    b, c = shortest(*ALONE)
    ends = [call("A", departure=0.0), call("B", min_dwell_s=40.0), call("C", arrival=c + 39.0)]
    assert check_movement(study(*ends)) == []
    ends[2]["arrival"] = c + 30.0
    (problem,) = check_movement(study(*ends))
    assert "10.0 s are missing" in problem.found or "9." in problem.found
    only_departure = [call("A", departure=0.0), call("B", min_dwell_s=40.0, departure=b + 20.0), call("C", arrival=b + c)]
    (problem,) = check_movement(study(*only_departure))
    assert problem.path == "timetable.trains[x].calls[1].departure"


def test_a_train_may_pass_early():
    """Between a passing that is planned late and the next stop there need not be time for the way."""
    (b, c) = shortest(call("A"), passing("B"), call("C"))
    plan = [call("A", departure=0.0), passing("B", arrival=b + 60.0), call("C", arrival=c + 2.0)]
    assert check_movement(study(*plan)) == []
    plan[1]["arrival"] = b - 10.0
    (problem,) = check_movement(study(*plan))
    assert problem.path == "timetable.trains[x].calls[1].arrival"


def test_alike_runs_are_named_and_a_service_once():
    calls = [call("A", departure=0.0), call("C", arrival=60.0)]
    scenario = study(*calls)
    later = make_run("y", 10.0, time=600.0, calls=[call("A", departure=600.0), call("C", arrival=660.0)])
    first = scenario.timetable.trains[0].model_dump(by_alias=True)
    route = {key: first[key] for key in ("train", "route", "calls")}
    service = route | {"id": "S", "first": 900.0, "last": 3000.0, "headway_s": 300.0}
    table = Timetable.model_validate({"trains": [first, later], "services": [service]})
    problems = check_movement(scenario.model_copy(update={"timetable": table}))
    (problem,) = problems
    assert problem.path == "timetable.services[S].calls[1].arrival"
    told = re.fullmatch(
        r"faster than service S can: .*: (.+ s) are missing; likewise train x \((.+)\), train y \((.+)\)", problem.found
    )
    assert told, problem.found
    assert told[1] == told[2] == told[3]


def test_it_is_told_beside_errors_of_other_runs():
    scenario = tight(20.0)
    broken = make_run("y", 10.0, train="nobody", calls=[call("A", departure=0.0), call("C", arrival=60.0)])
    plain = [scenario.timetable.trains[0].model_dump(by_alias=True), broken]
    problems = check_movement(scenario.model_copy(update={"timetable": Timetable.model_validate({"trains": plain})}))
    assert sorted(problem.code for problem in problems) == ["faster_than_train", "unknown_train"]


def test_the_way_of_driving_does_not_count():
    scenario = tight(-5.0)
    slow = Rules(kind="rules", speed_percent=50.0)
    table = scenario.timetable.model_copy(update={"driving": slow})
    problems = check_movement(scenario.model_copy(update={"timetable": table}))
    assert [problem.code for problem in problems] == ["plan_too_slow"]  # not faster than the train
