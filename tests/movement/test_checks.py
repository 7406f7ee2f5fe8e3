"""Checks of the timetable on its line: each fault at its place, none where a train can run."""

import time
from copy import deepcopy
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_trains import KINDS, random_study
from small_trains import BRAKE, INVERTER, SERIES_MOTORS, VEHICLE, call, journey, make_run, make_trains, passing

from tractionpower.cosimulation.check import check_scenario
from tractionpower.model.change import apply_changes
from tractionpower.model.limits import Limit
from tractionpower.model.scenario import Scenario
from tractionpower.movement.checks import check_movement

RESISTANCE = {"resistance": {"a_n": 2000.0}}
STATIONS = {"stations": {"A": 0.0, "B": 4.0, "C": 8.0}}
RUN = "timetable.trains[x]"


def study(**more):
    """Return a scenario with one train that has a resistance, on 10 km with the stations A, B and C."""
    return make_trains(**RESISTANCE | STATIONS | more)


def told(scenario, *, below=RUN):
    """Return the problems as (code, path below `below`, severity)."""
    return [(item.code, item.path.removeprefix(below).removeprefix("."), item.severity) for item in check_movement(scenario)]


def only(scenario):
    (problem,) = check_movement(scenario)
    return problem


def test_a_train_with_calls_is_in_order():
    calls = [call("A", departure="00:01:00"), passing("B", arrival="00:04:00"), call("C", arrival="00:08:00")]
    assert check_scenario(study(calls=calls)) == []


# --- references and identifiers ----------------------------------------------------------------------------------


def test_missing_references_come_together():
    calls = [call("A"), call("Bx"), call("C")]
    scenario = study(calls=calls, runs=[make_run("x", 10.0, calls=calls), make_run("y", 10.0, train="tt")])
    scenario = apply_changes(scenario, ["trains[t].vehicles[0].id=cart"])
    found = {problem.path: problem for problem in check_movement(scenario)}
    assert {path: problem.code for path, problem in found.items()} == {
        "trains[t].vehicles[0].id": "unknown_vehicle",
        f"{RUN}.calls[1].station": "unknown_station",
        "timetable.trains[y].train": "unknown_train",
    }
    assert found["trains[t].vehicles[0].id"].remedy == "did you mean car?"
    assert found[f"{RUN}.calls[1].station"].allowed == "A, B, C"
    assert found["timetable.trains[y].train"].allowed == "t"


def test_where_there_is_nothing_to_name():
    scenario = study(stations={}, calls=[call("A")]).model_copy(update={"trains": ()})
    assert {problem.code: problem.allowed for problem in check_movement(scenario)} == {
        "unknown_train": "there is no train",
        "unknown_station": "there is no station",
    }


def test_problems_of_items_that_share_an_id_stand_at_their_index():
    late = {"calls": [call("B", min_dwell_s=20.0, arrival="00:05:00", departure="00:05:10")]}
    twice = study(runs=[make_run("x", 10.0, **late), make_run("x", 10.0), make_run("y", 10.0)])
    assert told(twice, below="timetable.") == [
        ("duplicate_id", "trains[x]", "error"),
        ("short_dwell", "trains[0].calls[0].departure", "warning"),
    ]
    cars = [VEHICLE | RESISTANCE, VEHICLE | {"resistance": {}}]
    assert told(study(all_vehicles=cars), below="") == [
        ("duplicate_id", "vehicles[car]", "error"),
        ("no_resistance", "vehicles[1].resistance", "warning"),
    ]


def test_what_was_built_past_the_model_is_told_alone():
    scenario = study()
    vehicle = scenario.vehicles[0].model_copy(update={"mass_t": -1.0})
    assert told(scenario.model_copy(update={"vehicles": (vehicle,)}), below="") == [
        ("bad_value", "vehicles[car].mass_t", "error")
    ]


