import json

import pytest
from fake_results import changed
from fake_runs import small_run
from fake_sizing import outages, sized
from read_workbook import read_table, texts

from tractionpower.model.line import Station
from tractionpower.model.supply import Substation
from tractionpower.model.vehicle import Vehicle
from tractionpower.reporting.workbook.common import inputs
from tractionpower.reporting.workbook.common.declared import choices, declared, flat, in_words
from tractionpower.reporting.workbook.common.inputs import used_limits
from tractionpower.reporting.workbook.frame.facts import Facts


def _table_below(sheet, title):
    """Return the rows of the table under a heading."""
    row = next(cell.row for (cell,) in sheet.iter_rows(max_col=1) if cell.value == title)
    starts = sorted((int("".join(filter(str.isdigit, ref.split(":")[0]))), name) for name, ref in sheet.tables.items())
    name = next(name for start, name in starts if start > row)
    return read_table(sheet, int(name.rpartition("_")[2]))


def test_substations_have_the_fields_that_differ_from_defaults(small, case):
    rows = _table_below(small["Inputs supply"], "Substations")
    given = case[1].supply.substations
    assert [(row["id"], row["place [km]"], row["no load voltage [V]"]) for row in rows] == [
        (s.id, s.km, s.no_load_voltage_v) for s in given
    ]
    told = {name for name in Substation.model_fields if any(name in s.model_fields_set for s in given)}
    assert len(rows[0]) == len(told)  # this study gives nothing as it would be by default


def test_what_no_row_gives_is_told_below_with_its_default(small):
    words = " ".join(texts(small["Inputs supply"]))
    assert "Default in every row:" in words
    assert "grid voltage [p.u.] 1" in words
    assert "state in service" in words
    assert "Left out in every row:" in words
    assert "contract power [kW]" in words


def test_times_of_inputs_are_times(small):
    (load,) = _table_below(small["Inputs supply"], "Loads")
    assert (load["id"], load["from"], load["power [kW]"]) == ("depot", 7 * 3600.0, 400)


def test_the_study_tells_clock_and_coupling_and_what_is_default(small):
    rows = {row["quantity"]: (row["value"], row["given / default"]) for row in read_table(small["Inputs study"], 1)}
    assert (rows["start"], rows["end"]) == (("06:00:00", "given"), ("06:30:00", "given"))
    assert rows["step [s]"] == (1, "default")
    assert rows["coupling"] == ("full", "default")
    assert rows["warm up"] == ("–", "left out")


def test_settings_are_those_that_act_in_such_a_run(case, sheets):
    results, scenario = case
    plain = texts(sheets(inputs, results, scenario)["Inputs study"])
    assert "Mean useful voltage" in plain
    assert not {"Outages", "Ratings and mean useful voltage", "Verdict on the timetable"} & {*plain}
    rated = texts(sheets(inputs, sized(results, scenario), scenario)["Inputs study"])
    assert "Ratings and mean useful voltage" in rated
    assert "Search for the least equipment" not in rated
    assert not any(text.startswith("search: ") for text in rated)
    many = texts(sheets(inputs, outages(scenario), scenario)["Inputs study"])
    assert {"Outages", "Verdict on the timetable"} <= {*many}


def test_every_source_is_told(small, case):
    rows = _table_below(small["Inputs study"], "Sources of the inputs")
    assert (rows[0]["input"], rows[0]["source"]) == ("line", case[1].line.source)
    assert {(row["input"], row["which"]) for row in rows[1:]} == {("train", "local"), ("vehicle", "railcar")}
    assert {row["source"] for row in rows[1:]} == {"not told"}


def test_trains_have_their_sums(small):
    (row,) = read_table(small["Inputs trains"], 1)
    assert row["formation"] == "2 × railcar, 50 % loaded"
    assert (row["vehicles"], row["mass with load [t]"], row["inertia [t]"]) == (2, 220, 240)
    assert row["auxiliaries and heating [kW]"] == 100


def test_every_figure_of_a_vehicle_stands_beside_its_default(small, case):
    rows = {row["quantity"]: row for row in read_table(small["Inputs vehicles"], 1)}
    assert rows["drive: starting effort [kN]"]["railcar"] == 100
    assert rows["resistance: c [N/(km/h)²]"]["railcar"] == 0.5
    assert rows["mass [t]"] == {"quantity": "mass [t]", "railcar": 100, "default": "none, to be given"}
    assert (rows["adhesion: a [km/h]"]["railcar"], rows["adhesion: a [km/h]"]["default"]) == (7.5, 7.5)
    assert rows["adhesion: c"]["default"] == 0.161  # a number without a unit
    (vehicle,) = case[1].vehicles
    given = {
        heading for heading, field in flat(vehicle) if field.value not in (None, "", ()) and field.name not in ("id", "source")
    }
    assert given == set(rows)


