"""From the declared supply to tables: names, ports, feeders, grounds, shared nodes."""

import numpy as np
import pytest
from solved import LIMITS, Solved, seed_network, single_line, tap

from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S, new_work
from tractionpower.model.earthing import Earthing, VoltageLimitingDevice, VoltageTime
from tractionpower.model.line import ChainageBreak, Line, Track
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionPoint
from tractionpower.model.switchgear import Feeder
from tractionpower.supply.compile import compile_network


def changed(network, **more):
    supply, line = network
    return supply.model_copy(update=more), line


def with_states(states):
    supply, line = seed_network([tap("T", 4.0, kw=1000.0)])
    stations = tuple(s.model_copy(update={"state": state}) for s, state in zip(supply.substations, states, strict=True))
    return supply.model_copy(update={"substations": stations}), line


def test_ports_are_sources_then_loads_by_identifier():
    tables = compile_network(*seed_network([tap("z", 3.0, kw=1.0), tap("b", 4.0, kw=1.0), tap("m", 5.0, kw=1.0)]), LIMITS)
    assert [s.id for s in tables.substations] == ["A", "B"]
    assert tables.source_port.tolist() == [0, 1]
    assert [load.id for load in tables.loads] == ["b", "m", "z"]
    assert tables.load_port.tolist() == [2, 3, 4]
    assert tables.network.ports["x_m"][2:5].tolist() == pytest.approx([4000.0, 5000.0, 3000.0])
    assert tables.network.ports["demand"][:5].tolist() == [False, False, True, True, True]


@pytest.mark.parametrize(
    ("state", "port", "busbar"),
    [("in_service", 0, True), ("rectifiers_out", -1, True), ("bypassed", -1, False), ("open", -1, False)],
)
def test_states_of_a_substation(state, port, busbar):
    tables = compile_network(*with_states([state, "in_service"]), LIMITS)
    assert tables.source_port[0] == port
    assert bool(np.all(tables.busbar[0] >= 0)) is busbar
    assert {link.station for link in tables.links if link.closed} == ({"A", "B", "C"} if busbar else {"B", "C"})
    assert {link.station for link in tables.links} == {"A", "B", "C"}  # in every state the same are listed


def test_links_are_those_of_substations_then_of_cabins():
    tables = compile_network(*seed_network(), LIMITS)
    names = [(link.kind, link.station, link.track, link.side) for link in tables.links]
    assert names == [
        ("feeder", "A", "1", "high_km"), ("feeder", "A", "2", "high_km"),
        ("feeder", "B", "1", "low_km"), ("feeder", "B", "2", "low_km"),
        ("cabin", "C", "1", "low_km"), ("cabin", "C", "1", "high_km"),
        ("cabin", "C", "2", "low_km"), ("cabin", "C", "2", "high_km"),
    ]  # fmt: skip


@pytest.mark.parametrize("ohm", [0.0, 0.01])
def test_feeder_currents_add_up_to_the_source(ohm):
    solved = Solved(*seed_network([tap("T", 4.0, kw=3000.0), tap("U", 13.0, track="2", kw=1000.0)], feeder_resistance_ohm=ohm))
    currents = solved.links
    sums = {"A": 0.0, "B": 0.0, "C": 0.0}
    for link in solved.tables.links:
        sums[link.station] += currents[link.id]
    assert sums.pop("C") == pytest.approx(0.0, abs=1e-5)
    assert sums == {name: pytest.approx(-solved.i[name], abs=1e-5) for name in "AB"}


def test_the_negative_busbar_is_ground():
    tables = compile_network(*seed_network(return_resistance_ohm=0.02), LIMITS)
    assert tables.busbar[0, 1] == tables.network.nodes
    assert tables.busbar[1, 1] < tables.network.nodes


def test_devices_less_than_a_metre_apart_share_a_node():
    near = Solved(*single_line([tap("x", 10.0, kw=2000.0), tap("y", 10.0009, kw=2000.0), tap("z", 10.0021, kw=2000.0)]))
    assert near.u["x"] == near.u["y"]
    assert near.u["x"] != near.u["z"]
    end = Solved(*single_line([tap("x", 0.0005, kw=2000.0), tap("y", 19.9995, kw=1000.0)]))
    assert (end.u["x"], end.u["y"]) == (end.u["A"], end.u["B"])


def test_zero_resistance_needs_no_edges():
    assert len(compile_network(*seed_network(), LIMITS).edges) == 0
    edges = compile_network(*seed_network(feeder_resistance_ohm=0.02, return_resistance_ohm=0.04), LIMITS).edges
    assert sorted(edges["conductance_s"].tolist()) == pytest.approx([25.0, 25.0, 50.0, 50.0, 50.0, 50.0])