# --- times -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([call("B", arrival="00:09:00", departure="00:08:00")], ("calls[0].departure", "from 00:09:00 on")),
        ([call("B", departure="00:09:00"), call("C", arrival="00:08:00")], ("calls[1].arrival", "from 00:09:00 on")),
        ([passing("B", arrival="00:09:00"), call("C", departure="00:08:00")], ("calls[1].departure", "from 00:09:00 on")),
        ([call("A", departure="00:00:30")], ("calls[0].departure", "from 00:01:00 on")),
        # one slip is told once
        (
            [call("A", departure="00:09:00"), call("B", arrival="00:02:00"), call("C", arrival="00:12:00")],
            ("calls[1].arrival", "from 00:09:00 on"),
        ),
        ([call("B", arrival="23:59:00"), call("C", arrival="24:05:00")], None),
        ([call("B", arrival="00:08:00", departure="00:08:00"), call("C", arrival="00:08:00")], None),
    ],
)
def test_times_run_forward(calls, expected):
    found = [problem for problem in check_movement(study(calls=calls, time="00:01:00")) if problem.code == "times_backwards"]
    assert [(item.path, item.allowed) for item in found] == ([(f"{RUN}.{expected[0]}", expected[1])] if expected else [])


def test_after_midnight_the_hours_go_on():
    calls = [call("B", arrival="23:50:00", departure="00:02:00"), call("C", arrival="00:06:30")]
    found = check_movement(study(calls=calls, time="00:01:00"))
    assert [problem.remedy for problem in found] == [
        "times of the next day go on beyond 24:00:00: write 24:02:00",
        "times of the next day go on beyond 24:00:00: write 24:06:30",
    ]


@pytest.mark.parametrize(
    ("item", "expected"),
    [
        (call("B", arrival="00:08:00", departure="00:08:29", min_dwell_s=30.0), ("short_dwell", "calls[0].departure", "warning")),
        (call("B", arrival="00:08:00", departure="00:08:30", min_dwell_s=30.0), None),
        (passing("B", min_dwell_s=30.0), ("dwell_of_passing", "calls[0].min_dwell_s", "error")),
    ],
)
def test_dwells(item, expected):
    assert told(study(calls=[item], end="leave")) == [expected] * bool(expected)


@pytest.mark.parametrize(("end", "is_told"), [("00:05:00", True), ("00:05:01", False)])
def test_a_run_that_begins_after_the_end_of_the_clock(end, is_told):
    scenario = study(time="00:05:00", clock={"start": "00:00:00", "end": end})
    assert told(scenario) == [("begins_after_end", "start.time", "warning")] * is_told


def test_runs_after_the_end_of_the_clock_are_told_at_once():
    runs = [make_run(str(k), 10.0, time=1800.0) for k in range(3)]
    runs.append({"id": "z", "train": "t", "route": runs[0]["route"], "calls": [call("A", departure="00:30:00"), call("B")]})
    found = only(study(runs=runs[::-1], clock={"end": "00:30:00"}))
    assert found.path == "timetable.trains[z].calls[0].departure"
    assert found.found.endswith("the co-simulation (`run`) leaves it out, `journey` runs it; likewise 0, 1, 2")


NIGHT = {"start": "22:00:00", "end": "26:00:00"}
MORNING = {"start": "06:00:00", "end": "08:00:00"}


@pytest.mark.parametrize(
    ("time", "calls", "clock", "remedy"),
    [
        ("00:30:00", [], NIGHT, "times of the next day go on beyond 24:00:00: write 24:30:00"),
        ("09:59:00", [], NIGHT, "let the clock start earlier, or leave it out"),
        ("10:00:00", [], NIGHT, None),
        ("05:50:00", [], MORNING, None),  # when it ends is not known
        ("05:50:00", [call("A", departure="05:50:00"), call("C")], MORNING, None),
        ("05:50:00", [call("B", arrival="05:55:00"), call("C", arrival="05:59:59")], MORNING, "let the clock start earlier"),
        ("05:50:00", [call("B", arrival="05:55:00"), call("C", arrival="06:00:00")], MORNING, None),
    ],
)
def test_a_run_that_ends_before_the_clock_begins(time, calls, clock, remedy):
    found = check_movement(study(time=time, calls=calls, clock=clock))
    assert [(item.code, item.path, item.severity) for item in found] == [
        ("begins_before_clock", f"{RUN}.start.time", "warning")
    ] * bool(remedy)
    assert all(item.remedy.startswith(remedy) for item in found)


