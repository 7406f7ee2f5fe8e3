"""Trains of a study and of a command: what is read, and what is told of files that are wrong."""

import pytest

from tractionpower.errors import InputError, Problem, UsageError
from tractionpower.io.rolling_stock import load_train, load_vehicle
from tractionpower.io.scenario_files import load_scenario

VEHICLE = "rollingstock/vehicles/{}.yaml"
TRAIN = "rollingstock/trains/{}.yaml"
COACH_FILE, TRAIN_FILE = VEHICLE.format("coach"), TRAIN.format("ic")
ROUTE = "route: [{track: 1, from_km: 0, to_km: 20}], start: {time: 00:01}"


def body(name, extra=""):
    """Return a vehicle file."""
    return (
        f"format: 1\nid: {name}\nkind: locomotive\nmass_t: 80\nlength_m: 19\nmax_speed_kmh: 160\n"
        f"rotating_mass_factor: 1.2\nresistance: {{a_n: 100}}\n{extra}"
    )


def runs(*rows):
    return "format: 1\ntrains:\n" + "".join(f"  - {{{row}}}\n" for row in rows)


@pytest.fixture
def one_of_trains(problems_of_trains):
    def tell(changed):
        problems = problems_of_trains(changed)
        assert len(problems) == 1, problems
        return problems[0]

    return tell


# --- sound files


def test_trains_and_vehicles_of_the_timetable_are_read_once_and_sorted(write_study, with_trains, stock_places):
    rows = [f"id: {name}, train: {train}, {ROUTE}" for name, train in (("3", "z"), ("1", "ic"), ("2", "ic"))]
    rows.append(f"id: 4, vehicles: [{{id: a}}, {{id: coach, load_percent: 50}}], {ROUTE}")
    files = with_trains | {
        "timetable.yaml": runs(*rows),
        TRAIN.format("z"): "format: 1\nid: z\nvehicles: [{id: loco}, {id: coach}, {id: loco}]\n",
        VEHICLE.format("a"): body("a"),
        VEHICLE.format("loco"): body("loco"),
        VEHICLE.format("unused"): "",
    }
    loaded = load_scenario(write_study(files))
    scenario = loaded.scenario
    assert [train.id for train in scenario.trains] == ["ic", "z"]
    assert [vehicle.id for vehicle in scenario.vehicles] == ["a", "coach", "loco"]
    assert [run.id for run in scenario.timetable.trains] == ["3", "1", "2", "4"]
    assert scenario.timetable.trains[3].vehicles[1].load_percent == 50.0
    assert loaded.problems == ()


def test_a_vehicle_comes_from_the_first_place_that_has_it(write_study, with_trains, stock_places):
    del with_trains[COACH_FILE]
    for place, mass in (("ships", 50), ("work", 60)):
        file = stock_places[place] / COACH_FILE
        file.parent.mkdir(parents=True)
        file.write_text(body("coach").replace("80", str(mass)))
        loaded = load_scenario(write_study(with_trains))
        assert loaded.scenario.vehicles[0].mass_t == mass
        assert loaded.provenance.locate("vehicles[coach].mass_t") == f"places/{place}/{COACH_FILE}:4"


DRIVE = """drive:
  kind: series_motors
  motors: 4
  groupings: [{series: 4, parallel: 1}, {series: 2, parallel: 2}]
  starting_current_a: 400
  motor_resistance_ohm: 0.1
  magnetisation: MAGNETISATION
  gear_ratio: 2.0
  wheel_diameter_m: 1.25
  gear_efficiency: 0.97
"""
CURVE = "current_a;emf_vs_per_rev\n100;10,5\n200;20\n"


def test_places_of_values_in_files_of_rolling_stock(write_study, with_trains, stock_places):
    files = with_trains | {
        COACH_FILE: body("coach", DRIVE.replace("MAGNETISATION", "curves/m.csv")),
        "rollingstock/vehicles/curves/m.csv": CURVE,
    }
    loaded = load_scenario(write_study(files))
    assert loaded.scenario.vehicles[0].drive.magnetisation[0].emf_vs_per_rev == 10.5
    for path, place in (
        ("vehicles[coach].drive.magnetisation[1].current_a", "rollingstock/vehicles/curves/m.csv:3"),
        ("vehicles[coach].drive.gear_ratio", f"{COACH_FILE}:16"),
        ("vehicles[0].mass_t", f"{COACH_FILE}:4"),
        ("trains[ic].vehicles[0].id", f"{TRAIN_FILE}:4"),
        ("trains[ic].vehicles[coach].count", f"{TRAIN_FILE}:4"),
        ("timetable.trains[7].calls[1].arrival", "timetable.yaml:8"),
        ("timetable.trains[7].train", "timetable.yaml:4"),
    ):
        assert loaded.provenance.locate(path) == place


