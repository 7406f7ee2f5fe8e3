"""Inputs in words: names of paths, values of changes, rows that were cut."""

import json

import pytest
from small_studies import make_scenario

from tractionpower.reporting.facts.input_words import bare_unit, input_in_words, names_of_inputs, value_at, value_in_words


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("supply.substations[Góra.1=x].units_in_service", "substation Góra.1=x: units in service"),
        ("timetable.trains[ic 7].calls[2].departure", "train ic 7: calls, row 3: departure"),
        ("sizing.search.contact_line_points", "sizing: search: contact line points"),
        ("name", "name"),
    ],
)
def test_a_path_is_told_by_what_it_belongs_to(path, words):
    assert input_in_words(path) == words


def test_inputs_that_are_called_alike_keep_their_paths():
    paths = ["supply.loads[a].power_kw", "line.loads[a].power_kw", "supply.loads[b].power_kw"]
    assert list(names_of_inputs(paths).values()) == [*paths[:2], "load b: power [kW]"]
    assert bare_unit("load b: power [kW]") == ("load b: power", "kW")
    assert bare_unit("load b: state") == ("load b: state", "")


def test_a_row_that_was_cut_anywhere_is_told_as_far_as_it_is_whole():
    row = {"id": 'say "x", [y]', "km": 1.25, "calls": [{"at": "A, B", "stops": True}, {"at": "C"}], "last": None}
    text = json.dumps(row)
    assert value_in_words(text) == 'id say "x", [y], km 1.25, calls at A, B, stops yes; at C'
    for length in range(2, len(text)):
        told = value_in_words(text[:length] + "…")
        assert told.endswith("…")
        if length > text.index('"km"'):
            assert told.startswith('id say "x", [y], ')


def test_the_value_of_an_input_is_what_a_change_would_set():
    scenario = make_scenario()
    first, *others = scenario.supply.substations
    assert value_at(scenario, f"supply.substations[{first.id}].km") == str(first.km)
    assert value_at(scenario, "supply.substations[*].km") is None  # they differ
    assert others
    assert value_at(scenario, "supply.substations[*].units") == str(first.units)
    assert value_at(scenario, "supply.substations[*].units_in_service") == str(first.units)  # left out: all of them
    assert value_at(scenario, "supply.contact_lines[0].from_km") == str(scenario.supply.contact_lines[0].from_km)
    assert value_at(scenario, "supply.contact_lines[99].from_km") is None
    assert value_at(scenario, "supply.nothing[x].here") is None