def test_runs_before_the_clock_are_told_at_once():
    found = only(study(runs=[make_run(name, 10.0, time=1800.0) for name in "xyz"], clock=NIGHT))
    assert found.found == ("begins at 00:30:00, the clock starts at 22:00:00: the run should be over by then; likewise y, z")


# --- categories --------------------------------------------------------------------------------------------------


def with_categories(rows, *, train=None, run=None):
    """Return a study whose line has rows of the categories `rows`, beside one of none, with those of train and run."""
    changes = {"trains[t].category": train, "timetable.trains[x].category": run}
    scenario = apply_changes(study(), [f"{path}={name}" for path, name in changes.items() if name is not None])
    limits = scenario.line.speed_limits
    limits += tuple(limits[0].model_copy(update={"category": name}) for name in rows)
    return scenario.model_copy(update={"line": scenario.line.model_copy(update={"speed_limits": limits})})


@pytest.mark.parametrize(
    ("categories", "expected"),
    [
        ({"rows": [], "train": "freight"}, []),
        ({"rows": ["freight", "freight"], "train": "freight"}, []),
        ({"rows": ["freight"], "train": "passenger", "run": "freight"}, []),
        # one slip is told once
        ({"rows": ["fright"], "train": "freight"}, [("line.speed_limits[1].category", "did you mean freight?")]),
        # other trains may run on another day
        ({"rows": ["freight", "work"], "train": "freight"}, []),
        ({"rows": ["freight"]}, []),
        ({"rows": ["freight"], "run": "passenger"}, []),
    ],
)
def test_categories(categories, expected):
    found = check_movement(with_categories(**categories))
    assert [(item.code, item.path, item.severity) for item in found] == [
        ("unused_category", path, "warning") for path, _ in expected
    ]
    assert all(item.remedy.startswith(remedy) for item, (_, remedy) in zip(found, expected, strict=True))


def test_a_train_category_like_one_that_another_train_has():
    runs = [make_run("x", 10.0), make_run("y", 10.0)]
    scenario = apply_changes(study(runs=runs), ["trains[t].category=freight", "timetable.trains[y].category=fright"])
    limits = scenario.line.speed_limits
    limits += (limits[0].model_copy(update={"category": "freight"}),)
    found = only(scenario.model_copy(update={"line": scenario.line.model_copy(update={"speed_limits": limits})}))
    assert (found.path, found.allowed, found.remedy) == (
        "timetable.trains[y].category", "freight", "did you mean freight?"
    )  # fmt: skip


def test_a_knee_of_the_system_that_is_too_low():
    limits = [limit for limit in study().limits if (limit.system, limit.name) != ("dc3000", "knee_factor")]
    low = Limit(system="dc3000", name="knee_factor", value=0.7)
    found = only(study().model_copy(update={"limits": (*limits, low)}))
    assert (found.code, found.path, found.severity) == ("low_knee", "limits[dc3000 knee_factor]", "error")
    own = study(drive=INVERTER | {"knee_factor": 0.9})
    assert check_movement(own.model_copy(update={"limits": (*limits, low)})) == []


# --- routes and calls --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("calls", "code", "path"),
    [
        ([call("B"), call("A"), call("C")], "call_order", "calls[1].station"),
        ([call("A"), call("B"), call("B"), call("C")], "same_call_twice", "calls[2].station"),
        ([call("A"), call("Z"), call("C")], "off_route", "calls[1].station"),
    ],
)
def test_calls_follow_the_route(calls, code, path):
    scenario = study(calls=calls, stations=STATIONS["stations"] | {"Z": 10.5})
    assert told(scenario) == [(code, path, "error")]


def test_all_misplaced_calls_are_told():
    found = told(study(calls=[call("Z"), call("C"), call("A"), call("B")], stations=STATIONS["stations"] | {"Z": -0.5}))
    assert [path for _, path, _ in found] == ["calls[0].station", "calls[2].station", "calls[3].station"]


def test_the_start_is_checked_even_if_calls_are_misplaced():
    found = told(study(calls=[call("C"), call("B")], speed_kmh=170.0))
    assert [item[0] for item in found] == ["call_order", "start_too_fast"]


