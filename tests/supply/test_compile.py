"""From the declared supply to tables: names, ports, feeders, grounds, shared nodes."""

import numpy as np
import pytest
from solved import LIMITS, Solved, seed_network, single_line, tap

from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S, new_work
from tractionpower.model.line import ChainageBreak, Line, Track
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionPoint
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
    assert {feeder.substation for feeder in tables.feeders} == ({"A", "B"} if busbar else {"B"})


def test_feeders_know_their_conductor_and_end():
    tables = compile_network(*seed_network(), LIMITS)
    names = [(feeder.substation, feeder.track, feeder.side) for feeder in tables.feeders]
    assert names == [("A", "1", "high_km"), ("A", "2", "high_km"), ("B", "1", "low_km"), ("B", "2", "low_km")]
    assert tables.feeder_end.tolist() == [[0, 0], [1, 0], [3, 1], [4, 1]]


def test_feeder_currents_add_up_to_the_source():
    solved = Solved(*seed_network([tap("T", 4.0, kw=3000.0), tap("U", 13.0, track="2", kw=1000.0)], feeder_resistance_ohm=0.01))
    solved.flows()
    sums = {"A": 0.0, "B": 0.0}
    for feeder, (conductor, end) in zip(solved.tables.feeders, solved.tables.feeder_end, strict=True):
        sums[feeder.substation] += solved.work.conductors[("left_a", "right_a")[end]][conductor]
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


def test_tables_are_the_same_for_the_same_supply():
    supply, line = seed_network([tap("z", 3.0, kw=1.0), tap("b", 4.0, kw=1.0)])
    other = supply.model_copy(update={"loads": supply.loads[::-1], "substations": supply.substations[::-1]})
    first, second = compile_network(supply, line, LIMITS), compile_network(other, line, LIMITS)
    for a, b in zip(first.network, second.network, strict=True):
        np.testing.assert_array_equal(a, b)
    assert len(new_work(first.network).node_v) == first.network.nodes + 1
