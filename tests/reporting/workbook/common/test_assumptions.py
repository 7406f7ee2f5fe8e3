import pytest
from fake_results import changed
from fake_sizing import outages
from read_workbook import read_table
from small_studies import load, make_scenario, run_in_memory

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.common import assumptions


def _rows(book):
    return read_table(book["Assumptions"])


def _told(book):
    return {row["assumption"]: row for row in _rows(book)}


def _with(scenario, **parts):
    return scenario.model_copy(update=parts)


def _vehicle(scenario, **more):
    return _with(scenario, vehicles=tuple(vehicle.model_copy(update=more) for vehicle in scenario.vehicles))


def test_they_are_numbered_and_none_stands_twice(small):
    rows = _rows(small)
    assert [row["no."] for row in rows] == list(range(1, len(rows) + 1))
    assert len({row["assumption"] for row in rows}) == len(rows)
    assert all(row["source, status"] for row in rows)


def test_the_coupling_is_that_of_the_run(case, sheets):
    results, scenario = case
    assert any(text.startswith("Full coupling") for text in _told(sheets(assumptions, results, scenario)))
    constant = _told(sheets(assumptions, changed(results, coupling="constant_voltage", coupling_voltage_v=3100.0), scenario))
    assert any("at a constant 3100 V" in text for text in constant)
    assert not any(text.startswith("Full coupling") for text in constant)


def test_overlaps_are_counted_as_the_run_counts_them(small):
    assert "Trains do not see each other and no signal holds them. 2 pairs of them overlap in this run." in _told(small)


@pytest.mark.parametrize(
    ("change", "holds", "not_so"),
    [
        ({"adhesive_mass_t": None}, "No adhesion limit: the adhesive mass is not given.", "Adhesion of dry rails"),
        ({"adhesive_mass_t": 80.0}, "Adhesion of dry rails", "No adhesion limit"),
    ],
)
def test_adhesion_is_told_as_it_is(case, sheets, change, holds, not_so):
    results, scenario = case
    told = _told(sheets(assumptions, results, _vehicle(scenario, **change)))
    (row,) = [row for text, row in told.items() if text.startswith(holds)]
    assert row["where it acts"] == "railcar"
    assert not any(text.startswith(not_so) for text in told)


def test_the_default_knee_is_that_of_the_limits_table(case, sheets):
    results, scenario = case
    (row,) = [
        row
        for text, row in _told(sheets(assumptions, results, scenario)).items()
        if text.startswith("Below 0.9 of the nominal voltage")
    ]
    assert row["source, status"].startswith("recalled from memory; EN 50388")
    (vehicle,) = scenario.vehicles
    given = _vehicle(scenario, drive=vehicle.drive.model_copy(update={"knee_factor": 0.85}))
    assert not any("of the nominal voltage the current falls" in text for text in _told(sheets(assumptions, results, given)))


def test_the_grid_is_infinite_only_where_nothing_is_given(case, sheets):
    results, scenario = case
    stations = scenario.supply.substations
    weak = (stations[0].model_copy(update={"grid_resistance_ohm": 0.0125}), *stations[1:])
    told = _told(sheets(assumptions, results, _with(scenario, supply=scenario.supply.model_copy(update={"substations": weak}))))
    (row,) = [row for text, row in told.items() if "constant resistance of 0.0125 Ω" in text]
    assert row["where it acts"] == stations[0].id
    (row,) = [row for text, row in told.items() if text.startswith("The feeding grid is infinite")]
    assert row["where it acts"] == ", ".join(station.id for station in stations[1:])


def test_limits_of_verdicts_that_nobody_verified_are_assumptions(case, sheets):
    results, scenario = case
    (row,) = [
        row for text, row in _told(sheets(assumptions, results, scenario)).items() if text.startswith(("U_min2 = ", "U_max2 = "))
    ]
    assert "U_min2 = 2000 V (lowest non-permanent voltage)" in row["assumption"]
    assert row["source, status"].startswith("secondary: from a source that quotes it; EN 50163")
    verified = tuple(limit.model_copy(update={"status": "verified"}) for limit in scenario.limits)
    assert not any("U_min2 = 2000 V" in text for text in _told(sheets(assumptions, results, _with(scenario, limits=verified))))


def test_what_sources_call_assumed_is_told_by_sentence(case, sheets):
    results, scenario = case
    source = "Real: mass (a leaflet; page 3). Assumed: running resistance (Davis; wide), brake. Length recalled; power measured."
    rows = [
        row
        for row in _rows(sheets(assumptions, results, _vehicle(scenario, source=source)))
        if row["where it acts"] == "vehicle railcar"
    ]
    assert [row["assumption"] for row in rows] == ["Assumed: running resistance (Davis; wide), brake.", "Length recalled"]


def test_notes_of_the_run_and_the_authors_own_are_there(case, sheets):
    results, scenario = case
    own = ("=cmd() is harmless", "Wet rails are not looked at.")
    rows = _rows(sheets(assumptions, results, scenario, Report(assumptions=own)))
    assert [row["assumption"] for row in rows[-2:]] == [*own]
    notes = [row["assumption"] for row in rows if row["of"] == "notes of the run"]
    assert notes == [*results.run["notes"], results.run["overlaps"]["message"]]


def test_a_network_calculation_assumes_nothing_of_trains(sheets):
    scenario = make_scenario(load("depot"), load("ore", limits="none"), clock={"start": 0.0, "end": 10.0, "warm_up": 2.0})
    results, *_ = run_in_memory(scenario)
    rows = _rows(sheets(assumptions, results, scenario))
    assert "line and trains" not in {row["of"] for row in rows}
    told = {row["assumption"]: row["where it acts"] for row in rows}
    assert told["A network calculation without trains: fixed loads alone take current."] == "network"
    assert next(where for text, where in told.items() if text.startswith("Fixed loads keep their power")) == "depot"
    assert next(where for text, where in told.items() if text.startswith("These loads keep their power")) == "ore"


def test_defaults_are_counted_where_they_act(small, case):
    rows = {(row["of"], row["quantity"]): row for row in read_table(small["Defaults"])}
    adhesion = rows["vehicles: adhesion", "a [km/h]"]
    assert (adhesion["value"], adhesion["source of the default"]) == (7.5, "Curtius and Kniffler, secondary")
    (vehicle,) = case[1].vehicles
    assert ("vehicles", "load [t]") not in rows  # it is given
    assert rows["vehicles: brake", "service rate [m/s²]"]["value"] == vehicle.brake.service_rate_mps2
    stations = len(case[1].supply.substations)
    assert rows["supply: substations", "grid voltage [p.u.]"]["held by"] == f"{stations} of {stations}"
    assert ("supply: substations", "trip delay [s]") not in rows  # no breaker trips


def test_a_study_of_many_cases_speaks_of_its_base(case, sheets):
    results, scenario = case
    base = "What stands here is that of the base case; every other case differs from it in what its changes tell."
    assert base in _told(sheets(assumptions, outages(scenario), scenario))
    assert base not in _told(sheets(assumptions, results, scenario))


def test_nothing_switches_only_where_nothing_can(case, sheets):
    results, scenario = case
    still = "Nothing switches during the run: all devices keep their normal state, and no breaker trips."
    assert still in _told(sheets(assumptions, results, scenario))
    stations = tuple(each.model_copy(update={"trip_current_a": 3000.0}) for each in scenario.supply.substations)
    supply = scenario.supply.model_copy(update={"substations": stations})
    assert still not in _told(sheets(assumptions, results, _with(scenario, supply=supply)))