def test_trains_routes_and_calls_from_csv(write_study, with_trains, stock_places):
    yaml = load_scenario(write_study(with_trains)).scenario
    files = with_trains | {
        "timetable.yaml": "format: 1\ntrains: tables/trains.csv\n",
        "tables/trains.csv": "id,train,route,calls\n7,ic,route.csv,c7.csv\n",
        "tables/route.csv": "track,from_km,to_km\n1,0,20\n",
        "tables/c7.csv": "station,departure,arrival,stops\nA,00:05:00,,TRUE\nB,,00:20,\n",
    }
    loaded = load_scenario(write_study(files))
    assert loaded.scenario == yaml
    assert loaded.provenance.locate("timetable.trains[7].calls[1].arrival") == "tables/c7.csv:3"
    assert loaded.provenance.locate("timetable.trains[7].train") == "tables/trains.csv:2"


def test_nested_keys_of_a_train_have_dotted_headers(write_study, with_trains, stock_places):
    files = with_trains | {
        "timetable.yaml": "format: 1\ntrains: trains.csv\n",
        "trains.csv": "id,train,route,start.time,start.speed_kmh\n7,ic,route.csv,00:05,108\n",
        "route.csv": "track,from_km,to_km\n1,0,20\n",
    }
    start = load_scenario(write_study(files)).scenario.timetable.trains[0].start
    assert (start.time, start.speed_kmh) == (300.0, 108.0)


# --- files that are wrong


@pytest.mark.parametrize(
    ("text", "code", "path", "line"),
    [
        ("", "empty_file", "vehicles[coach]", ""),
        ("- mass_t: 3\n", "not_a_mapping", "vehicles[coach]", ":1"),
        ("just words\n", "not_a_mapping", "vehicles[coach]", ":1"),
        (body("coach").replace("mass_t: 80", "mass_t: -5"), "out_of_bounds", "vehicles[coach].mass_t", ":4"),
        (body("coach").replace("mass_t: 80", "mass_t: .nan"), "not_finite", "vehicles[coach].mass_t", ":4"),
        (body("coach").replace("mass_t: 80", "mass_t: heavy"), "wrong_type", "vehicles[coach].mass_t", ":4"),
        (body("coach").replace("mass_t", "mas_t"), "unknown_key", "vehicles[coach].mas_t", ":4"),
        (body("coach").replace("kind: loc", "kind: lok"), "bad_choice", "vehicles[coach].kind", ":3"),
        (body("coach", "brake: [1]\n"), "wrong_type", "vehicles[coach].brake", ":9"),
        (body("coach", "brake: {regenerates: no}\n"), "wrong_type", "vehicles[coach].brake.regenerates", ":9"),
        (body("coach").replace("id: coach", "id: wagon"), "wrong_id", "vehicles[coach].id", ":2"),
        (body("coach").replace("id: coach\n", ""), "missing_key", "vehicles[coach].id", ":1"),
        (body("coach").replace("format: 1", "format: 2"), "newer_format", "vehicles[coach].format", ":1"),
        (body("coach", "adhesive_mass_t: 90\n"), "adhesive_mass", "vehicles[coach]", ":1"),
        (body("coach", "mass_t: 3\n"), "duplicate_key", "vehicles[coach].mass_t", ":9"),
    ],
)
def test_one_clear_problem_for_a_bad_vehicle_file(one_of_trains, text, code, path, line):
    problem = one_of_trains({COACH_FILE: text})
    assert (problem.code, problem.path, problem.place) == (code, path, COACH_FILE + line)


