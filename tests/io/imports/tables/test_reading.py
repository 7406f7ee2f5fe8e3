"""Timetables of CSV files and workbooks: what is taken over, what is assumed, what is refused and where."""

import re
from datetime import datetime, time, timedelta

import pytest

from tractionpower.cosimulation.check import check_scenario
from tractionpower.errors import UsageError
from tractionpower.io.imports.tables.cell_times import CellTime
from tractionpower.io.imports.tables.matrix_form import Entry, runs_upwards
from tractionpower.io.imports.tables.reading import read_table_timetable
from tractionpower.io.scenario_files import load_scenario
from tractionpower.io.text_files import write_files
from tractionpower.model.line import Station

LONG = (
    "train,station,arrival,departure,min_dwell_s,stops\n"
    "11,A,,06:00:00,,\n"
    "11,B,06:03,06:03:20,20,\n"
    "11,P,06:05,,,no\n"
    "11,C,06:06:30,,,\n"
    "12,Charlie,,06:10,,\n"
    "12,Łódź Bravo,06:13,06:14,,\n"
    "12,Alfa,06:17,,,\n"
)
TRAIN_11 = {
    "id": "11",
    "train": "local",
    "route": [{"track": "1", "from_km": 0.5, "to_km": 6.0}],
    "calls": [
        {"station": "A", "departure": "06:00:00"},
        {"station": "B", "arrival": "06:03:00", "departure": "06:03:20", "min_dwell_s": 20.0},
        {"station": "P", "arrival": "06:05:00", "stops": False},
        {"station": "C", "arrival": "06:06:30"},
    ],
}
TRAIN_12 = {
    "id": "12",
    "train": "local",
    "route": [{"track": "2", "from_km": 6.0, "to_km": 0.5}],
    "calls": [
        {"station": "C", "departure": "06:10:00"},
        {"station": "B", "arrival": "06:13:00", "departure": "06:14:00"},
        {"station": "A", "arrival": "06:17:00"},
    ],
}


def errors(found):
    assert found.texts == {}
    return [problem for problem in found.notes.problems if problem.severity == "error"]


def test_a_row_for_every_call(trains_of):
    assert trains_of(LONG) == [TRAIN_11, TRAIN_12]


def test_the_study_that_is_written_checks_and_has_the_trains(read, study):
    write_files(study, read(LONG).texts)
    loaded = load_scenario(study)
    assert [problem for problem in check_scenario(loaded.scenario) if problem.severity == "error"] == []
    assert [run.id for run in loaded.scenario.runs] == ["11", "12"]
    assert loaded.scenario.runs[0].calls[1].departure == 6 * 3600 + 200


@pytest.mark.parametrize(
    "header",
    [
        "Nr pociągu;Stacja;Przyjazd;Odjazd;Postój [s];Zatrzymanie",
        "Zug-Nr.;Betriebsstelle;Ankunft;Abfahrt;Haltezeit (s);Halt ja/nein",
        "Treno n.;Località;Arrivo;Partenza;Sosta [s];Tipo fermata",
        "Train no.;Stop name;Arr.;Dep.;Dwell [s];Kind",
    ],
)
def test_headings_of_four_languages_semicolons_and_decimal_commas(trains_of, header):
    rows = LONG.replace(",20,", ",20.5,").replace(",", ";").replace("20.5", "20,5").splitlines()[1:]
    first = TRAIN_11 | {"calls": [call | ({"min_dwell_s": 20.5} if "min_dwell_s" in call else {}) for call in TRAIN_11["calls"]]}
    assert trains_of("\n".join([header, *rows])) == [first, TRAIN_12]