def test_points_of_curves_are_all_there(sheets):
    made = small_run()
    drive = {
        "kind": "table",
        "effort": [{"speed_kmh": 0.0, "effort_kn": 200.0}, {"speed_kmh": 100.0, "effort_kn": 50.0}],
        "current": [{"speed_kmh": 0.0, "current_a": 300.0}, {"speed_kmh": 100.0, "current_a": 700.0}],
    }
    vehicles = [json.loads(each.model_dump_json()) for each in made.scenario.vehicles]
    for vehicle in vehicles:
        if vehicle["drive"]:
            vehicle["drive"] = drive
    scenario = made.scenario.model_copy(update={"vehicles": tuple(Vehicle.model_validate(each) for each in vehicles)})
    sheet = sheets(inputs, made.results, scenario)["Inputs vehicles"]
    rows = [row for row in _table_below(sheet, "Effort") if row["vehicle"] == vehicles[0]["id"]]
    assert [(row["speed [km/h]"], row["effort [kN]"]) for row in rows] == [(0, 200), (100, 50)]
    shown = {row["quantity"]: row for row in read_table(sheet, 1)}
    assert shown["drive: current"][vehicles[0]["id"]] == "2 points, see below"


def test_the_timetable_has_every_run(small, case):
    rows = read_table(small["Inputs timetable"])
    assert [row["train run"] for row in rows] == [run.id for run in case[1].timetable.trains]
    assert (rows[1]["start"], rows[1]["from"], rows[1]["route"]) == (22050.0, "Łódź Bravo", "track 2, km 40 to 0")


def test_shortest_dwells_are_listed_where_there_are_any(small, case, sheets):
    results, scenario = case
    assert "Shortest dwells" not in texts(small["Inputs timetable"])
    runs = scenario.timetable.trains
    call = runs[1].calls[1].model_copy(update={"min_dwell_s": 45.0})
    held = runs[1].model_copy(update={"calls": (runs[1].calls[0], call)})
    timetable = scenario.timetable.model_copy(update={"trains": (runs[0], held, *runs[2:])})
    sheet = sheets(inputs, results, scenario.model_copy(update={"timetable": timetable}))["Inputs timetable"]
    (row,) = _table_below(sheet, "Shortest dwells")
    assert row == {"train run": held.id, "station": "Alfa", "shortest dwell [s]": 45}


def test_the_source_of_the_line_is_told(small):
    assert "Source: made by hand" in texts(small["Inputs line"])


def test_limits_are_those_that_act_and_tell_whose_they_are(case, sheets):
    results, scenario = case
    own = tuple(
        limit.model_copy(update={"value": 2100.0, "status": "user"})
        if (limit.system, limit.name) == ("dc3000", "u_min2")
        else limit
        for limit in scenario.limits
    )
    changed_limits = scenario.model_copy(update={"limits": own})
    rows = {row["name"]: row for row in read_table(sheets(inputs, results, changed_limits)["Inputs limits"])}
    assert set(rows) == {limit.name for limit in own if limit.system == "dc3000"}
    assert (rows["u_min2"]["value"], rows["u_min2"]["given / default"], rows["u_min2"]["status"]) == (
        2100,
        "given",
        "given by the user",
    )
    assert rows["u_max2"]["given / default"] == "default"


@pytest.mark.parametrize(
    ("run", "prefixes"),
    [
        ({}, set()),
        ({"return_circuit": {"places": 3}}, {"touch", "stray"}),
        ({"kind": "size"}, {"window", "wire"}),
        ({"kind": "contingency"}, {"window", "wire", "grid"}),
    ],
)
def test_limits_of_all_systems_are_told_where_they_act(case, run, prefixes):
    results, scenario = case
    used = used_limits(Facts(changed(results, **run), scenario))
    assert {limit.name.split("_")[0] for limit in used if limit.system == "dc"} == prefixes


def test_parts_and_lists_are_words():
    station = Station.model_validate({"id": "A", "km": 1.5, "tracks": ["1", "2"], "stop_km": {"1 increasing": 1.25}})
    assert in_words(station.tracks) == "1, 2"
    assert in_words(station.stop_km) == "1 increasing: 1.25"
    assert in_words(station) == "id A, km 1.5, tracks 1, 2, stop 1 increasing: 1.25"


def test_only_words_of_the_program_are_taken_for_such():
    fields = {
        field.name: field
        for field in declared(Substation(id="in_service", km=1.0, no_load_voltage_v=3500.0, unit_resistance_ohm=0.1))
    }
    assert fields["state"].shown == "in service"
    assert fields["id"].shown == "in_service"  # a name
    assert choices(Substation.model_fields["state"].annotation) == {"in_service", "rectifiers_out", "bypassed", "open"}
    assert (fields["units"].known, fields["km"].known, fields["duty_class"].known) == ("default", "given", "left out")