@pytest.mark.parametrize(
    ("drive", "code", "key", "told"),
    [
        ("{}", "missing_key", "drive.kind", "inverter | series_motors | table"),
        ("{kind: }", "bad_choice", "drive.kind", "inverter | series_motors | table"),
        ("{kind: inverer, power_kw: -1}", "bad_choice", "drive.kind", "did you mean inverter?"),
        ("{kind: [1]}", "bad_choice", "drive.kind", "inverter | series_motors | table"),
        ("5", "wrong_type", "drive", "a mapping"),
        ("[]", "wrong_type", "drive", "a mapping"),
        ("d.csv", "wrong_type", "drive", "a mapping"),
        ("{FULL, power_kw: 5000, efficency: 0.9}", "unknown_key", "drive.efficency", "efficiency"),
        ("{FULL, power_kw: 0, efficiency: 0.9}", "out_of_bounds", "drive.power_kw", "[kW] above 0"),
        ("{FULL, power_kw: 9}", "efficiency", "drive", ""),
        ("{kind: table, current: t.csv, effort: [{speed_kmh: 0, effort_kn: 1}]}", "too_short", "drive.effort", "at least 2 rows"),
    ],
)  # fmt: skip
def test_one_clear_problem_for_a_bad_drive(problems_of_trains, drive, code, key, told):
    table = "speed_kmh,current_a\n0,10\n100,200\n"
    drive = drive.replace("FULL", "kind: inverter, starting_effort_kn: 300")
    (problem,) = problems_of_trains({COACH_FILE: body("coach", f"drive: {drive}\n"), "rollingstock/vehicles/t.csv": table})
    assert (problem.code, problem.path, problem.place) == (code, f"vehicles[coach].{key}", f"{COACH_FILE}:9")
    assert told in f"{problem.allowed}; {problem.remedy}"


@pytest.mark.parametrize(
    ("curve", "code", "key", "line"),
    [
        (None, "missing_file", ".magnetisation", 15),
        ("current_a,emf\n1,2\n2,3\n", "unknown_column", ".magnetisation", 1),
        (CURVE + "300;x\n", "wrong_type", ".magnetisation[2].emf_vs_per_rev", 4),
        (CURVE + "300\n", "ragged_row", ".magnetisation", 4),
        (CURVE + "-3;1\n", "out_of_bounds", ".magnetisation[2].current_a", 4),
        (CURVE + "150;1\n", "not_rising", "", 9),
    ],
)  # fmt: skip
def test_problems_of_a_curve_in_csv(problems_of_trains, curve, code, key, line):
    drive = body("coach", DRIVE.replace("MAGNETISATION", "m.csv"))
    problems = problems_of_trains({COACH_FILE: drive, "rollingstock/vehicles/m.csv": curve})
    place = f"rollingstock/vehicles/m.csv:{line}" if line < 9 else f"{COACH_FILE}:{line}"
    path = f"vehicles[coach].drive{key}"
    assert (code, path, place) in [(problem.code, problem.path, problem.place) for problem in problems]
    assert len(problems) == (2 if code == "unknown_column" else 1)  # emf_vs_per_rev is missing as well


@pytest.mark.parametrize(
    ("file", "gone", "code", "path", "place"),
    [
        (TRAIN_FILE, "ic", "unknown_train", "timetable.trains[7].train", "timetable.yaml:4"),
        (COACH_FILE, "coach", "unknown_vehicle", "trains[ic].vehicles[coach].id", f"{TRAIN_FILE}:4"),
    ],
)
def test_a_missing_file_is_told_where_it_is_named(one_of_trains, file, gone, code, path, place):
    problem = one_of_trains({file: None, file.replace(gone, gone + "x"): "unread"})
    assert (problem.code, problem.path, problem.place) == (code, path, place)
    assert f"'{gone}'" in problem.found
    assert "the study's folder, the working folder or the data that ship" in problem.allowed
    assert problem.remedy == f"did you mean {gone}x?"


def test_an_unknown_vehicle_is_told_once_for_each_place(problems_of_trains):
    text = "format: 1\nid: ic\nvehicles:\n  - {id: none}\n  - {id: coach}\n  - {id: none}\n"
    timetable = runs(f"id: 1, train: ic, {ROUTE}", f"id: 2, train: ic, {ROUTE}", f"id: 3, vehicles: [{{id: none}}], {ROUTE}")
    problems = problems_of_trains({TRAIN_FILE: text, "timetable.yaml": timetable})
    assert [(problem.path, problem.place) for problem in problems] == [
        ("trains[ic].vehicles[0].id", f"{TRAIN_FILE}:4"),
        ("trains[ic].vehicles[2].id", f"{TRAIN_FILE}:6"),
        ("timetable.trains[3].vehicles[none].id", "timetable.yaml:5"),
    ]


