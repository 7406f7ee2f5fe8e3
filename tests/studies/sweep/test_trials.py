"""What is told of paths and values before anything runs."""

import pytest
from small_studies import load, make_scenario

from tractionpower.errors import InputError
from tractionpower.io.library import shipped_library
from tractionpower.studies.sweep.cases import as_cases, grid
from tractionpower.studies.sweep.keys import varied_of
from tractionpower.studies.sweep.trials import try_cases

BASE = make_scenario(load("tap"))
A = "supply.substations[A]"


def tried(vary):
    return try_cases(BASE, shipped_library(), as_cases(grid(varied_of(vary))))


def test_all_paths_that_do_not_exist_are_told_with_the_nearest_that_does():
    with pytest.raises(InputError) as raised:
        tried({"supply.substation[A].units": [1, 2], f"{A}.unit_count": [3], f"{A}.km": [0.0, 1.0]})
    found = {problem.path: problem.remedy for problem in raised.value.problems}
    assert set(found) == {"supply.substation[A].units", f"{A}.unit_count"}
    assert "'substations'" in found["supply.substation[A].units"]


def test_a_path_refused_with_every_value_stops_the_sweep_with_what_is_said_of_it():
    with pytest.raises(InputError) as raised:
        tried({"supply.section_cabins[C].state": ["upside", "down"], f"{A}.km": [0.0]})
    assert any("upside" in problem.found for problem in raised.value.problems)


def test_a_value_that_is_refused_among_others_is_no_error():
    assert tried({"supply.section_cabins[C].state": ["upside", "open"], f"{A}.km": [-1e6, 0.0]}) == []


def test_changes_that_hold_together_only_are_tried_together():
    vary = {"supply.loads[tap].power_kw": [None], "supply.loads[tap].current_a": [100.0, 200.0]}
    assert tried(vary) == []
    with pytest.raises(InputError):
        tried({"supply.loads[tap].current_a": [100.0, 200.0]})


@pytest.mark.parametrize("path", [f"{A}.units", "supply.substations[*].units", "supply.substations[0].units"])
def test_units_that_change_nothing_are_warned_of(path):
    warnings = tried({path: [1, 2]})
    assert {problem.code for problem in warnings} == {"units_without_effect"}
    assert all(problem.severity == "warning" for problem in warnings)
    assert tried({f"{A}.grid_voltage_pu": [0.9, 1.0]}) == []