@pytest.mark.parametrize(
    ("leg", "path"),
    [
        ({"track": "9", "from_km": 0.0, "to_km": 1.0}, "route[1].track"),
        ({"track": "1", "from_km": 4.0, "to_km": 5.0}, "route[1]"),
    ],
)
def test_a_route_that_does_not_connect(leg, path):
    run = make_run("x", 3.0)
    assert told(study(runs=[run | {"route": [*run["route"], leg]}]))[0][1:] == (path, "error")


def test_no_speed_limit_on_the_route():
    found = only(study(limits=[(-1.0, 3.0, 100.0), (4.0, 11.0, 100.0)]))
    assert (found.code, found.path, found.severity) == ("no_speed_limit", f"{RUN}.route", "error")
    assert "km 3 to km 4" in found.found
    assert check_movement(study(length_km=3.0, stations={}, limits=[(-1.0, 3.0, 100.0)])) == []


@pytest.mark.parametrize("end", [None, "leave", "stop", "stay"])
def test_a_run_whose_only_call_is_its_start(end):
    assert check_movement(study(calls=[call("A", departure="00:01:00")], end=end)) == []


def test_a_route_without_contact_line_is_told_once_for_all_runs():
    rows = [{"from_km": -1.0, "to_km": 2.0}, {"from_km": 3.5, "to_km": 11.0}]
    scenario = study(runs=[make_run(name, 10.0) for name in "xyz"] + [make_run("w", 1.5)])
    lines = [row | {"resistance_ohm_per_km": 0.05} for row in rows]
    supply = type(scenario.supply).model_validate(scenario.supply.model_dump(by_alias=True) | {"contact_lines": lines})
    found = only(scenario.model_copy(update={"supply": supply}))
    assert (found.code, found.path, found.severity) == ("no_contact_line", f"{RUN}.route", "error")
    assert found.found == "the train finds no contact line on track 1 from km 2 to km 3.5; likewise trains y, z"
    back = study(runs=[make_run("x", 10.0, backwards=True)], calls=[]).model_copy(update={"supply": supply})
    assert "from km 3.5 to km 2" in only(back).found


def without_power(low, high, **more):
    return study(power_off=[{"from_km": low, "to_km": high, "kind": "neutral"}], **more)


def test_a_stop_in_a_stretch_without_power_is_doubtful():
    calls = [call("A", departure="00:01:00"), call("B", min_dwell_s=20.0), call("C")]
    found = only(without_power(3.9, 4.0 + 1e-6, calls=calls))
    assert (found.code, found.path, found.severity) == ("stop_without_power", RUN, "warning")
    assert "stops at B, on track 1 at km 4," in found.found
    assert "starts from rest" in only(without_power(-0.5, 0.3)).found
    assert "stops at A" in only(without_power(-0.5, 0.3, calls=calls)).found


def test_stops_beside_such_a_stretch_and_ends_in_it_are_in_order():
    calls = [call("A", departure="00:01:00"), call("B", min_dwell_s=20.0), call("C")]
    for low, high in ((1.0, 2.0), (3.0, 4.0), (7.9, 8.1)):
        assert check_movement(without_power(low, high, calls=calls)) == []
    assert check_movement(without_power(3.0, 5.0, calls=[passing("B")])) == []
    assert check_movement(without_power(-0.5, 0.3, speed_kmh=50.0)) == []