def test_a_matrix_with_stations_down(trains_of):
    text = (
        "Rozkład od 2026\nStacja;;11\nAlfa;odj.;06:00:00\nŁódź Bravo;przyj.;06:03\n;odj.;06:03:20\n"
        "Papa;;(06:05)\nCharlie;przyj.;6:06:30\n"
    )
    calls = [{name: value for name, value in call.items() if name != "min_dwell_s"} for call in TRAIN_11["calls"]]
    assert trains_of(text) == [TRAIN_11 | {"calls": calls}]
    down = trains_of(
        {"Mo-Fr": [["Stop", 11.0], ["A", time(6)], ["B", time(6, 3)], ["B", time(6, 3, 20)], ["P", "06:05|"], ["C", "06:06:30"]]}
    )
    assert down == [TRAIN_11 | {"calls": calls}]


def test_a_matrix_with_stations_across(trains_of):
    text = (
        "train,type,days,A dep,B arr,B dep,P,C\n"
        "11,local,Mo-Fr,06:00:00,06:03,06:03:20,|,06:06:30\n"
        "13,LOCAL,daily,07:00,-,-,,07:06:30\n"
    )
    first, second = trains_of(text, train=None)
    assert first["days"] == ["mon", "tue", "wed", "thu", "fri"]
    assert [call["station"] for call in first["calls"]] == ["A", "B", "P", "C"]
    assert first["calls"][2] == {"station": "P", "stops": False}
    assert "days" not in second
    assert second["train"] == "local"
    assert second["calls"][0] == {"station": "A", "departure": "07:00:00"}
    assert {call["station"] for call in second["calls"] if call.get("stops", True)} == {"A", "C"}


UP_AND_DOWN = (
    "Station;;11;12;14\nAlfa;dep;06:00:00;06:17;00:20\nŁódź Bravo;arr;06:03;06:13;\n;dep;06:03:20;06:14;00:01\n"
    "Papa;;(06:05);;\nCharlie;arr;6:06:30;06:10;23:50\n"
)


def test_columns_that_run_upwards_are_read_upwards(read, trains_of):
    down, up, night = trains_of(UP_AND_DOWN)
    assert [call["station"] for call in down["calls"]] == ["A", "B", "P", "C"]
    calls = [{name: value for name, value in call.items() if name != "min_dwell_s"} for call in up["calls"]]
    assert up["route"] == TRAIN_12["route"]
    assert calls == TRAIN_12["calls"]  # arrival 06:13 and departure 06:14 at B, whose row of departures comes first from below
    assert [call["station"] for call in night["calls"]] == ["C", "B", "A"]
    assert (night["calls"][0]["departure"], night["calls"][2]["arrival"]) == ("23:50:00", "24:20:00")
    (note,) = [line for line in read(UP_AND_DOWN).notes.read if "bottom" in line]
    assert note.endswith("read from the bottom to the top, as their times run: '12', '14'")


def test_rows_that_run_from_right_to_left(read, trains_of):
    text = "train,A,B,P,C\n11,06:00,06:03,,06:07\n12,06:17,06:13,,06:10\n"
    assert [[call["station"] for call in train["calls"] if call.get("stops", True)] for train in trains_of(text)] == [
        ["A", "B", "C"],
        ["C", "B", "A"],
    ]
    assert any("from right to left" in line for line in read(text).notes.read)


@pytest.mark.parametrize(
    ("hours", "upwards"),
    [
        ((6, 7, 8), False), ((8, 7, 6), True), ((23, 24, 1), False), ((1, 24, 23), True), ((23.5, 0.5), False),
        ((0.5, 23.5), True), ((6,), False), ((), False), ((6, None, 5), True),
    ],
)  # fmt: skip
def test_the_direction_of_times(hours, upwards):
    stations = [Station(id=f"S{k}", name="S", km=float(k)) for k in range(len(hours))]
    times = [None if hour is None else hour * 3600.0 for hour in hours]
    entries = [Entry((k, 0), station, CellTime(time), "") for k, (station, time) in enumerate(zip(stations, times, strict=True))]
    assert runs_upwards(entries) is upwards