def test_problems_of_all_files_are_told_at_once(problems_of_trains):
    problems = problems_of_trains(
        {
            "timetable.yaml": runs(f"id: 7, train: ic, rout: 3, {ROUTE}", f"id: 8, train: ix, {ROUTE}", "id: 9, train: ic"),
            TRAIN_FILE: "format: 1\nid: ic\nvehicles: [{id: coach, count: 0}, {id: loco}]\n",
            COACH_FILE: body("coach", "colour: red\n"),
            "line.yaml": "stations: 5\n",
        }
    )
    assert {(problem.code, problem.place) for problem in problems} == {
        ("wrong_type", "line.yaml:5"),
        ("unknown_key", "timetable.yaml:3"),
        ("unknown_train", "timetable.yaml:4"),
        ("missing_key", "timetable.yaml:5"),
        ("out_of_bounds", f"{TRAIN_FILE}:3"),
        ("unknown_vehicle", f"{TRAIN_FILE}:3"),
        ("unknown_key", f"{COACH_FILE}:9"),
    }
    assert len(problems) == 7


def test_problems_of_trains_in_csv(problems_of_trains):
    problems = problems_of_trains(
        {
            "timetable.yaml": "format: 1\ntrains: trains.csv\n",
            "trains.csv": "id,train,route,start.time\n7,ic,route.csv,00:05\n8,ic\n9,iic,route.csv,soon\n10,ic,none.csv,0:05\n",
            "route.csv": "track,from_km,to_km\n1,zero,20\n",
        }
    )
    assert [(problem.code, problem.path, problem.place) for problem in problems] == [
        ("ragged_row", "timetable.trains", "trains.csv:3"),
        ("bad_time", "timetable.trains[9].start.time", "trains.csv:4"),
        ("unknown_train", "timetable.trains[9].train", "trains.csv:4"),
        ("missing_file", "timetable.trains[10].route", "trains.csv:5"),
        ("wrong_type", "timetable.trains[7].route[0].from_km", "route.csv:2"),  # once, though it is the route of 9 as well
    ]
    assert problems[1].found == "'soon' in column start.time"
    assert problems[4].found == "'zero' in column from_km"


TABLE_DRIVE = "drive: {kind: table, effort: t.csv, current: t.csv}\n"
TABLE_FILE = "rollingstock/vehicles/t.csv"


@pytest.mark.parametrize(
    ("rows", "code", "line"),
    [
        ("speed_kmh,effort_kn,current_a\n0,200,20\nfast,100,900\n", "wrong_type", 3),
        ("speed_kmh,effort_kn,current_a,power\n0,200,20,1\n60,100,900,1\n", "unknown_column", 1),
        ("speed_kmh,effort_kn,current_a\n0,200,20\n60,100\n90,90,900\n", "ragged_row", 3),
    ],
)
def test_one_file_for_two_tables_is_told_once(one_of_trains, rows, code, line):
    problem = one_of_trains({COACH_FILE: body("coach", TABLE_DRIVE), TABLE_FILE: rows})
    assert (problem.code, problem.place) == (code, f"{TABLE_FILE}:{line}")


def test_checks_of_one_file_for_two_tables_are_told_once(write_study, with_trains, stock_places):
    rows = "speed_kmh,effort_kn,current_a\n0,200,20\n60,100,900\n60,100,900\n"
    loaded = load_scenario(write_study(with_trains | {COACH_FILE: body("coach", TABLE_DRIVE), TABLE_FILE: rows}))
    path = "vehicles[coach].drive"
    twice = [Problem("table_curve", f"{path}.{name}[2].speed_kmh", "two points at 60 km/h") for name in ("effort", "current")]
    other = Problem("table_curve", f"{path}.current[2].current_a", "two points at 60 km/h")
    placed = loaded.provenance.place([*twice, other])
    assert [(item.path, item.place) for item in placed] == [(item.path, f"{TABLE_FILE}:4") for item in (twice[0], other)]
    same_line = [Problem("x", f"timetable.trains[7].calls[{k}].station", "the same") for k in range(2)]
    assert len(loaded.provenance.place(same_line)) == 2  # in YAML each is told