def test_chainage_breaks_shorten_the_line():
    supply, _ = single_line([tap("T", 15.0, ampere=1000.0)])
    tracks = (Track(id="1", from_km=0.0, to_km=20.0),)
    broken = Line(tracks=tracks, chainage_breaks=(ChainageBreak(at_km=4.0, continues_as_km=8.0),))
    solved = Solved(supply, broken)  # 16 km long, the train 11 km from A
    assert -solved.i["A"] == pytest.approx(1000.0 * (5 * 0.06 + 0.12) / (16 * 0.06 + 0.24), abs=1e-6)


def test_returns_of_each_track():
    """Track 2 has rails of its own: its return current does not lower the train's voltage on track 1."""
    rails = tuple(ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02) for t in "12")
    loads = [tap("T", 10.0, ampere=1000.0), tap("U", 10.0, track="2", ampere=1000.0)]
    own = Solved(*changed(seed_network(loads, "bypassed"), return_circuit=rails))
    common = Solved(*seed_network(loads, "bypassed"))
    assert own.u["T"] == pytest.approx(3600.0 - 0.12 * 1000.0 - 500.0 * 10 * 0.07, abs=1e-6)
    assert common.u["T"] == pytest.approx(3600.0 - 0.12 * 1000.0 - 500.0 * 10 * 0.05 - 1000.0 * 10 * 0.01, abs=1e-6)


def test_a_floating_island_is_pinned():
    """Both ends of a stretch are open: dead, but defined; the rest is as it would be without it."""
    points = tuple(SectionPoint(id=f"{t}{km}", track=t, km=km) for t in "2" for km in (6.0, 14.0))
    loads = [tap("T", 4.0, kw=3000.0)]
    supply, line = changed(seed_network(loads, "bypassed"), section_points=points)
    dead = Solved(supply.model_copy(update={"loads": (*loads, tap("D", 8.0, track="2", kw=800.0))}), line)
    alone = Solved(supply, line)
    assert dead.u["T"] == pytest.approx(alone.u["T"], abs=1e-3)
    assert abs(dead.u["D"]) < 100.0
    assert abs(dead.i["D"]) < 1e-3
    base = dead.network.base
    assert np.all(np.isfinite(base))
    assert np.sum(base[: dead.network.nodes] == BLOCKED_CONDUCTANCE_S) <= 1
    assert np.all(np.isfinite(dead.work.node_v))


def test_no_substation_at_all():
    supply, line = seed_network([tap("T", 4.0, kw=3000.0)])
    solved = Solved(supply.model_copy(update={"substations": ()}), line)
    assert solved.u["T"] == pytest.approx(0.0, abs=1e-6)
    assert solved.i["T"] == pytest.approx(0.0, abs=1e-6)


def test_two_lines_that_do_not_meet():
    """Every part of the network has its own reference."""
    wires = tuple(ContactLine(from_km=a, to_km=b, resistance_ohm_per_km=0.06) for a, b in ((0.0, 8.0), (12.0, 20.0)))
    rails = tuple(ReturnCircuit(from_km=w.from_km, to_km=w.to_km, resistance_ohm_per_km=0.0) for w in wires)
    loads = (tap("x", 8.0, ampere=500.0), tap("y", 12.0, ampere=1000.0))
    supply, line = single_line()
    solved = Solved(supply.model_copy(update={"contact_lines": wires, "return_circuit": rails, "loads": loads}), line)
    assert solved.u["x"] == pytest.approx(3600.0 - 500.0 * (0.12 + 8 * 0.06), abs=1e-6)
    assert solved.u["y"] == pytest.approx(3600.0 - 1000.0 * (0.12 + 8 * 0.06), abs=1e-6)


def test_an_idle_busbar_stands_at_its_own_voltage():
    """Regression: a substation cut off from another of higher voltage kept a start voltage that nothing could lower."""
    supply, line = single_line([tap("x", 3.0, kw=1000.0)])
    low = supply.substations[1].model_copy(update={"no_load_voltage_v": 3400.0})
    points = (SectionPoint(id="P", track="1", km=10.0),)
    solved = Solved(supply.model_copy(update={"substations": (supply.substations[0], low), "section_points": points}), line)
    assert solved.u["B"] == pytest.approx(3400.0, abs=0.5)


# -- earth


def leaky(loads=(), leakage=0.1, **more):
    rails = tuple(
        ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02, leakage_s_per_km=leakage) for t in "12"
    )
    return changed(seed_network(loads, **more), return_circuit=rails)