# --- start -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("more", "code", "allowed"),
    [
        ({"speed_kmh": 100.0, "limits": [(-1.0, 11.0, 80.0)]}, "start_too_fast", "up to 80 km/h"),
        ({"speed_kmh": 80.0, "limits": [(-1.0, 11.0, 80.0)]}, None, ""),
        ({"speed_kmh": 161.0}, "start_too_fast", "up to 160 km/h"),
        # 0.5 m/s2 over 100 m: v = sqrt(2 0.5 100) = 10 m/s
        ({"speed_kmh": 40.0, "calls": [call("B")], "stations": {"B": 0.1}}, "start_too_fast", "up to 36 km/h"),
        ({"speed_kmh": 36.0, "calls": [call("B")], "stations": {"B": 0.1}}, None, ""),
        ({"speed_kmh": 20.0, "calls": [call("A"), call("B")]}, "start_at_stop", "0"),
        ({"speed_kmh": 20.0, "calls": [passing("A"), call("B")]}, None, ""),
    ],
)
def test_the_speed_at_the_start(more, code, allowed):
    found = [(item.code, item.path, item.allowed.split(",")[0]) for item in check_movement(study(**more))]
    assert found == [(code, f"{RUN}.start.speed_kmh", allowed)] * bool(code)


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ({}, "error"),
        ({"speed_kmh": 50.0}, "warning"),
        ({"slopes": [(-1.0, 11.0, -10.0)]}, "warning"),  # it rolls away: 20 kN down, 2 kN of resistance
        ({"slopes": [(-1.0, 11.0, 10.0)]}, "error"),
    ],
)
def test_a_train_without_drive(more, expected):
    assert told(study(drive=None, **more)) == [("no_drive", "", expected)]


def test_where_a_train_without_drive_comes_to_a_stand():
    # v2 / 2 = 96.45 m2/s2 at 50 km/h; 2 kN on 200 t are 0.01 m/s2: 9645 m
    assert "track 1 at km 9.645 at the latest" in only(study(drive=None, speed_kmh=50.0)).found


# --- climbing, braking, current ----------------------------------------------------------------------------------

STEEP = [(-1.0, 4.0, 0.0), (4.0, 5.0, 80.0), (5.0, 11.0, 0.0)]  # 200 t on 80 per mille: 156.9 kN, and 2 kN of resistance
STRONG, WEAK = INVERTER | {"starting_effort_kn": 160.0}, INVERTER | {"starting_effort_kn": 150.0}

ON_SLOPE = {"stations": {"B": 4.5}, "calls": [call("B")], "end": "leave"}


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ({"drive": STRONG}, None),
        ({"drive": WEAK}, "cannot_start"),  # 8.9 kN over 1 km are 9 MJ, which it has at 34 km/h
        (ON_SLOPE | {"drive": WEAK}, "cannot_climb"),
        # of 100 m of train 50 m stand on the slope: 150 kN beat what they weigh for 44 m only
        ({"drive": WEAK, "stations": {"B": 4.05}, "calls": [call("B")], "end": "leave"}, "cannot_climb"),
        ({"drive": WEAK, "stations": {"B": 3.0}, "calls": [call("B")], "end": "leave"}, "cannot_start"),
        ({"drive": WEAK, "limits": [(-1.0, 4.5, 20.0), (4.5, 11.0, 160.0)]}, "cannot_climb"),
        ({"drive": INVERTER | {"starting_effort_kn": 20.0}}, "cannot_climb"),
        # mu = 0.331: 40 t of adhesive mass give 130 kN, 60 t 195 kN
        (ON_SLOPE | {"drive": STRONG, "adhesive_mass_t": 40.0}, "cannot_climb"),
        (ON_SLOPE | {"drive": STRONG, "adhesive_mass_t": 60.0}, None),
        ({"drive": WEAK, "backwards": True}, None),
        ({"drive": WEAK, "stations": {"B": 4.5}, "calls": [call("B")]}, "cannot_start"),  # it ends there
    ],
)
def test_what_a_train_climbs(more, expected):
    scenario = study(slopes=STEEP, **more)
    found = [item for item in told(scenario) if item[0].startswith("cannot")]
    assert found == [(expected, "", "error" if expected == "cannot_climb" else "warning")] * bool(expected)
    if expected == "cannot_climb":
        assert journey(scenario).status == "stuck"
    else:
        assert journey(scenario).status == "complete"


def test_where_and_why_it_is_stuck():
    found = only(study(slopes=STEEP, drive=WEAK, **ON_SLOPE))
    assert "it starts from rest at B, on track 1 at km 4.5," in found.found
    assert "held back by up to 158.9 kN against an effort of 150.0 kN at most" in found.found
    found = only(study(slopes=STEEP, drive=WEAK, limits=[(-1.0, 4.5, 20.0), (4.5, 11.0, 160.0)]))
    assert "with 20 km/h at most" in found.found


