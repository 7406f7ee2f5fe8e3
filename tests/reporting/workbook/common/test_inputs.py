from read_workbook import read_table, texts

from tractionpower.model.line import Station
from tractionpower.model.supply import Substation
from tractionpower.reporting.workbook.common.inputs import in_words


def test_substations_have_all_their_fields_with_units(small, case):
    rows = read_table(small["Inputs study"], 2)
    given = case[1].supply.substations
    assert [(row["id"], row["place [km]"], row["no load voltage [V]"]) for row in rows] == [
        (s.id, s.km, s.no_load_voltage_v) for s in given
    ]
    told = {name for name in Substation.model_fields if any(getattr(s, name) is not None for s in given)}
    assert {"internal_resistance_ohm", "units", "reserve_units"} <= told
    assert "unit_resistance_ohm" not in told  # nobody gives it
    assert len(rows[0]) == len(told)
    assert rows[0]["grid voltage [p.u.]"] == 1


def test_times_of_inputs_are_times(small):
    load = read_table(small["Inputs study"], 6)[0]
    assert (load["id"], load["from"], load["power [kW]"]) == ("depot", 7 * 3600.0, 400)


def test_the_study_tells_clock_and_coupling(small):
    rows = {row["what"]: row["value"] for row in read_table(small["Inputs study"], 1)}
    assert (rows["start"], rows["end"], rows["step [s]"], rows["coupling"]) == ("06:00:00", "06:30:00", 1, "full")


def test_trains_have_their_sums(small):
    (row,) = read_table(small["Inputs stock"], 1)
    assert row["formation"] == "2 × railcar, 50 % loaded"
    assert (row["vehicles"], row["mass with load [t]"], row["inertia [t]"]) == (2, 220, 240)
    assert row["auxiliaries and heating [kW]"] == 100


def test_every_given_figure_of_a_vehicle_is_listed(small):
    rows = {row["quantity"]: row["value"] for row in read_table(small["Inputs stock"], 2)}
    assert rows["drive: starting effort [kN]"] == 100
    assert rows["resistance: c [N/(km/h)²]"] == 0.5
    assert rows["mass [t]"] == 100


def test_the_timetable_has_every_run(small, case):
    rows = read_table(small["Inputs timetable"])
    assert [row["train run"] for row in rows] == [run.id for run in case[1].timetable.trains]
    assert (rows[1]["start"], rows[1]["from"], rows[1]["route"]) == (22050.0, "Łódź Bravo", "track 2, km 40 to 0")


def test_the_source_of_the_line_is_told(small):
    assert "Source: made by hand" in texts(small["Inputs line"])


def test_parts_and_lists_are_words():
    station = Station.model_validate({"id": "A", "km": 1.5, "tracks": ["1", "2"], "stop_km": {"1 increasing": 1.25}})
    assert in_words(station.tracks) == "1, 2"
    assert in_words(station.stop_km) == "1 increasing: 1.25"
    assert in_words(station) == "id A, name , km 1.5, tracks 1, 2, stop km 1 increasing: 1.25"
