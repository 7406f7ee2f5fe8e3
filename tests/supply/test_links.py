"""Currents of breakers and switches without resistance: what edges of 1e-4 ohm in their place would carry."""

import numpy as np
import pytest
from nodes import line, lines, rails_of_each, station, supply
from solved import LIMITS, Solved, tap

from tractionpower.model.supply import ContactLine, SectionCabin, SectionPoint
from tractionpower.model.switchgear import Feeder, Switch
from tractionpower.supply.compile import compile_network

TINY_OHM = 1e-4
LOADS = (tap("T", 4.0, ampere=1500.0), tap("U", 13.0, track="2", ampere=800.0), tap("V", 17.0, ampere=300.0))


def with_ohms(declared, ohm):
    """Return the same supply with feeders, return feeders of rows and switches of this resistance."""
    stations = tuple(item.model_copy(update={"feeder_resistance_ohm": ohm}) for item in declared.substations)
    cabins = tuple(item.model_copy(update={"feeder_resistance_ohm": ohm}) for item in declared.section_cabins)
    rows = tuple(item.model_copy(update={"resistance_ohm": ohm}) for item in declared.feeders)
    switches = tuple(item.model_copy(update={"resistance_ohm": ohm}) for item in declared.switches)
    return declared.model_copy(update={"substations": stations, "section_cabins": cabins, "feeders": rows, "switches": switches})


def compare(declared, along=None):
    """Compare all links without resistance with edges in their place; return their currents.

    What edges change by their resistance is taken off by drawing a straight line through two of them.
    """
    along = along or line()
    exact, near, far = (Solved(with_ohms(declared, ohm), along).links for ohm in (0.0, TINY_OHM, 2.0 * TINY_OHM))
    assert list(exact) == list(near)
    for name, current in exact.items():
        assert current == pytest.approx(2.0 * near[name] - far[name], abs=0.01), name
    return exact


def stations(**more):
    return station("A", 0.0, **more), station("B", 20.0, **more)


def test_feeders_of_substations_and_a_cabin():
    found = compare(supply(substations=stations(), section_cabins=(SectionCabin(id="C", km=10.0),), loads=LOADS))
    assert sum(current for name, current in found.items() if name[0] in "AB") == pytest.approx(2600.0, abs=1e-5)
    assert sum(current for name, current in found.items() if name[0] == "C") == pytest.approx(0.0, abs=1e-5)
    assert abs(found["C 1 low_km"]) > 100.0


def test_a_feeder_carries_what_its_section_takes():
    """Cut at km 6, the piece beyond the feeder of A carries the one load there and no more."""
    points = (SectionPoint(id="P", track="1", km=6.0),)
    found = compare(supply(substations=stations(), section_points=points, loads=LOADS))
    assert found["A 1 high_km"] == pytest.approx(1500.0, abs=1e-6)
    assert found["B 1 low_km"] == pytest.approx(300.0, abs=1e-6)


def test_an_open_breaker_carries_nothing():
    rows = (Feeder(at="A", track="1", side="high_km", state="open"),)
    loads = (tap("T", 4.0, ampere=600.0), *LOADS[1:])
    found = compare(supply(substations=stations(), feeders=rows, loads=loads))
    assert found["A 1 high_km"] == 0.0
    assert found["B 1 low_km"] == pytest.approx(900.0, abs=1e-6)


@pytest.mark.parametrize("state", ["open", "bypassed", "rectifiers_out"])
def test_a_substation_out_of_service_in_the_middle(state):
    middle = station("M", 10.0, state=state)
    found = compare(supply(substations=(*stations(), middle), loads=LOADS))
    own = {name: current for name, current in found.items() if name[0] == "M"}
    assert len(own) == 4
    if state == "rectifiers_out":
        assert sum(own.values()) == pytest.approx(0.0, abs=1e-5)
        assert max(own.values()) > 100.0
    else:
        assert set(own.values()) == {0.0}


def test_return_feeders_of_each_track():
    rows = tuple(Feeder(at=at, track=t, side="return", resistance_ohm=0.0) for at in "AB" for t in "12")
    found = compare(supply(substations=stations(), feeders=rows, return_circuit=rails_of_each(), loads=LOADS))
    back = {name: current for name, current in found.items() if name.endswith("return")}
    assert sum(back.values()) == pytest.approx(2600.0, abs=1e-5)  # from the rails to the busbars
    assert back["A 1 return"] + back["B 1 return"] == pytest.approx(1800.0, abs=1e-5)  # rails of one track meet no others


def test_a_return_feeder_beside_the_common_one():
    """Track 1 has a return feeder of its own, track 2 the common one of the substation."""
    rows = (Feeder(at="A", track="1", side="return", resistance_ohm=0.01),)
    declared = supply(substations=stations(return_resistance_ohm=0.02), feeders=rows, return_circuit=rails_of_each(), loads=LOADS)
    solved = Solved(declared, line())
    feeding = solved.links["A 1 high_km"] + solved.links["A 2 high_km"]
    assert 0.0 < solved.links["A 1 return"] < feeding
    tables, work = solved.tables, solved.work
    rail = next(link.first for link in tables.links if link.id == "A 1 return")
    assert rail >= 0
    edge = tables.edges[np.isclose(tables.edges["conductance_s"], 100.0)][0]
    drop = work.node_v[edge["first"]] - work.node_v[edge["second"]]
    assert solved.links["A 1 return"] == pytest.approx(100.0 * drop, abs=1e-9)