def test_earth_is_ground_where_rails_leak():
    tables = compile_network(*leaky(), LIMITS)
    assert tables.busbar[0, 1] < tables.network.nodes
    assert (np.maximum(tables.rail_table["node"], tables.rail_table["span"]) >= 0).all()
    assert len(tables.rail_places) == len(tables.rail_table)
    assert sum(place.span < 0 for place in tables.rail_places) == 6  # two tracks, three cuts
    assert all(stretch.earthed for stretch in tables.stretches)


def test_rails_that_nothing_joins_with_earth_have_no_potential():
    tables = compile_network(*seed_network(), LIMITS)
    assert len(tables.rail_places) == len(tables.rail_table) == 0
    assert not any(stretch.earthed for stretch in tables.stretches)
    supply, line = seed_network()
    device = VoltageLimitingDevice(id="V", track="1", km=10.0, closes=(VoltageTime(above_v=60.0),))
    waiting = supply.model_copy(update={"voltage_limiting_devices": (device,)})
    tables = compile_network(waiting, line, LIMITS)
    assert [place.km for place in tables.rail_places if place.span < 0] == [0.0, 10.0, 20.0]
    assert np.maximum(tables.rail_table["node"], tables.rail_table["span"]).max() == -1
    assert tables.earth_edge.tolist() == [-1]
    latched = supply.model_copy(update={"voltage_limiting_devices": (device.model_copy(update={"state": "closed"}),)})
    tables = compile_network(latched, line, LIMITS)
    assert (np.maximum(tables.rail_table["node"], tables.rail_table["span"]) >= 0).all()
    assert tables.earth_edge.tolist() == [0]


def test_what_goes_into_earth_comes_back():
    solved = Solved(*leaky([tap("T", 4.0, kw=3000.0), tap("U", 13.0, track="2", kw=1000.0)]))
    *_, worst, _ = solved.flows()
    assert worst < 1e-6
    assert sum(solved.work.conductors["earth_a"]) == pytest.approx(0.0, abs=1e-6)
    potentials = solved.rails
    assert potentials["1", 10.0] > 0.0 > potentials["1", 0.0]  # rails near trains are positive, at substations negative


def test_earthings_and_devices_by_identifier():
    supply, line = seed_network([tap("T", 4.0, kw=3000.0)])
    earthing = (
        Earthing(id="Z", track="1", km=15.0, resistance_ohm=2.0), Earthing(id="B", substation="A", resistance_ohm=0.5)
    )  # fmt: skip
    device = VoltageLimitingDevice(id="A", track="1", km=10.0, closes=(VoltageTime(above_v=60.0),))
    tables = compile_network(
        supply.model_copy(update={"earthing": earthing, "voltage_limiting_devices": (device,)}), line, LIMITS
    )
    assert tables.earth_devices == ("B", "Z", "A")
    assert tables.earth_edge.tolist() == [0, 1, -1]
    assert tables.edges["conductance_s"].tolist() == pytest.approx([2.0, 0.5])
    assert tables.edges["second"].tolist() == [tables.network.nodes] * 2


def test_the_potential_between_two_earthings():
    """Earthed at A by 0.5 ohm and at km 20 by 2 ohm, the rails are a bridge beside earth."""
    supply, line = seed_network([tap("T", 20.0, ampere=1000.0)], "bypassed")
    only = supply.substations[:1]
    earthing = (Earthing(id="A", substation="A", resistance_ohm=0.5), Earthing(id="B", track="1", km=20.0, resistance_ohm=2.0))
    solved = Solved(supply.model_copy(update={"substations": only, "earthing": earthing}), line)
    astray = 1000.0 * 0.2 / (0.2 + 2.5)
    assert solved.rails["1 2", 0.0] == pytest.approx(-0.5 * astray, abs=1e-6)
    assert solved.rails["1 2", 20.0] == pytest.approx(2.0 * astray, abs=1e-6)


# -- units and their resistance


@pytest.mark.parametrize(("units", "out", "grid"), [(3, 1, 0.0), (3, 2, 0.02), (4, 1, 0.05)])
def test_a_unit_out_changes_the_slope_and_not_the_no_load_voltage(units, out, grid):
    supply, line = seed_network([tap("T", 0.0, ampere=1000.0)])
    one = {"units": units, "grid_resistance_ohm": grid}
    station = supply.substations[0].model_copy(update=one)
    whole, part = (
        Solved(supply.model_copy(update={"substations": (station.model_copy(update={"units_in_service": k}),)}), line)
        for k in (units, units - out)
    )
    assert 3600.0 - whole.u["A"] == pytest.approx(1000.0 * 0.12, abs=1e-6)
    k = units - out
    assert 3600.0 - part.u["A"] == pytest.approx(1000.0 * ((0.12 - grid) * units / k + grid), abs=1e-6)
    idle = supply.model_copy(update={"substations": (station.model_copy(update={"units_in_service": k}),), "loads": ()})
    assert Solved(idle, line).u["A"] == pytest.approx(3600.0, abs=1e-5)


