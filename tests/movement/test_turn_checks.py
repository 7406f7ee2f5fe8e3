"""Checks of rotations, joins and splits: each fault at its place, all at once."""

import pytest
from coupled import couple, run, vehicle

from tractionpower.cosimulation.check import check_scenario
from tractionpower.model.timetable import Timetable
from tractionpower.movement.checks import check_movement

VEHICLES = [vehicle("inverter"), vehicle("table", "table")]


def to(name, start, end, departure, arrival, **more):
    """Return a run between two of the stations A, P (km 6), Q (km 13), B (km 20), on track 1 up and track 2 down."""
    km = {"A": 0.0, "P": 6.0, "Q": 13.0, "B": 20.0}
    calls = [{"station": start, "departure": departure}, {"station": end, "arrival": arrival}]
    track = "1" if km[start] < km[end] else "2"
    return run(name, **{"track": track, "low": km[start], "high": km[end], "time": departure, "calls": calls} | more)


OUT, BACK = to("out", "A", "P", 0.0, 300.0), to("back", "P", "A", 600.0, 900.0)
ON, MORE = to("on", "P", "B", 600.0, 1200.0), to("more", "A", "P", 100.0, 400.0)


def study(*runs, day=None, **turns):
    scenario = couple(*runs, end_s=5000.0, vehicles=VEHICLES)
    table = Timetable.model_validate({"trains": list(runs), **turns})
    return scenario.model_copy(update={"timetable": table, "day": day})


def rotation(*names, turn_round_s=120.0, **more):
    return {"rotations": [{"runs": list(names), "turn_round_s": turn_round_s, **more}]}


def told(scenario):
    return [(problem.code, problem.path.removeprefix("timetable."), problem.severity) for problem in check_movement(scenario)]


def test_a_day_of_turns_is_in_order():
    again = to("again", "A", "P", 1200.0, 1500.0)
    scenario = study(OUT, BACK, again, **rotation("out", "back", "again", id="set 1"))
    assert check_scenario(scenario) == []
    joined = study(OUT, MORE, ON, joins=[{"portions": ["out", "more"], "into": "on", "coupling_s": 180.0}])
    assert check_scenario(joined) == []
    split = study(OUT, ON, BACK, splits=[{"run": "out", "portions": ["on", "back"], "uncoupling_s": 180.0}])
    assert check_scenario(split) == []


def test_names_that_are_none_come_together():
    turns = rotation("out", "bakc", "nobody", id="set 1") | {
        "joins": [{"portions": ["out", "x"], "into": "y"}],
        "splits": [{"run": "z", "portions": ["on", "w"]}],
    }
    problems = {
        problem.path: problem for problem in check_movement(study(OUT, BACK, ON, **turns)) if problem.code == "unknown_run"
    }
    assert sorted(problems) == [
        "timetable.joins[0].into",
        "timetable.joins[0].portions[1]",
        "timetable.rotations[set 1].runs[1]",
        "timetable.rotations[set 1].runs[2]",
        "timetable.splits[0].portions[1]",
        "timetable.splits[0].run",
    ]
    assert problems["timetable.rotations[set 1].runs[1]"].remedy == "did you mean back?"
    assert problems["timetable.splits[0].run"].allowed == "back, on, out"


@pytest.mark.parametrize(
    ("turns", "path"),
    [
        ({"rotations": [{"runs": ["out", "back"]}, {"runs": ["out", "on"]}]}, "rotations[1].runs[1]"),
        ({"rotations": [{"runs": ["out", "on"]}, {"runs": ["more", "on"]}]}, "rotations[1].runs[1]"),
        (
            {"rotations": [{"runs": ["out", "back"]}], "joins": [{"portions": ["more", "out"], "into": "on"}]},
            "joins[0].portions[1]",
        ),
        ({"splits": [{"run": "out", "portions": ["on", "on"]}]}, "splits[0].portions[1]"),
        ({"joins": [{"portions": ["out", "out"], "into": "on"}]}, "joins[0].portions[1]"),
    ],
)
def test_a_run_is_named_once_at_either_end(turns, path):
    assert ("turned_twice", path, "error") in told(study(OUT, MORE, BACK, ON, **turns))


def test_a_circle_never_begins():
    # over two rotations, so that neither names a run twice
    turns = {"rotations": [{"runs": ["out", "back"]}, {"runs": ["back", "out"]}]}
    problems = check_movement(study(OUT, BACK, **turns))
    (circle,) = [problem for problem in problems if problem.code == "circular_turns"]
    assert circle.severity == "error"
    assert "out becomes back becomes out" in circle.found or "back becomes out becomes back" in circle.found