def test_both_forms_tell_the_same(trains_of):
    matrix = {
        "one": [
            ["Zug", None, 11],
            ["A", "ab", time(6)],
            ["B", "an", time(6, 3)],
            [None, "ab", time(6, 4)],
            ["C", "an", time(6, 7)],
        ]
    }
    long = "train,station,arrival,departure\n11,A,,06:00\n11,B,06:03,06:04\n11,C,06:07,\n"
    assert trains_of(matrix) == trains_of(long)


def test_times_of_cells(read, trains_of):
    rows = [
        ["train", "station", "arrival", "departure"],
        [7, "A", None, 0.25],  # a time whose format is lost
        [7, "B", datetime(2026, 5, 4, 6, 3), timedelta(hours=6, minutes=4)],
        [7, "C", "6.07", None],
    ]
    (train,) = trains_of({"one": rows})
    assert [value for call in train["calls"] for key, value in call.items() if key != "station"] == [
        "06:00:00", "06:03:00", "06:04:00", "06:07:00",
    ]  # fmt: skip
    told = " / ".join(read({"one": rows}).notes.assumed)
    assert "1 number without a time format" in told
    assert "1 time with a date" in told
    assert "1 time with a point" in told


def test_past_midnight(read, trains_of):
    text = "train,station,arrival,departure\nN,A,,23:50\nN,B,23:58,00:10\nN,C,00:20,\n"
    (train,) = trains_of(text)
    assert train["calls"][1] == {"station": "B", "arrival": "23:58:00", "departure": "24:10:00"}
    assert train["calls"][2]["arrival"] == "24:20:00"
    assert any("1 train past midnight" in told for told in read(text).notes.assumed)
    beyond = trains_of(
        {
            "one": [
                ["train", "station", "dep", "arr"],
                ["N", "A", "23:50", None],
                ["N", "C", None, timedelta(hours=24, minutes=20)],
            ]
        }
    )
    assert beyond[0]["calls"][1]["arrival"] == "24:20:00"


def test_zero_dwell_is_told_and_can_be_given(read, trains_of):
    text = "train,station,arrival,departure\n7,A,,06:00\n7,B,06:03,06:03\n7,C,06:07,\n"
    assert any("1 stop with equal arrival and departure" in told for told in read(text).notes.assumed)
    (train,) = trains_of(text, dwell_s=30.0)
    assert train["calls"][1]["min_dwell_s"] == 30.0
    assert not any("equal arrival" in told for told in read(text, dwell_s=30.0).notes.assumed)


def test_tracks_by_option_and_by_column(trains_of):
    text = "train,station,arrival,departure,track\n7,A,,06:00,\n7,C,06:07,,{}\n"
    assert trains_of(text.format(""))[0]["route"] == [{"track": "1", "from_km": 0.5, "to_km": 6.0}]
    assert trains_of(text.format(""), tracks="2,1")[0]["route"] == [{"track": "2", "from_km": 0.5, "to_km": 6.0}]
    assert trains_of(text.format("2"))[0]["route"] == [{"track": "2", "from_km": 0.5, "to_km": 6.0}]


def test_onto_a_branch(tmp_path):
    source = tmp_path / "plan.csv"
    source.write_text(
        "train,station,arr,dep\nU,Zachod,,06:00\nU,Lesna,06:20,06:21\nU,Gory,06:30,\nD,Gory,,07:00\nD,Zachod,07:30,\n",
        encoding="utf-8",
    )
    found = read_table_timetable(source, tmp_path / "new", line="y-junction", train="en57")
    write_files(tmp_path / "new", found.texts)
    loaded = load_scenario(tmp_path / "new")
    up, down = loaded.scenario.runs
    assert [(leg.track, leg.from_km, leg.to_km) for leg in up.route] == [("1", 0.5, 12.4), ("3", 14.6, 0.3)]
    assert [(leg.track, leg.from_km, leg.to_km) for leg in down.route] == [("3", 0.3, 14.4), ("2", 12.2, 0.5)]
    assert [p for p in check_scenario(loaded.scenario) if p.severity == "error"] == []
    assert (loaded.scenario.clock.start, loaded.scenario.clock.end) == (5 * 3600, 8 * 3600)


