"""Routes that leave the contact lines."""

import pytest
from small_trains import make_run, make_trains

from tractionpower.cosimulation.check import check_scenario


def with_contact(*stretches, **more):
    """Return a scenario whose contact lines are `stretches` (from km, to km) of a line from km -1 to km 11."""
    scenario = make_trains(10.0, **more)
    rows = [
        type(scenario.supply.contact_lines[0])(from_km=low, to_km=high, resistance_ohm_per_km=0.05) for low, high in stretches
    ]
    supply = scenario.supply.model_copy(update={"contact_lines": tuple(rows)})
    return scenario.model_copy(update={"supply": supply})


def gaps_told(scenario):
    return [(p.path, p.found) for p in check_scenario(scenario) if p.code == "route_without_contact_line"]


def test_a_whole_contact_line_is_in_order():
    assert gaps_told(with_contact((-1.0, 11.0))) == []
    assert gaps_told(with_contact((-1.0, 4.0), (4.0, 11.0))) == []


@pytest.mark.parametrize("backwards", [False, True])
def test_a_route_that_leaves_it_is_told_with_its_kilometres(backwards):
    ((path, found),) = gaps_told(with_contact((-1.0, 8.5), backwards=backwards))
    assert path == "timetable.trains[0].route"
    ends = ("10", "8.5") if backwards else ("8.5", "10")
    assert found == f"no contact line on track 1 from km {ends[0]} to km {ends[1]}"


def test_a_run_that_ends_before_the_gap_is_in_order():
    stop = {"stations": {"Z": 5.0}, "calls": [{"station": "Z"}]}
    assert gaps_told(with_contact((-1.0, 6.0), **stop)) == []
    assert len(gaps_told(with_contact((-1.0, 4.0), **stop))) == 1


def test_a_route_is_told_of_once():
    runs = [make_run(name, 10.0, time=600.0 * k) for k, name in enumerate("abc")]
    assert len(gaps_told(with_contact((-1.0, 8.5), runs=runs))) == 1