def test_without_units_the_busbar_still_ties():
    supply, line = seed_network([tap("T", 4.0, kw=1000.0)])
    dead = supply.substations[0].model_copy(update={"units": 2, "units_in_service": 0})
    tables = compile_network(supply.model_copy(update={"substations": (dead, supply.substations[1])}), line, LIMITS)
    assert tables.source_port.tolist() == [-1, 1]
    assert (tables.busbar >= 0).all()
    out = supply.substations[0].model_copy(update={"state": "rectifiers_out"})
    other = compile_network(supply.model_copy(update={"substations": (out, supply.substations[1])}), line, LIMITS)
    np.testing.assert_array_equal(tables.network.base, other.network.base)


# -- states


def test_lists_do_not_depend_on_states():
    """A run that switches writes into the same columns before and after."""
    supply, line = leaky([tap("T", 4.0, kw=1000.0)])
    lists = []
    for state, cabin in (("in_service", "closed"), ("open", "bypassed"), ("bypassed", "open"), ("rectifiers_out", "closed")):
        stations = (supply.substations[0].model_copy(update={"state": state}), supply.substations[1])
        cabins = (supply.section_cabins[0].model_copy(update={"state": cabin}),)
        tables = compile_network(supply.model_copy(update={"substations": stations, "section_cabins": cabins}), line, LIMITS)
        names = [(link.id, link.kind, link.km) for link in tables.links]
        places = [(place.tracks, place.km) for place in tables.rail_places]
        lists.append((names, tables.sections, places, tables.earth_devices, tables.watched, len(tables.network.ports)))
    assert lists[1:] == lists[:1] * 3


def test_tables_are_the_same_for_the_same_supply():
    supply, line = seed_network([tap("z", 3.0, kw=1.0), tap("b", 4.0, kw=1.0)])
    other = supply.model_copy(update={"loads": supply.loads[::-1], "substations": supply.substations[::-1]})
    first, second = compile_network(supply, line, LIMITS), compile_network(other, line, LIMITS)
    for a, b in zip(first.network, second.network, strict=True):
        np.testing.assert_array_equal(a, b)
    assert len(new_work(first.network).node_v) == first.network.nodes + 1


@pytest.mark.parametrize(
    "rows", [[(0.0, 10.0), (12.0, 20.0)], [(0.0, 12.0), (12.0, 20.0)], [(0.0, 10.0), (10.0, 20.0)], [(0.0, 20.0)]]
)
@pytest.mark.parametrize("points", [(), (10.0, 12.0)])
def test_both_kilometres_of_a_chainage_break_are_one_place(rows, points):
    """Regression: rows that end and begin there were not joined, and two points there divided by a length of zero."""
    line = Line(
        tracks=(Track(id="1", from_km=0.0, to_km=20.0),), chainage_breaks=(ChainageBreak(at_km=10.0, continues_as_km=12.0),)
    )
    supply, _ = single_line([tap("T", 15.0, ampere=1000.0)])
    changes = {
        "contact_lines": tuple(ContactLine(from_km=float(a), to_km=float(b), resistance_ohm_per_km=0.05) for a, b in rows),
        "return_circuit": tuple(ReturnCircuit(from_km=float(a), to_km=float(b), resistance_ohm_per_km=0.01) for a, b in rows),
        "section_points": tuple(SectionPoint(id=f"P{km}", track="1", km=km, state="closed") for km in points),
    }
    solved = Solved(supply.model_copy(update=changes), line)  # 18 km long, the train 13 km from A
    assert -solved.i["A"] == pytest.approx(1000.0 * (5 * 0.06 + 0.12) / (18 * 0.06 + 0.24), abs=1e-6)


def test_a_substation_whose_return_feeders_are_open_feeds_nothing():
    supply, line = single_line([tap("T", 4.0, kw=1000.0)])
    feeders = (Feeder(at="A", track="1", side="return", state="open"),)
    solved = Solved(supply.model_copy(update={"feeders": feeders}), line)
    assert solved.sources == ["B"]
    assert solved.tables.busbar[0].tolist() == [-1, -1]