def test_every_problem_at_once_with_its_cell(read):
    text = (
        "train;station;arrival;departure;min_dwell_s;stops;train type\n"
        "11;A;;6 o'clock;;;local\n"
        "11;Bravvo;06:03;06:04;;;\n"
        "11;C;06:06;;-5;perhaps;\n"
        ";C;06:06;;;;\n"
        "12;A;;06:00;;;lokal\n"
        "12;C;05:50;;;;\n"
    )
    found = {(problem.code, problem.path, problem.place) for problem in errors(read(text, train=None))}
    assert found >= {
        ("no_time", "cell D2", "plan.csv:2"),
        ("unknown_station", "cell B3", "plan.csv:3"),
        ("bad_number", "cell E4", "plan.csv:4"),
        ("bad_word", "cell F4", "plan.csv:4"),
        ("empty_cell", "cell A5", "plan.csv:5"),
        ("unknown_train", "cell A6", "plan.csv:6"),
        ("times_fall", "cell B7", "plan.csv:7"),
    }
    told = {problem.code: problem for problem in read(text, train=None).notes.problems}
    assert told["unknown_train"].remedy == "did you mean local?"
    assert "before 06:00:00" in told["times_fall"].found


def test_a_misspelt_station_is_told_once_with_what_is_meant(read):
    rows = "".join(f"{n},Alfa,,06:0{n}\n{n},Charly,06:1{n},\n" for n in range(9))
    (problem, *others) = [p for p in errors(read(f"train,station,arr,dep\n{rows}")) if p.code == "unknown_station"]
    assert others == []
    assert "9 times" in problem.found
    assert problem.remedy == "did you mean Charlie?"


def test_sheets(read, tmp_path, study):
    plan = [["train", "station", "arr", "dep"], ["7", "A", None, "06:00"], ["7", "C", "06:07", None]]
    twice = errors(read({"Mo-Fr": plan, "Sa": plan}))
    assert [problem.code for problem in twice] == ["duplicate_id"]
    assert twice[0].place == "plan.xlsx, sheet Sa:2"
    one = read({"Mo-Fr": plan, "Sa": plan, "notes": [["by the planner"]]}, sheet="Mo-Fr")
    assert "timetable.yaml" in one.texts
    assert len(one.notes.ignored) == 2
    whole = read({"Mo-Fr": plan, "notes": [["by the planner"]]})
    assert whole.notes.ignored == ["plan.xlsx, sheet notes: no timetable"]
    with pytest.raises(UsageError, match="did you mean Mo-Fr"):
        read({"Mo-Fr": plan}, sheet="Mo-fr")


def test_what_is_no_timetable_says_what_one_is(read):
    (problem,) = errors(read("a,b\n1,2\n"))
    assert problem.code == "no_timetable"
    assert "Łódź Bravo" in problem.allowed
    (problem,) = errors(read(""))
    assert problem.code == "empty_file"


def test_a_train_that_turns_round_names_the_place(read):
    (problem,) = errors(read("train,station,arr,dep\n7,A,,06:00\n7,C,06:07,06:10\n7,B,06:13,\n"))
    assert problem.code == "no_way"
    assert problem.path == "cell B4"
    assert re.search("from C on to B .*turning round", problem.found)


def test_nothing_says_what_train_it_is(read):
    (problem,) = errors(read("train,station,arr,dep\n7,A,,06:00\n7,C,06:07,\n", train=None))
    assert problem.code == "no_train_type"
    assert "--train" in problem.remedy


def test_a_line_is_needed(tmp_path):
    (tmp_path / "plan.csv").write_text(LONG, encoding="utf-8")
    with pytest.raises(UsageError, match="--line"):
        read_table_timetable(tmp_path / "plan.csv", tmp_path / "nothing")