def test_where_it_could_not_start_again():
    runs = [make_run(name, 10.0) for name in "xy"]
    found = only(study(slopes=STEEP, drive=WEAK, runs=runs))
    # the length of 100 m comes onto the slope by and by: 150 of 158.9 kN with 94 m
    assert "on track 1 from km 4.094" in found.found
    assert found.found.endswith("150.0 kN; likewise train y")


def test_series_motors_climb_by_the_current_that_is_held():
    # 4 motors x 90 V s x 3 / (pi 1.25 m) x 300 A x 0.97 = 80 kN: 38.8 per mille and 2 kN
    for permille, is_told in ((39.5, False), (40.5, True)):
        found = told(study(slopes=[(-1.0, 11.0, permille)], drive=SERIES_MOTORS))
        assert [item[0] for item in found] == ["cannot_climb"] * is_told


@pytest.mark.parametrize("seed", range(30))
def test_a_train_that_arrives_was_not_called_stuck(seed):
    scenario = random_study(seed, KINDS[seed % 3])
    scale = np.random.default_rng(seed).uniform(2.0, 12.0)
    rows = [
        f"line.gradients[{k}].permille={max(-100.0, min(100.0, scale * row.permille))}"
        for k, row in enumerate(scenario.line.gradients)
    ]
    scenario = apply_changes(scenario, rows)
    is_told = any(problem.code == "cannot_climb" for problem in check_movement(scenario))
    if is_told:
        assert journey(scenario).status == "stuck"


@pytest.mark.parametrize(("permille", "is_told"), [(45.0, False), (46.5, True)])
def test_service_brakes_that_do_not_hold_the_fall(permille, is_told):
    # 0.5 - 9.80665 i <= 0.05 m/s2 at 45.9 per mille
    scenario = study(slopes=[(-1.0, 11.0, -permille)], brake=BRAKE)
    assert told(scenario) == [("weak_brake", "", "warning")] * is_told


@pytest.mark.parametrize(("amps", "is_told"), [(29.0, True), (31.0, False)])
def test_the_line_allows_less_than_the_auxiliaries_take(amps, is_told):
    rows = [{"from_km": 4.0, "to_km": 5.0, "max_current_a": 800.0, "standstill_current_a": amps}]
    found = check_movement(study(auxiliaries={"power_kw": 90.0}, train_current_limits=rows))
    assert [problem.code for problem in found] == ["no_traction"] * is_told
    if found:
        assert "track 1 from km 4 on" in found[0].found


# --- nothing crashes ---------------------------------------------------------------------------------------------


def rich_study():
    """Return a scenario in which everything is given, as plain data."""
    vehicles = [
        VEHICLE | RESISTANCE | {"brake": BRAKE, "drive": INVERTER | {"max_current_a": 900.0}, "axles": 16, "load_t": 20.0},
        VEHICLE | {"id": "eu", "drive": SERIES_MOTORS | {"starting_resistors_ohm": {"series": [12.0, 0.0]}}},
        VEHICLE | {"id": "coach", "drive": None},
    ]
    calls = [call("A", departure="00:01:00"), passing("B", arrival="00:06:00"), call("C", arrival="00:09:00", min_dwell_s=20.0)]
    runs = [
        make_run("x", 10.0, calls=calls),
        make_run("y", 10.0, backwards=True, speed_kmh=60.0, vehicles=[{"id": "eu"}, {"id": "coach", "count": 4}]),
    ]
    del runs[1]["train"]
    limits = [{"from_km": 3.0, "to_km": 4.0, "max_current_a": 500.0}]
    slopes = [(-1.0, 3.0, 5.0), (3.0, 11.0, -8.0)]
    return make_trains(all_vehicles=vehicles, runs=runs, slopes=slopes, train_current_limits=limits, **STATIONS)


def test_the_study_that_is_mutated_is_in_order():
    assert [problem for problem in check_scenario(rich_study()) if problem.severity == "error"] == []


NUMBERS = st.sampled_from([0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, 4.0, 10.0, 11.0, 55.5, 100.0, 1e-9, 1e9, 3000.0, 86400.0])
WORDS = st.sampled_from(["x", "y", "t", "car", "eu", "coach", "A", "B", "C", "1", "2", "increasing", "none"])
WILD = st.one_of(NUMBERS, WORDS, st.sampled_from([None, True, -3, (), float("nan"), float("inf")]))


