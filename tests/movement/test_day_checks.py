"""Checks of services and days: told once, where they are declared."""

import pytest
from coupled import couple, run, vehicle

from tractionpower.model.change import apply_changes
from tractionpower.model.timetable import Timetable
from tractionpower.movement.checks import check_movement

ROUTE = [{"track": "1", "from_km": 0.0, "to_km": 20.0}]
CALLS = [{"station": "A", "departure": "00:00"}, {"station": "P", "arrival": "00:06", "departure": "00:06:30"}, {"station": "B"}]


def service(name="S", **more):
    plain = {
        "id": name,
        "train": "inverter",
        "route": ROUTE,
        "first": "05:10",
        "last": "06:10",
        "headway_s": 600.0,
        "calls": CALLS,
    }
    return plain | more


def study(*services, trains=(), day=None, clock=(18000.0, 25000.0), **more):
    scenario = couple(end_s=10.0, vehicles=[vehicle("inverter")])
    table = Timetable.model_validate({"services": list(services), "trains": list(trains), **more})
    changed = {"start": clock[0], "end": clock[1]}
    return scenario.model_copy(update={"timetable": table, "day": day, "clock": scenario.clock.model_copy(update=changed)})


def told(scenario):
    return [(problem.code, problem.path, problem.severity) for problem in check_movement(scenario)]


def test_a_service_is_in_order():
    assert told(study(service())) == []


def test_problems_of_a_service_are_told_once_where_it_is_declared():
    wrong = [CALLS[0], CALLS[1] | {"arrival": "00:07"}, {"station": "Bx", "arrival": "00:01"}]
    slips = service(calls=wrong, train="none", start_speed_kmh=500.0)
    assert told(study(slips)) == [
        ("unknown_train", "timetable.services[S].train", "error"),
        ("unknown_station", "timetable.services[S].calls[2].station", "error"),
        ("times_backwards", "timetable.services[S].calls[1].departure", "error"),
        ("times_backwards", "timetable.services[S].calls[2].arrival", "error"),
    ]
    (found,) = [each for each in check_movement(study(slips)) if each.path.endswith("calls[1].departure")]
    assert found.found == "00:06:30, before the arrival at P, 00:07:00"  # counted from the start, as in the file


def test_keys_that_a_service_calls_otherwise():
    passing = [{"station": "P", "stops": False}]
    assert told(study(service(start_speed_kmh=500.0, calls=passing))) == [
        ("start_too_fast", "timetable.services[S].start_speed_kmh", "error")
    ]
    assert told(study(service(), clock=(0.0, 3600.0))) == [("begins_after_end", "timetable.services[S].first", "warning")]


def test_a_clock_may_leave_out_some_runs_of_a_service():
    assert told(study(service(), clock=(20000.0, 20060.0))) == []
    assert told(study(service(calls=CALLS[:2]), clock=(36000.0, 40000.0)))[0][:2] == (
        "begins_before_clock",
        "timetable.services[S].first",
    )


def test_names_that_clash():
    train = run("S 05:20", time=19200.0)
    assert told(study(service(), trains=[train]))[0] == ("duplicate_id", "timetable.services[S].id", "error")
    codes = told(study(service(), service()))
    assert ("duplicate_id", "timetable.services[S]", "error") in codes
    twice = study(trains=[train, train])
    assert told(twice)[0] == ("duplicate_id", "timetable.trains[S 05:20]", "error")


@pytest.mark.parametrize("more", [{"services": [service(days=["mon"])]}, {"trains": [run("x", time=19000.0, days="mon fri")]}])
def test_days_need_a_day(more):
    services, trains = more.get("services", ()), more.get("trains", ())
    problems = check_movement(study(*services, trains=trains))
    assert [(each.code, each.path, each.severity) for each in problems] == [("no_day", "day", "error")]
    assert "write day: mon in study.yaml" in problems[0].remedy
    assert told(study(*services, trains=trains, day="mon")) == []
    assert told(study(*services, trains=trains, day="tue")) == [("nothing_runs", "day", "warning")]


def test_times_of_day_in_a_service():
    calls = [{"station": "A", "departure": "05:10"}, {"station": "B"}]
    assert told(study(service(calls=calls), clock=(18000.0, 90000.0))) == [
        ("times_of_day", "timetable.services[S].calls[0]", "warning")
    ]


def test_too_many_runs():
    assert told(study(service(last="24:00", headway_s=1.0)))[0] == (
        "too_many_runs", "timetable.services[S].headway_s", "error",
    )  # fmt: skip


def test_a_change_by_path_reaches_the_runs():
    scenario = apply_changes(study(service()), ["timetable.services[S].headway_s=1800", "timetable.services[S].train=inverter"])
    assert [each.id for each in scenario.runs] == ["S 05:10", "S 05:40", "S 06:10"]
    turns = study(service(), rotations=[{"runs": ["S 05:10", "S 05:20"], "turn_round_s": 0.0}])
    assert apply_changes(turns, ["timetable.rotations[0].turn_round_s=60"]).timetable.rotations[0].turn_round_s == 60.0


def test_a_train_that_only_the_day_before_runs_is_checked():
    late = {"days": ["sun"], "time": 85000.0, "calls": [{"station": "Bx", "arrival": 87000.0}]}
    scenario = study(trains=[run("x", **late)], day="mon", carry_over=True, clock=(0.0, 3600.0))
    assert told(scenario) == [("unknown_station", "timetable.trains[x].calls[0].station", "error")]
