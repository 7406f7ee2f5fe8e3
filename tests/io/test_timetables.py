"""Timetables with services, days and turns: read from YAML and CSV, saved, and found in their files again."""

import pytest
from train_study import FILES, write_train_study

from tractionpower.io.scenario_files import load, load_scenario, read_scenario, save_scenario

SERVICES = """format: 1
carry_over: true
services:
  - id: S
    train: local
    route: [{track: "1", from_km: 0.5, to_km: 6.0}]
    first: 06:00
    last: 06:40
    headway_s: 1200
    days: [mon, sat]
    calls: [{station: A, departure: 00:00}, {station: C, arrival: 00:06:30}]
  - id: T
    vehicles: [{id: railcar, count: 2}]
    route: [{track: "2", from_km: 6.0, to_km: 0.5}]
    first: 06:10
    last: 06:50
    headway_s: 1200
    calls: [{station: C, departure: 00:00}, {station: A}]
rotations: [{runs: ["S 06:00", "T 06:10", "S 06:20"], turn_round_s: 60}]
joins: [{portions: ["T 06:30", "T 06:50"], into: "S 06:40", coupling_s: 60}]
splits: [{run: "S 06:20", portions: ["T 06:30", "T 06:50"]}]
"""
DAY = FILES["study.yaml"] + "day: sat\n"


def test_a_service_finds_its_trains_and_vehicles(tmp_path):
    scenario = load(write_train_study(tmp_path, timetable=SERVICES, study=DAY))
    assert [train.id for train in scenario.trains] == ["local"]
    assert [vehicle.id for vehicle in scenario.vehicles] == ["railcar"]
    assert [run.id for run in scenario.runs] == ["S 06:00", "S 06:20", "S 06:40", "T 06:10", "T 06:30", "T 06:50"]


def test_a_train_that_no_file_describes_is_told_at_the_service(tmp_path):
    text = SERVICES.replace("train: local", "train: locl")
    _, problems = read_scenario(write_train_study(tmp_path, timetable=text, study=DAY))
    assert [(each.code, each.path, each.place) for each in problems] == [
        ("unknown_train", "timetable.services[S].train", "timetable.yaml:5")
    ]


def test_saved_and_loaded_it_is_the_same(tmp_path):
    scenario = load(write_train_study(tmp_path / "one", timetable=SERVICES, study=DAY))
    save_scenario(scenario, tmp_path / "two")
    again = load(tmp_path / "two")
    assert again == scenario
    assert again.input_hash == scenario.input_hash
    assert "first: 06:00:00" in (tmp_path / "two" / "timetable.yaml").read_text().replace('"', "")


def test_services_stand_in_a_csv_file(tmp_path):
    table = (
        "id,train,route,first,last,headway_s,days,calls,start_speed_kmh\n"
        "S,local,route.csv,06:00,06:40,1200,mon sat,calls.csv,\n"
        "T,local,route.csv,07:00,07:10,300,,,40\n"
    )
    write_train_study(tmp_path, timetable="format: 1\nservices: services.csv\n", study=DAY)
    (tmp_path / "services.csv").write_text(table)
    (tmp_path / "route.csv").write_text("track,from_km,to_km\n1,0.5,6.0\n")
    (tmp_path / "calls.csv").write_text("station,arrival,departure\nA,,00:00\nC,00:06:30,\n")
    loaded = load_scenario(tmp_path)
    first, second = loaded.scenario.timetable.services
    assert (first.days, first.headway_s, first.calls[1].arrival) == (("mon", "sat"), 1200.0, 390.0)
    assert (second.days, second.start_speed_kmh, second.calls) == (None, 40.0, ())
    assert loaded.provenance.locate("timetable.services[T].last") == "services.csv:3"


@pytest.mark.parametrize(
    ("old", "new", "path", "code"),
    [
        ("last: 06:40", "last: 05:40", "timetable.services[S]", "service"),
        ("headway_s: 1200", "headway_s: 0", "timetable.services[S].headway_s", "out_of_bounds"),
        ("days: [mon, sat]", "days: [monday]", "timetable.services[S].days[0]", "bad_choice"),
        ("first: 06:00", "first: 6am", "timetable.services[S].first", "bad_time"),
        ('runs: ["S 06:00", "T 06:10", "S 06:20"]', 'runs: ["S 06:00"]', "timetable.rotations[0].runs", "too_short"),
    ],
)
def test_bad_input_is_told_with_its_line(tmp_path, old, new, path, code):
    _, problems = read_scenario(write_train_study(tmp_path, timetable=SERVICES.replace(old, new, 1), study=DAY))
    assert [(each.code, each.path) for each in problems] == [(code, path)]
    assert problems[0].place.startswith("timetable.yaml:")
