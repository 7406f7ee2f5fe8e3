"""Every kind of change, on a small study: what it changes, what it costs, how far it may go."""

import pytest
from coupled import vehicle
from remedy_cases import case_of, planned, small_study

import tractionpower
from tractionpower.model.change import apply_changes
from tractionpower.model.timetable import TrainRun
from tractionpower.studies.remedies.candidate import combined, touch_the_same
from tractionpower.studies.remedies.caps import caps
from tractionpower.studies.remedies.drivings import drivings
from tractionpower.studies.remedies.fleet import Declared, classes_of, declared_of, linked
from tractionpower.studies.remedies.headways import headways
from tractionpower.studies.remedies.reserves import later_calls, reserves
from tractionpower.studies.remedies.shifts import shifts


def by_subject(candidates):
    return {(each.subject, each.step > 0.0): each for each in candidates}


def times(scenario, name):
    run = next(run for run in scenario.runs if run.id == name)
    return [time for call in run.calls for time in (call.arrival, call.departure) if time is not None]


def rotation(*runs):
    return {"timetable": {"rotations": [{"runs": runs, "turn_round_s": 60.0}]}}


def test_a_shift_moves_all_planned_times_by_the_same():
    study = small_study()
    found = by_subject(shifts(case_of(study)))
    assert set(found) == {("X", True), ("X", False), ("Y", True), ("Y", False)}
    later = found["X", True]
    assert [later.size(k) for k in (1, 2)] == [5.0, 10.0]
    changed = apply_changes(study, later.change(45.0))
    assert times(changed, "X") == [time + 45.0 for time in times(study, "X")]
    assert times(changed, "Y") == times(study, "Y")
    assert later.cost(45.0) == 45.0
    assert "X runs 45 s later" in later.tell(45.0)
    earlier = found["Y", False]
    assert times(apply_changes(study, earlier.change(earlier.size(3))), "Y") == [time - 15.0 for time in times(study, "Y")]


def test_a_shift_stays_within_its_bounds_and_within_the_clock():
    found = by_subject(shifts(case_of(small_study(planned("X", 20.0), planned("Y", 840.0, track="2")))))
    assert found["X", True].most == 36  # 180 s
    assert found["X", False].most == 4  # 20 s to the start of the clock
    assert found["Y", True].most == 12  # 60 s from its last call to the end of the clock


def test_runs_of_the_day_before_are_no_further_runs_of_a_service():
    calls = [{"station": "A", "departure": 0.0}, {"station": "B", "arrival": 900.0}]
    first = 23.5 * 3600.0
    trip = {key: value for key, value in planned("X", 0.0).items() if key != "start"}
    service = trip | {"id": "S", "calls": calls, "first": first, "last": first + 3600.0, "headway_s": 1800.0}
    timetable = {"trains": [], "services": [service], "carry_over": True}
    study = small_study(end_s=86400.0, timetable=timetable)
    before = [run.id for run in study.runs if run.id.endswith("(day before)")]
    assert before
    known = declared_of(study)
    assert {run.id for run in known[before[0]].runs} == {run.id for run in study.runs} - set(before)
    assert len(known[before[0]].runs) == 3


def test_a_start_of_its_own_is_moved_too():
    study = small_study(planned("X", 300.0) | {"start": {"time": 300.0, "speed_kmh": 30.0}})
    candidate = by_subject(shifts(case_of(study)))["X", True]
    start = apply_changes(study, candidate.change(10.0)).runs[0].start
    assert (start.time, start.speed_kmh) == (310.0, 30.0)


def test_a_shift_carries_the_rotation_along():
    study = small_study(planned("X", 300.0, arrival=400.0), planned("Y", 900.0, track="2", arrival=400.0), **rotation("X", "Y"))
    found = by_subject(shifts(case_of(study)))
    changed = apply_changes(study, found["X", True].change(30.0))
    assert times(changed, "Y") == [time + 30.0 for time in times(study, "Y")]
    assert found["X", True].cost(30.0) == 60.0
    assert found["Y", True].cost(30.0) == 30.0
    changed = apply_changes(study, found["Y", False].change(-30.0))
    assert times(changed, "X") == [time - 30.0 for time in times(study, "X")]