def test_a_bypass_around_an_open_substation():
    """The switch carries what the track behind the open substation takes."""
    switches = (Switch.model_validate({"id": "Q", "from": {"track": "1", "km": 10.0, "side": "low_km"},
                                       "to": {"track": "1", "km": 10.0, "side": "high_km"}}),)  # fmt: skip
    first = station("A", 0.0), station("M", 10.0, state="open")
    loads = (tap("T", 15.0, ampere=900.0), tap("U", 4.0, track="2", ampere=200.0))
    found = compare(supply(substations=first, switches=switches, loads=loads))
    assert found["Q"] == pytest.approx(900.0, abs=1e-6)
    turned = (Switch.model_validate({"id": "Q", "to": {"track": "1", "km": 10.0, "side": "low_km"},
                                     "from": {"track": "1", "km": 10.0, "side": "high_km"}}),)  # fmt: skip
    assert compare(supply(substations=first, switches=turned, loads=loads))["Q"] == pytest.approx(-900.0, abs=1e-6)


def test_a_switch_from_a_busbar_feeds_another_line():
    switches = (Switch.model_validate({"id": "Q", "from": {"busbar": "A"}, "to": {"track": "9", "km": 3.0}}),)
    along = lines(("1", 0.0, 20.0), ("9", 0.0, 6.0))
    loads = (tap("T", 4.0, ampere=1500.0), tap("W", 5.0, track="9", ampere=400.0))
    feeding = (station("A", 0.0, tracks=("1",)), station("B", 20.0, tracks=("1",)))
    declared = supply(substations=feeding, switches=switches, loads=loads)
    found = compare(declared, along)
    assert found["Q"] == pytest.approx(400.0, abs=1e-6)


def test_a_tree_of_switches():
    """Busbar, switch, cabin, switch: what hangs behind the last one flows through all."""
    wires = (
        ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("1",)),
        ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("2",)),
    )
    switches = (
        Switch.model_validate({"id": "Q", "from": {"busbar": "C"}, "to": {"busbar": "A"}}),
        Switch.model_validate({"id": "R", "from": {"busbar": "C"}, "to": {"track": "2", "km": 16.0}}),
    )
    one = (station("A", 0.0, tracks=("1",)),)
    cabin = (SectionCabin(id="C", km=10.0, tracks=("2",)),)
    points = (SectionPoint(id="P", track="2", km=14.0),)
    loads = (tap("T", 4.0, ampere=1500.0), tap("U", 12.0, track="2", ampere=500.0), tap("W", 18.0, track="2", ampere=300.0))
    declared = supply(
        contact_lines=wires, substations=one, section_cabins=cabin, section_points=points, switches=switches, loads=loads
    )
    found = compare(declared)
    expected = {"A 1 high_km": 1500.0, "Q": -800.0, "R": 300.0, "C 2 high_km": 500.0, "C 2 low_km": 0.0}
    assert found == {name: pytest.approx(current, abs=1e-6) for name, current in expected.items()}


def test_rails_without_resistance_leak_through_return_feeders():
    """Rails that are one node with their leakage at it: what leaks does not come back through the return feeder."""
    rows = (Feeder(at="A", track="1", side="return", resistance_ohm=0.0),)
    rails = rails_of_each("1", ohm=0.0, leakage=0.5)
    feeding = (station("A", 0.0, tracks=("1",)),)
    declared = supply(substations=feeding, feeders=rows, return_circuit=rails, loads=(tap("T", 12.0, ampere=700.0),))
    solved = Solved(declared, line("1"))
    assert solved.links["A 1 return"] == pytest.approx(700.0, abs=1e-6)
    assert solved.links["A 1 high_km"] == pytest.approx(700.0, abs=1e-6)


def test_links_at_leaky_rails():
    rows = tuple(Feeder(at=at, track=t, side="return", resistance_ohm=0.0) for at in "AB" for t in "12")
    rails = rails_of_each(leakage=0.5)
    found = compare(supply(substations=stations(), feeders=rows, return_circuit=rails, loads=LOADS))
    for at in "AB":
        back = found[f"{at} 1 return"] + found[f"{at} 2 return"]
        side = "high_km" if at == "A" else "low_km"
        assert back == pytest.approx(found[f"{at} 1 {side}"] + found[f"{at} 2 {side}"], abs=1e-5)


def test_every_state_lists_the_same_links():
    names = []
    for state in ("in_service", "rectifiers_out", "bypassed", "open"):
        tables = compile_network(supply(substations=(station(state=state),)), line(), LIMITS)
        names.append([link.id for link in tables.links])
        assert len(tables.link_table) == 4
        assert tables.link_table["terms"].sum() == len(tables.terms)
    assert names[1:] == names[:1] * 3


def test_a_link_between_nodes_that_are_one_anyway_has_no_terms():
    """Two switches in parallel: one of them carries all, as nothing tells how they share."""
    ends = {"from": {"track": "1", "km": 10.0}, "to": {"track": "2", "km": 10.0}}
    switches = tuple(Switch.model_validate({"id": name, **ends}) for name in "QR")
    declared = supply(
        substations=(station("A", 0.0, tracks=("1",)),), switches=switches, loads=(tap("U", 13.0, track="2", ampere=800.0),)
    )
    solved = Solved(declared, line())
    assert sorted([solved.links["Q"], solved.links["R"]]) == [pytest.approx(0.0), pytest.approx(800.0, abs=1e-6)]
