from fake_results import changed
from fake_runs import small_run
from fake_sizing import sized
from read_workbook import read_table
from small_studies import load, make_scenario, run_in_memory

from tractionpower.reporting.workbook.common import not_covered


def _subjects(book):
    return {row["subject"]: row for row in read_table(book["Not covered"])}


def test_what_every_study_leaves_out_is_told(small):
    rows = _subjects(small)
    assert {"Harmonics", "Electromagnetic compatibility", "Transients", "Stability of input filters", "Short circuits"} <= set(
        rows
    )
    assert [row["no."] for row in rows.values()] == list(range(1, len(rows) + 1))
    assert "Trains do not see each other" in rows["Signals and other trains"]["not covered"]


def test_ratings_are_said_to_be_missing_only_where_they_are(case, sheets):
    results, scenario = case
    assert "Temperatures and ratings" in _subjects(sheets(not_covered, results, scenario))
    rated = _subjects(sheets(not_covered, sized(results, scenario), scenario))
    assert "Temperatures and ratings" not in rated
    assert "no thermal simulation" in rated["Temperatures"]["what follows for the reader"]


def test_rail_potentials_are_said_to_be_missing_only_where_they_are(case, sheets):
    results, scenario = case
    assert "Rail potentials and stray currents" in _subjects(sheets(not_covered, results, scenario))
    told = {"places": 3, "touch_voltage": [], "stray_current": []}
    rows = _subjects(sheets(not_covered, changed(results, return_circuit=told), scenario))
    assert "Rail potentials and stray currents" not in rows
    assert "Corrosion" in rows


def test_the_grid_is_described_as_it_is(case, sheets):
    results, scenario = case
    assert "whatever is taken from it" in _subjects(sheets(not_covered, results, scenario))["Feeding grid"]["not covered"]
    weak = tuple(each.model_copy(update={"grid_resistance_ohm": 0.01}) for each in scenario.supply.substations)
    supply = scenario.supply.model_copy(update={"substations": weak})
    rows = _subjects(sheets(not_covered, results, scenario.model_copy(update={"supply": supply})))
    assert "behind a constant resistance" in rows["Feeding grid"]["not covered"]


def test_a_network_calculation_tells_nothing_of_trains(sheets):
    scenario = make_scenario(load("depot"))
    results, *_ = run_in_memory(scenario)
    assert "On board" not in _subjects(sheets(not_covered, results, scenario))
    made = small_run()
    assert "On board" in _subjects(sheets(not_covered, made.results, made.scenario))