def test_trains_outside_the_clock_of_the_study_are_a_warning(read):
    found = read("train,station,arr,dep\n7,A,,12:00\n7,C,12:07,\n")
    (problem,) = found.notes.problems
    assert (problem.code, problem.severity) == ("outside_clock", "warning")
    assert found.texts


HEAD = "train,station,arrival,departure\n"


def test_one_number_for_two_trains(read):
    calls = "11,A,,05:50\n11,C,06:11,\n11,A,,07:50\n11,C,08:11,\n"
    (problem,) = errors(read(HEAD + calls))
    assert (problem.code, problem.place) == ("duplicate_id", "plan.csv:4")
    (back,) = errors(read(HEAD + "11,A,,05:50\n11,C,06:11,06:15\n11,A,06:40,\n"))
    assert back.code == "no_way"  # it turns round


def test_a_station_twice_running(read):
    (problem,) = errors(read(HEAD + "11,A,,05:50\n11,B,06:01,\n11,B,,06:02\n11,C,06:10,\n"))
    assert (problem.code, problem.path) == ("station_twice", "cell B4")
    assert "B twice running" in problem.found


def test_hours_that_cannot_be(read):
    doubt, clock = read(HEAD + "11,A,,41:06\n11,C,41:13,\n").notes.problems
    if doubt.code == "outside_clock":
        doubt, clock = clock, doubt
    assert (doubt.code, doubt.severity, doubt.path) == ("late_in_the_day", "warning", "cell B2")
    assert "41:06:00, which is 17:06:00 a day later" in doubt.found
    jumps = errors(read(HEAD + "11,A,,06:00\n11,B,30:03,30:04\n11,C,06:07,\n"))
    assert {(problem.code, problem.path) for problem in jumps} == {("implausible_time", "cell B3")}
    assert "24.1 h after" in jumps[0].found


def test_remarks_below_a_table(read, trains_of):
    rows = [["train", "station", "arr", "dep"], ["7", "A", None, "06:00"], ["7", "C", "06:07", None], []]
    sheet = {"one": [*rows, ["Uwaga: test"], [None, "second remark"]]}
    assert [train["id"] for train in trains_of(sheet)] == ["7"]
    told = [row for row in read(sheet).notes.ignored if "remark" in row]
    assert told == [
        "plan.xlsx, sheet one:5: 'Uwaga: test', a remark",
        "plan.xlsx, sheet one:6: 'second remark', a remark",
    ]
    # what may be a call whose station was forgotten is none
    for row in (["7"], ["8"]):
        (problem,) = errors(read({"one": [rows[0], rows[1], row, rows[2]]}))
        assert (problem.code, problem.place) == ("empty_cell", "plan.xlsx, sheet one:3")
    (problem,) = errors(read({"one": [*rows, ["7"]]}))
    assert problem.code == "empty_cell"


@pytest.mark.parametrize("name", ["long", "matrix"])
def test_a_formula_without_a_value_is_told_once(read, name):
    long = [["train", "station", "arr", "dep"], ["7", "A", None, "06:00"], ["7", "C", "=C9+1", None]]
    matrix = [["station", "7"], ["A", "06:00"], ["B", "06:03"], ["C", "=B9+1"]]
    (problem,) = errors(read({"one": {"long": long, "matrix": matrix}[name]}))
    assert problem.code == "no_value"


def test_errors_come_in_the_order_of_the_file_and_none_follows_from_another(read):
    rows = "11,A,,05:50\n11,Nowhere,06:01,06:02\n11,B,06:10,06:05\n11,C,06:2x,\n12,A,,6 o'clock\n12,Nowhere,06:10,\n"
    found = [(problem.code, problem.place) for problem in errors(read(HEAD + rows))]
    assert found == [
        ("unknown_station", "plan.csv:3"),
        ("times_fall", "plan.csv:4"),
        ("no_time", "plan.csv:5"),
        ("no_time", "plan.csv:6"),
    ]