def leaves(plain, at=()):
    """Yield the places of all values of plain data: those of scalars and of whole lists."""
    if isinstance(plain, dict):
        for key, value in plain.items():
            yield from leaves(value, (*at, key))
    elif isinstance(plain, list | tuple):
        yield at
        for k, value in enumerate(plain):
            yield from leaves(value, (*at, k))
    else:
        yield at


def thawed(value):
    if isinstance(value, dict):
        return {key: thawed(item) for key, item in value.items()}
    return [thawed(item) for item in value] if isinstance(value, list | tuple) else value


PLAIN = thawed(rich_study().model_dump(by_alias=True))
PLAIN.pop("limits")
PLACES = sorted(leaves(PLAIN), key=str)
MOVING = [place for place in PLACES if place[0] in ("timetable", "trains", "vehicles")]


def mutate(plain, place, how, value):
    owner = plain
    for key in place[:-1]:
        owner = owner[key]
    old = owner[place[-1]]
    if isinstance(old, list):
        owner[place[-1]] = {"double": old + old, "turn": old[::-1], "shorten": old[1:], "set": []}[how]
    elif isinstance(old, float) and how != "set":
        owner[place[-1]] = {"double": 2.0 * old, "turn": -old, "shorten": 0.5 * old}[how]
    else:
        owner[place[-1]] = value


HOW = st.sampled_from(["double", "turn", "shorten", "set"])
CHANGES = st.lists(st.tuples(st.sampled_from(PLACES), HOW, st.one_of(NUMBERS, WORDS, st.none())), min_size=1, max_size=3)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(CHANGES)
def test_no_change_that_the_model_takes_crashes_the_checks(changes):
    for count in range(len(changes), 0, -1):
        plain = deepcopy(PLAIN)
        try:
            for place, how, value in changes[:count]:
                mutate(plain, place, how, value)
            scenario = Scenario.model_validate(plain | {"limits": rich_study().limits})
        except (ValueError, LookupError, TypeError):  # refused by the model, or the place is gone
            continue
        for problem in check_scenario(scenario):
            assert problem.found
            assert problem.path.split(".")[0].split("[")[0] in PLAIN
        return


def rebuilt(model, place, value):
    """Return a declaration with the value at `place` replaced, past its validation."""
    if not place:
        return value
    if isinstance(model, tuple):
        k = place[0]
        return (*model[:k], rebuilt(model[k], place[1:], value), *model[k + 1 :])
    return model.model_copy(update={place[0]: rebuilt(getattr(model, place[0]), place[1:], value)})


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.sampled_from(MOVING), WILD)
def test_no_value_that_slipped_past_the_model_crashes_the_checks(place, value):
    found = check_scenario(rebuilt(rich_study(), place, value))
    assert all(problem.found and problem.path for problem in found)


def test_a_busy_line_is_checked_in_two_seconds():
    rng = np.random.default_rng(4)
    length, count = 224.0, 320
    edges = [-1.0, *np.linspace(0.0, length, count).round(3).tolist(), length + 1.0]
    slopes = [(low, high, float(rng.uniform(-6.0, 6.0))) for low, high in pairwise(edges)]
    names = {f"S{k}": 10.0 + 20.0 * k for k in range(11)}
    calls = [call(name, min_dwell_s=30.0) for name in names]
    ways = [(k % 2 == 1, calls[::-1] if k % 2 else calls) for k in range(150)]
    runs = [make_run(str(k), length, backwards=back, calls=stops, time=60.0 * k) for k, (back, stops) in enumerate(ways)]
    limits = [(low, high, 160.0 - 5.0 * (k % 7)) for k, (low, high, _) in enumerate(slopes)]
    scenario = make_trains(length, runs=runs, slopes=slopes, stations=names, limits=limits, clock={"end": 86400.0}, **RESISTANCE)
    began = time.perf_counter()
    assert check_movement(scenario) == []
    assert time.perf_counter() - began < 2.0