def test_runs_are_linked_by_rotations_joins_and_splits():
    links = {
        "rotations": [{"runs": ["a", "b"]}],
        "joins": [{"portions": ["b", "c"], "into": "d"}],
        "splits": [{"run": "d", "portions": ["e", "f"]}],
    }
    timetable = small_study(timetable=links).timetable
    assert set(linked(timetable, "a", onwards=True)) == {"b", "d", "e", "f"}
    assert set(linked(timetable, "d", onwards=False)) == {"a", "b", "c"}
    assert linked(timetable, "c", onwards=False) == ()


def test_a_cap_is_a_share_of_what_the_train_draws():
    study = small_study(remedies={"lowest_cap_percent": 60.0, "cap_step_percent": 5.0})
    found = {each.subject: each for each in caps(case_of(study), "current_cap")}
    assert found["X"].most == 8
    changed = apply_changes(study, found["X"].change(25.0))
    assert [run.max_current_a for run in changed.runs] == [750.0, None]
    assert found["X"].cost(25.0) == 25.0
    both = found["trains of type inverter"]
    assert [run.max_current_a for run in apply_changes(study, both.change(10.0)).runs] == [900.0, 900.0]
    assert both.cost(10.0) == 20.0


def test_a_power_cap_starts_from_the_cap_that_there_is():
    study = small_study(planned("X", 300.0, max_power_kw=2000.0), planned("Y", 420.0, track="2"))
    found = {each.subject: each for each in caps(case_of(study), "power_cap")}
    assert apply_changes(study, found["X"].change(10.0)).runs[0].max_power_kw == 1800.0
    assert apply_changes(study, found["Y"].change(10.0)).runs[1].max_power_kw == 2250.0


def test_a_train_of_which_nothing_is_known_gets_no_cap():
    assert list(caps(case_of(small_study(), peaks={}), "current_cap")) == []


def test_classes_are_types_and_categories_of_more_than_one_train():
    vehicles = [vehicle("inverter"), vehicle("table", "table")]
    fast = {"category": "fast"}
    study = small_study(
        planned("X", 0.0, **fast), planned("Y", 0.0, train="table", **fast), planned("Z", 0.0), vehicles=vehicles
    )  # fmt: skip
    classes = classes_of(study, case_of(study).known.values())
    names = {name: [item.name for item in items] for name, items in classes.items()}
    assert names == {"trains of type inverter": ["X", "Z"], "category fast": ["X", "Y"]}


SERVICE = {
    "id": "S",
    "train": "inverter",
    "route": [{"track": "1", "from_km": 0.0, "to_km": 20.0}],
    "headway_s": 600.0,
    "first": 0.0,
    "last": 1800.0,
    "calls": [{"station": "A", "departure": 0.0}, {"station": "B", "arrival": 900.0}],
}


def with_service(**more):
    """Return a study with a service, and what a search knows of it; its four runs are made by hand."""
    study = small_study(end_s=4000.0, timetable={"services": [SERVICE], "trains": []} | more)
    plain = {key: SERVICE[key] for key in ("train", "route")}
    runs = tuple(TrainRun.model_validate(plain | {"id": f"S 00:{k}0", "start": {"time": 600.0 * k}}) for k in range(4))
    item = Declared("S", "timetable.services[S]", study.timetable.services[0], runs)
    delays = {("S 00:10", "B", "arrival"): (20.0,)}
    case = case_of(study, {"S 00:10": 20.0}, culprits=("S 00:10",), delays=delays)
    case.__dict__["known"] = {run.id: item for run in runs}
    return study, case


def test_a_headway_grows_by_steps_and_costs_for_the_runs_that_fall_away():
    study, case = with_service()
    (candidate,) = headways(case)
    assert candidate.most == 20  # half of 600 s in steps of 15 s
    changed = apply_changes(study, candidate.change(150.0)).timetable.services[0]
    assert changed.headway_s == 750.0
    assert candidate.cost(150.0) == 150.0 * 3 + 600.0  # at 0, 750, 1500 s in place of four runs
    assert "every 750 s, 3 in place of 4" in candidate.tell(150.0)