@pytest.mark.parametrize(
    ("row", "code", "path"),
    [
        (f"id: 7, {ROUTE}", "train_run", "timetable.trains[7]"),
        (f"id: 7, train: ic, vehicles: [{{id: coach}}], {ROUTE}", "train_run", "timetable.trains[7]"),
        ("id: 7, train: ic, route: [{track: 1, from_km: 0, to_km: 20}]", "train_run", "timetable.trains[7]"),
        ("id: 7, train: ic, route: [], start: {time: 00:01}", "empty_list", "timetable.trains[7].route"),
        (f"id: 7, train: [], {ROUTE}", "bad_identifier", "timetable.trains[7].train"),
        (f"id: 7, train: ic, calls: [{{station: A, stops: yes}}], {ROUTE}", "wrong_type", "timetable.trains[7].calls[0].stops"),
        ("5", "wrong_type", "timetable.trains[0]"),
    ],
)  # fmt: skip
def test_problems_of_a_run(one_of_trains, row, code, path):
    text = "format: 1\ntrains: [5]\n" if row == "5" else runs(row)
    problem = one_of_trains({"timetable.yaml": text})
    assert (problem.code, problem.path) == (code, path)
    if path.endswith("stops"):
        assert (problem.allowed, "write true or false" in problem.remedy) == ("true or false", True)


# --- for commands


@pytest.fixture
def working_stock(stock_places, with_trains):
    root = stock_places["work"]
    for name in (TRAIN_FILE, COACH_FILE):
        (root / name).parent.mkdir(parents=True)
        (root / name).write_text(with_trains[name])
    return root


def test_a_train_by_name_and_by_path(working_stock):
    for name in ("ic", TRAIN_FILE, working_stock / TRAIN_FILE):
        train, vehicles = load_train(name)
        assert (train.id, [vehicle.id for vehicle in vehicles]) == ("ic", ["coach"])


def test_a_vehicle_stands_for_a_train_of_itself(working_stock):
    for name in ("coach", COACH_FILE):
        train, vehicles = load_train(name)
        assert (train.id, [(part.id, part.count) for part in train.vehicles]) == ("coach", [("coach", 1)])
        assert vehicles == (load_vehicle(name),)


def test_a_file_that_exists_wins(working_stock):
    (working_stock / "ic").write_text("format: 1\nid: another\nvehicles: [{id: coach}]\n")
    assert load_train("ic")[0].id == "another"


def test_a_train_in_a_study_finds_its_vehicles_there(working_stock, monkeypatch, tmp_path):
    file = (working_stock / TRAIN_FILE).absolute()
    monkeypatch.chdir(tmp_path)
    assert load_train(file)[1][0].id == "coach"


@pytest.mark.parametrize("name", ["icc", "", " ", "a\0b", "x" * 5000, "../ic", "no/where.yaml"])
def test_names_that_are_no_train(working_stock, name):
    with pytest.raises(UsageError, match="there is no train"):
        load_train(name)
    with pytest.raises(UsageError, match="there is no vehicle"):
        load_vehicle(name)


def test_an_unknown_train_names_the_nearest(working_stock):
    with pytest.raises(UsageError, match=r"did you mean coach\?; known trains: ic; known vehicles: coach"):
        load_train("coahc")


def test_problems_of_a_named_train_are_told_with_their_places(working_stock):
    (working_stock / COACH_FILE).write_text(body("coach", "colour: red\n"))
    with pytest.raises(InputError) as caught:
        load_train("ic")
    assert [problem.place for problem in caught.value.problems] == [f"{COACH_FILE}:9"]
    (working_stock / TRAIN_FILE).write_text("format: 1\nvehicles: [{id: x}]\n")
    with pytest.raises(InputError) as caught:
        load_train(TRAIN_FILE)
    assert [(problem.code, problem.path) for problem in caught.value.problems] == [
        ("missing_key", "train.id"),
        ("unknown_vehicle", "train.vehicles[x].id"),
    ]
    (working_stock / TRAIN_FILE).write_text("")
    with pytest.raises(InputError, match="the file is empty"):
        load_train(TRAIN_FILE)
