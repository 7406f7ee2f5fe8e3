"""From a scenario to the tables of the block: ways of routes through spans, entries, devices."""

import itertools

import numpy as np
import pytest
from coupled import couple, run
from small_studies import make_scenario

from tractionpower.cosimulation.tables import compile_scenario, coupling_voltage, lay_ways
from tractionpower.io.library import change

SWITCH = {"connections": [{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 8.0}}]}
TWO_LEGS = [{"track": "1", "from_km": 3.0, "to_km": 8.0}, {"track": "2", "from_km": 8.0, "to_km": 14.0}]
BACK = [{"track": "2", "from_km": 14.0, "to_km": 8.0}, {"track": "1", "from_km": 8.0, "to_km": 3.0}]


def ways_of(scenario, train=0):
    compiled = compile_scenario(scenario)
    fleet = compiled.block.fleet[train]
    return compiled, compiled.block.ways[fleet["first_way"] : fleet["first_way"] + fleet["ways"]]


@pytest.mark.parametrize("route", [TWO_LEGS, BACK])
def test_ways_cover_the_route_without_a_gap(route):
    scenario = couple(run("E", route=route), **SWITCH)
    compiled = compile_scenario(scenario)
    (planned,) = compiled.movement.runs
    ways = lay_ways(planned.path, compiled.supply.stretches)
    assert ways[0].from_m <= 0.0
    assert ways[-1].to_m >= 11000.0
    for before, after in itertools.pairwise(ways):
        assert after.from_m == pytest.approx(before.to_m, abs=1e-6)
    assert {way.stretch.track for way in ways} == {"1", "2"}


@pytest.mark.parametrize("route", [TWO_LEGS, BACK])
def test_the_place_in_a_span_is_that_of_the_kilometre(route):
    """Each end of a way lies where path and stretch both say: metres of the track from the low end of the span."""
    scenario = couple(run("E", route=route), **SWITCH)
    compiled, ways = ways_of(scenario)
    (planned,) = compiled.movement.runs
    laid = lay_ways(planned.path, compiled.supply.stretches)
    for row, way in zip(ways, laid, strict=True):
        for s in np.linspace(max(way.from_m, 0.0), min(way.to_m, 11000.0), 7)[1:-1]:
            _, km = planned.path.place(float(s))
            x_m = row["x_m"] + row["sign"] * (s - row["from_m"])
            assert x_m == pytest.approx(1000.0 * km - way.stretch.from_m, abs=1e-6)
            assert 0.0 <= x_m <= row["length_m"] + 1e-6


def test_trains_enter_by_their_starts_whatever_their_names():
    scenario = couple(run("A", time=300.0), run("B", time=100.0), run("C", time=200.0), run("D", time=100.0))
    assert compile_scenario(scenario).block.entries.tolist() == [1, 3, 2, 0]


def test_each_train_has_a_port_of_its_own_and_routes_are_shared():
    scenario = couple(run("A"), run("B", time=50.0), run("C", "series_motors"), run("D", track="2"))
    block = compile_scenario(scenario).block
    assert len(set(block.fleet["port"].tolist())) == 4
    assert block.fleet["first_way"][0] == block.fleet["first_way"][1] == block.fleet["first_way"][2]
    assert block.fleet["first_way"][3] != block.fleet["first_way"][0]
    ports = block.network.ports[block.fleet["port"]]
    rooms = sorted(zip(ports["first_segment"].tolist(), block.fleet["room"].tolist(), strict=True))
    for (first, room), (following, _) in itertools.pairwise(rooms):
        assert first + room <= following
    assert rooms[-1][0] + rooms[-1][1] <= len(block.network.segments)


@pytest.mark.parametrize(
    ("more", "volts"),
    [
        ({}, None),
        ({"coupling": "constant_voltage"}, 3000.0),
        ({"coupling": "constant_voltage", "coupling_voltage_v": 2850.0}, 2850.0),
    ],
)
def test_the_voltage_of_the_coupling(more, volts):
    scenario = couple(run("A"), step_s=0.5, **more)
    compiled = compile_scenario(scenario)
    assert coupling_voltage(scenario, compiled.supply) == volts
    assert compiled.block.clock.tolist() == [0.0, 0.5, volts or 0.0]


def test_sources_and_loads_keep_their_order_and_times():
    plants = [
        {"id": name, "km": km, "no_load_voltage_v": volts, "internal_resistance_ohm": 0.1} | more
        for name, km, volts, more in (
            ("X", 2.0, 3300.0, {"state": "rectifiers_out"}),
            ("Y", 18.0, 3400.0, {"grid_voltage_pu": 1.02}),
        )
    ]
    loads = [
        {"id": "p", "track": "1", "km": 4.0, "power_kw": 100.0},
        {"id": "q", "track": "2", "km": 5.0, "power_kw": 100.0, "from": 60.0, "to": 90.0},
    ]
    block = compile_scenario(couple(substations=plants, loads=loads)).block
    assert block.sources["port"][0] == -1
    assert block.sources["port"][1] >= 0
    assert block.sources["no_load_v"][1] == pytest.approx(3468.0)
    np.testing.assert_allclose(block.loads["from_s"], [-np.inf, 60.0], atol=1e-6)
    np.testing.assert_allclose(block.loads["to_s"], [np.inf, 90.0], atol=1e-6)


def test_types_of_conductors_reach_the_network_as_resistances():
    line, rails = "supply.contact_lines[0]", "supply.return_circuit[0]"
    none = [f"{line}.resistance_ohm_per_km=null", f"{rails}.resistance_ohm_per_km=null"]
    changed = change(make_scenario(), [*none, f"{line}.type=C120-2C", f"{rails}.rail='60E1'", f"{rails}.wear_percent=10"])
    ohm_per_m = compile_scenario(changed).supply.network.conductors["ohm_per_m"]
    assert set(ohm_per_m[ohm_per_m > 0.0]) == {0.0613 / 1000.0, 0.011 / 0.9 / 2 / 1000.0}