def test_a_rotation_that_names_a_run_twice_is_told_once():
    (problem,) = check_movement(study(OUT, BACK, **rotation("out", "back", "out")))
    assert (problem.code, problem.path) == ("circular_turns", "timetable.rotations[0].runs[2]")
    assert problem.found.startswith("the rotation names out twice")


def test_a_join_into_a_run_of_a_rotation_has_one_reason():
    # back comes from out already; it would leave before the portions arrive, and elsewhere
    far = to("far", "A", "Q", 0.0, 800.0)
    wrong = {"joins": [{"portions": ["more", "far"], "into": "back"}]}
    assert told(study(OUT, MORE, far, BACK, **rotation("out", "back"), **wrong)) == [
        ("turned_twice", "joins[0].portions[0]", "error")
    ]


def test_a_rotation_that_leaves_before_it_arrives():
    scenario = study(OUT, to("back", "P", "A", 299.0, 600.0), **rotation("out", "back"))
    (problem,) = check_movement(scenario)
    assert (problem.code, problem.path, problem.severity) == ("leaves_before_arrival", "timetable.rotations[0].runs[1]", "error")
    assert problem.found == "back leaves at 00:04:59, before out, which becomes it, has arrived at 00:05:00"


@pytest.mark.parametrize(("departure", "late"), [(300.0, "120 s"), (419.0, "1 s"), (420.0, None)])
def test_a_turn_round_that_is_too_short(departure, late):
    problems = check_movement(study(OUT, to("back", "P", "A", departure, departure + 300.0), **rotation("out", "back")))
    assert [problem.code for problem in problems] == (["short_turn_round"] if late else [])
    assert late is None or (f"it leaves {late} late" in problems[0].found and problems[0].severity == "warning")


def test_a_train_starts_where_it_has_arrived():
    elsewhere = to("back", "Q", "A", 600.0, 1200.0)
    (problem,) = check_movement(study(OUT, elsewhere, **rotation("out", "back")))
    assert (problem.code, problem.severity) == ("turns_elsewhere", "error")
    assert "out ends on track 1 at km 6.000, back, which it becomes, starts on track 2 at km 13.000" in problem.found


def test_within_its_length_it_may_start_at_its_other_end():
    for km, code in ((5.9, []), (5.8, ["turns_elsewhere"])):  # the train is 100 m long
        other = run("back", track="1", low=km, high=0.0, time=600.0, calls=[{"station": "R", "departure": 600.0}])
        scenario = study(OUT, other, **rotation("out", "back"))
        stations = (*scenario.line.stations, scenario.line.stations[0].model_copy(update={"id": "R", "km": km}))
        line = scenario.line.model_copy(update={"stations": stations})
        assert [each.code for each in check_movement(scenario.model_copy(update={"line": line}))] == code


def test_a_train_that_stands_needs_a_call_to_stand_at():
    bare = run("back", track="2", low=6.0, high=0.0, time=600.0)
    assert told(study(OUT, bare, **rotation("out", "back"))) == [("turn_without_stop", "rotations[0].runs[1]", "error")]
    away = run("out", high=6.0, end="leave")
    assert told(study(away, bare, **rotation("out", "back"))) == []


def test_a_rotation_keeps_its_train_and_portions_need_not():
    other = BACK | {"train": "table"}
    assert told(study(OUT, other, **rotation("out", "back"))) == [("train_changes", "rotations[0].runs[1]", "warning")]
    assert told(study(OUT, other, ON, splits=[{"run": "out", "portions": ["on", "back"]}])) == []


def test_runs_of_another_day():
    turns = rotation("out", "back")
    assert told(study(OUT | {"days": ["mon"]}, BACK, day="tue", **turns)) == [
        ("no_forerunner", "rotations[0].runs[1]", "warning")
    ]
    assert told(study(OUT, BACK | {"days": ["mon"]}, day="tue", **turns)) == []


def test_other_errors_hide_no_turns():
    wrong = OUT | {"calls": [{"station": "A", "departure": 0.0}, {"station": "nowhere", "arrival": 700.0}]}
    codes = [code for code, _, _ in told(study(wrong, BACK, **rotation("out", "back")))]
    assert codes == ["unknown_station", "leaves_before_arrival"]