def test_a_service_is_shifted_whole_and_gets_its_reserve_in_its_offsets():
    study, case = with_service()
    later = by_subject(shifts(case))["S", True]
    changed = apply_changes(study, later.change(20.0)).timetable.services[0]
    assert (changed.first, changed.last) == (20.0, 1820.0)
    assert later.cost(20.0) == 80.0
    (reserve,) = reserves(case)
    changed = apply_changes(study, reserve.change(15.0)).timetable.services[0]
    assert [call.arrival for call in changed.calls] == [None, 915.0]
    assert reserve.cost(15.0) == 10.0 * 15.0 * 4


def test_a_service_in_a_rotation_is_left_as_it_is():
    _, case = with_service(rotations=[{"runs": ["S 00:00", "S 00:20"]}])
    assert list(headways(case)) == []
    assert list(shifts(case)) == []


def test_reserve_is_planned_where_the_time_is_lost():
    study = small_study()
    (candidate,) = reserves(case_of(study))
    assert (candidate.subject, candidate.most) == ("X", 60)
    changed = apply_changes(study, candidate.change(20.0))
    assert times(changed, "X") == [300.0, 605.0, 1220.0]
    assert tractionpower.check(changed) == tractionpower.check(study)
    changed = apply_changes(study, candidate.change(10.0))
    assert times(changed, "X") == [300.0, 603.0, 1210.0]  # half of 5 s, to a whole second
    assert candidate.cost(10.0) == 100.0


def test_reserve_of_several_trains_is_shared_by_their_delays():
    study = small_study()
    delays = {("X", "B", "arrival"): (20.0,), ("Y", "B", "arrival"): (10.0,)}
    (candidate,) = reserves(case_of(study, {"X": 20.0, "Y": 10.0}, delays=delays))
    changed = apply_changes(study, candidate.change(30.0))
    assert (times(changed, "X")[-1], times(changed, "Y")[-1]) == (1230.0, 1335.0)
    assert candidate.subject == "late trains"
    assert candidate.cost(30.0) == 10.0 * (30.0 + 15.0)


def test_later_times_keep_their_order_and_the_dwell():
    calls = [
        {"station": "A", "departure": 0.0},
        {"station": "P", "arrival": 300.0, "departure": 330.0, "min_dwell_s": 25.0},
        {"station": "Q", "arrival": 340.0, "stops": False},
        {"station": "B", "arrival": 900.0},
    ]
    study = small_study(planned("X", 0.0) | {"calls": calls})
    item = case_of(study).known["X"]
    changed = apply_changes(study, later_calls(item, [(0.0, 0.0), (20.0, 0.0), (0.0, 0.0), (0.0, 0.0)], 1.0))
    # 25 s after the later arrival the train departs, so the passing behind cannot be before that
    assert times(changed, "X") == [0.0, 320.0, 345.0, 345.0, 900.0]


def test_a_driving_plan_is_for_trains_that_are_on_time():
    study = small_study()
    (candidate,) = drivings(case_of(study))
    assert candidate.subject == "Y"
    driving = apply_changes(study, candidate.change(7.0)).runs[1].driving
    assert (driving.kind, driving.percent) == ("reserve", 7.0)
    assert candidate.cost(7.0) == 7.0


def test_who_is_driven_by_a_plan_keeps_it():
    study = small_study(planned("X", 300.0), planned("Y", 400.0, driving={"kind": "to_time"}))
    assert list(drivings(case_of(study))) == []


def test_two_changes_are_joined_unless_they_name_the_same_value():
    study = small_study()
    case = case_of(study)
    shift, (reserve,) = by_subject(shifts(case))["X", True], reserves(case)
    cap = next(iter(caps(case, "current_cap")))
    assert touch_the_same(shift, reserve)
    assert not touch_the_same(shift, cap)
    pair = combined(shift, 4, cap)
    changed = apply_changes(study, pair.change(10.0))
    assert times(changed, "X") == [time + 20.0 for time in times(study, "X")]
    assert changed.runs[0].max_current_a == 900.0
    assert pair.cost(10.0) == pytest.approx(30.0)
    assert (pair.kind, pair.subject) == ("departure_shift + current_cap", "X + X")
