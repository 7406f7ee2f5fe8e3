"""Feeders at other places, return feeders, switches, connections, bonds, earth: what joins what."""

from itertools import pairwise

import pytest
from nodes import Graph, line, lines, rails_of_each, station, supply
from solved import Solved, tap

from tractionpower.model.earthing import Bonds, Earthing, VoltageLimitingDevice, VoltageTime
from tractionpower.model.line import Connection
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, SectionPoint
from tractionpower.model.switchgear import Feeder, Switch
from tractionpower.supply.topology import SHORT_OHM
from tractionpower.supply.wiring import build_topology


def graph(declared, along=None):
    return Graph(build_topology(declared, along or line()))


def switch(first, second, **more):
    """Return a switch Q between two ends."""
    return Switch.model_validate({"id": "Q", "from": first, "to": second} | more)


def connection(first, second):
    """Return a connection between two places (track, km)."""
    ends = ({"track": track, "km": km} for track, km in (first, second))
    return Connection.model_validate(dict(zip(("from", "to"), ends, strict=True)))


# -- feeders


def test_a_row_changes_one_feeder():
    rows = (Feeder(at="S", track="1", side="high_km", resistance_ohm=0.3), Feeder(at="S", track="2", side="low_km", state="open"))
    found = graph(supply(substations=(station(feeder_resistance_ohm=0.02),), feeders=rows))
    assert {name: (link.ohm, link.closed) for name, link in found.links.items()} == {
        "S 1 low_km": (0.02, True), "S 1 high_km": (0.3, True), "S 2 low_km": (0.02, False), "S 2 high_km": (0.02, True),
    }  # fmt: skip
    assert found.ohms(found.positive(), found.high("1")) == [0.3]
    assert found.ohms(found.positive(), found.low("2")) == []


def test_a_feeder_of_a_station_that_is_out_is_open_whatever_its_row_says():
    rows = (Feeder(at="S", track="1", side="high_km", state="closed"),)
    found = graph(supply(substations=(station(state="bypassed"),), feeders=rows))
    assert not any(link.closed for link in found.links.values())


def test_a_feeder_to_another_line():
    """The line of track 9 is fed at its km 3, and cut there."""
    along = lines(("1", 0.0, 20.0), ("9", 100.0, 110.0))
    wires = (ContactLine(from_km=0.0, to_km=110.0, resistance_ohm_per_km=0.05),)
    rails = (
        ReturnCircuit(tracks=("1",), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.01),
        ReturnCircuit(tracks=("9",), from_km=100.0, to_km=110.0, resistance_ohm_per_km=0.01),
    )
    rows = tuple(Feeder(at="S", track="9", side=side, km=103.0, resistance_ohm=0.2) for side in ("low_km", "high_km"))
    declared = supply(contact_lines=wires, return_circuit=rails, substations=(station(),), feeders=rows)
    found = graph(declared, along)
    assert sorted(found.links) == ["S 1 high_km", "S 1 low_km", "S 9 high_km", "S 9 low_km"]
    assert found.links["S 9 low_km"].km == 103.0
    assert found.ohms(found.positive(), found.low("9", 103.0)) == [0.2]
    assert not found.one(found.low("9", 103.0), found.high("9", 103.0))
    assert found.one(found.rail("1"), found.rail("9", 103.0), found.negative())  # the return current comes back
    bypassed = declared.model_copy(update={"substations": (station(state="bypassed"),)})
    again = graph(bypassed, along)
    assert again.one(again.low("9", 103.0), again.high("9", 103.0))


def test_a_feeder_at_another_kilometre_of_an_own_track():
    """The station meets track 1 at km 10.4 only: there its contact line is cut, and at km 10 it is not."""
    rows = tuple(Feeder(at="S", track="1", side=side, km=10.4) for side in ("low_km", "high_km"))
    found = graph(supply(substations=(station(feeder_resistance_ohm=0.1),), feeders=rows))
    assert found.links["S 1 low_km"].km == 10.4
    assert found.ohms(found.positive(), found.low("1", 10.4)) == [0.1]
    assert found.one(found.low("1", 10.0), found.high("1", 10.0))
    assert not found.one(found.low("2", 10.0), found.high("2", 10.0))
    assert len(found.links) == 4


def test_a_return_feeder_at_another_kilometre_leaves_the_contact_line_alone():
    """Regression: its place became that of the feeders of the track, too."""
    rows = (Feeder(at="S", track="1", side="return", km=10.4, resistance_ohm=0.01),)
    declared = supply(substations=(station(),), feeders=rows, return_circuit=rails_of_each())
    found = graph(declared)
    assert found.links["S 1 low_km"].km == 10.0
    assert found.links["S 1 return"].km == 10.4
    assert found.one(found.low("1", 10.4), found.high("1", 10.4))
    assert found.one(found.positive(), found.low("1", 10.0))
    assert found.ohms(found.rail("1", 10.4), found.negative()) == [0.01]


@pytest.mark.parametrize("state", ["in_service", "open"])
def test_return_feeders_of_rows_and_the_common_one(state):
    rows = (Feeder(at="S", track="1", side="return", resistance_ohm=0.01),)
    one = station(state=state, return_resistance_ohm=0.03)
    found = graph(supply(substations=(one,), feeders=rows, return_circuit=rails_of_each()))
    assert found.ohms(found.rail("1"), found.negative()) == [0.01]
    assert found.ohms(found.rail("2"), found.negative()) == [0.03]
    assert not found.one(found.rail("1"), found.rail("2"))
    link = found.links["S 1 return"]
    assert (link.kind, link.closed, link.first, link.second) == ("return", True, found.rail("1"), found.negative())


def test_an_open_return_feeder():
    rows = (Feeder(at="S", track="1", side="return", resistance_ohm=0.01, state="open"),)
    found = graph(supply(substations=(station(),), feeders=rows, return_circuit=rails_of_each()))
    assert found.ohms(found.rail("1"), found.negative()) == []
    assert found.one(found.rail("2"), found.negative())


def test_a_row_without_resistance_takes_that_of_the_station():
    rows = tuple(Feeder(at="S", track="1", side=side) for side in ("low_km", "return"))
    one = station(feeder_resistance_ohm=0.02, return_resistance_ohm=0.03)
    found = graph(supply(substations=(one,), feeders=rows))
    assert (found.links["S 1 low_km"].ohm, found.links["S 1 return"].ohm) == (0.02, 0.03)


def test_feeders_of_a_cabin():
    cabin = SectionCabin(id="C", km=10.0, feeder_resistance_ohm=0.01)
    rows = (Feeder(at="C", track="2", side="high_km", state="open"),)
    found = graph(supply(section_cabins=(cabin,), feeders=rows))
    assert [found.links[f"C {name}"].closed for name in ("1 low_km", "1 high_km", "2 low_km", "2 high_km")] == [True] * 3 + [
        False
    ]
    assert found.ohms(found.positive("C"), found.low("2")) == [0.01]


# -- switches


@pytest.mark.parametrize(("ohm", "one"), [(0.0, True), (0.5 * SHORT_OHM, True), (0.1, False)])
def test_a_cross_tie(ohm, one):
    found = graph(supply(switches=(switch({"track": "1", "km": 7.0}, {"track": "2", "km": 8.0}, resistance_ohm=ohm),)))
    assert found.one(found.low("1", 7.0), found.high("2", 8.0)) is one
    assert not found.plainly_one(found.low("1", 7.0), found.high("2", 8.0))
    assert found.ohms(found.low("1", 7.0), found.high("2", 8.0)) == ([] if one else [0.1])
    link = found.links["Q"]
    assert (link.kind, link.track, link.km) == ("switch", "1", 7.0)
    open_one = switch({"track": "1", "km": 7.0}, {"track": "2", "km": 8.0}, resistance_ohm=ohm, state="open")
    found = graph(supply(switches=(open_one,)))
    assert not found.one(found.low("1", 7.0), found.high("2", 8.0))
    assert found.ohms(found.low("1", 7.0), found.high("2", 8.0)) == []


def test_a_switch_cuts_no_contact_line():
    found = graph(supply(switches=(switch({"track": "1", "km": 7.0}, {"track": "2", "km": 8.0}),)))
    assert found.plainly_one(found.low("1", 7.0), found.high("1", 7.0))
    assert found.plainly_one(found.low("1", 8.0), found.high("1", 8.0))


@pytest.mark.parametrize(("side", "joined"), [("low_km", "low"), ("high_km", "high")])
def test_the_side_of_a_switch(side, joined):
    point = SectionPoint(id="P", track="1", km=7.0)
    ends = {"track": "1", "km": 7.0, "side": side}, {"track": "2", "km": 7.0}
    found = graph(supply(section_points=(point,), switches=(switch(*ends),)))
    assert found.one(found.low("1", 7.0), found.low("2", 7.0)) is (joined == "low")
    assert found.one(found.high("1", 7.0), found.low("2", 7.0)) is (joined == "high")


def test_a_switch_at_a_busbar():
    cabin = SectionCabin(id="C", km=15.0)
    found = graph(supply(substations=(station(),), section_cabins=(cabin,), switches=(switch({"busbar": "S"}, {"busbar": "C"}),)))
    assert found.one(found.positive("S"), found.positive("C"), found.low("2", 15.0))
    found = graph(
        supply(substations=(station(),), switches=(switch({"busbar": "S"}, {"track": "1", "km": 3.0}, resistance_ohm=0.2),))
    )
    assert found.ohms(found.positive(), found.low("1", 3.0)) == [0.2]
    assert found.links["Q"].first == found.positive()


# -- connections


def branch(**more):
    """Return a line of 20 km, a branch of 6 km that leaves it at km 8, and rails for each."""
    along = lines(("1", 0.0, 20.0), ("9", 0.0, 6.0), connections=(connection(("1", 8.0), ("9", 0.0)),))
    return supply(return_circuit=rails_of_each("19"), **more), along


def test_a_branch_is_joined_with_its_rails():
    found = graph(*branch())
    assert found.plainly_one(found.low("1", 8.0), found.high("1", 8.0), found.high("9", 0.0))
    assert found.plainly_one(found.rail("1", 8.0), found.rail("9", 0.0))
    assert len(found.topology.spans) == 3


@pytest.mark.parametrize("device", [{"substations": (station(km=8.0, tracks=("1",)),)},
                                    {"section_points": (SectionPoint(id="P", track="1", km=8.0),)}])  # fmt: skip
def test_where_a_contact_line_is_cut_a_connection_joins_rails_only(device):
    found = graph(*branch(**device))
    assert not found.one(found.low("1", 8.0), found.high("9", 0.0))
    assert not found.one(found.high("1", 8.0), found.high("9", 0.0))
    assert found.plainly_one(found.rail("1", 8.0), found.rail("9", 0.0))


def test_a_closed_point_at_a_connection():
    found = graph(*branch(section_points=(SectionPoint(id="P", track="1", km=8.0, state="closed"),)))
    assert found.plainly_one(found.low("1", 8.0), found.high("1", 8.0), found.high("9", 0.0))


def test_an_open_point_at_the_start_of_a_branch_cuts_it_off():
    """Regression: at the end of a track an open point was passed by the connection."""
    found = graph(*branch(section_points=(SectionPoint(id="P", track="9", km=0.0),)))
    assert found.one(found.low("1", 8.0), found.high("1", 8.0))
    assert not found.one(found.low("1", 8.0), found.high("9", 0.0))
    assert found.plainly_one(found.rail("1", 8.0), found.rail("9", 0.0))
    closed = graph(*branch(section_points=(SectionPoint(id="P", track="9", km=0.0, state="closed"),)))
    assert closed.one(closed.low("1", 8.0), closed.high("9", 0.0))


def halves(connected=True):
    """Return the line of 20 km as two tracks that meet at km 10."""
    joint = (connection(("a", 10.0), ("b", 10.0)),) if connected else ()
    return lines(("a", 0.0, 10.0), ("b", 10.0, 20.0), connections=joint)


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out", "bypassed", "open"])
def test_a_substation_where_two_tracks_end_is_one_on_the_way(state):
    """Regression: the connection tied both ends beside the feeders."""
    found = graph(
        supply(return_circuit=rails_of_each("ab"), substations=(station(state=state, feeder_resistance_ohm=0.05),)), halves()
    )
    whole = graph(supply(substations=(station(state=state, feeder_resistance_ohm=0.05),)), line("1"))
    assert found.one(found.low("a"), found.high("b")) is whole.one(whole.low("1"), whole.high("1")) is (state == "bypassed")
    assert len([*found.topology.edges()]) == len([*whole.topology.edges()])
    assert found.one(found.rail("a"), found.rail("b"))


def test_a_line_in_two_halves_is_the_whole_line():
    """A connection changes nothing but the name of the track."""
    loads = (tap("T", 4.0, track="{}", ampere=1500.0), tap("U", 13.0, track="{}", ampere=800.0))
    volts = []
    for along, tracks in ((line("1"), "11"), (halves(), "ab")):
        rails = tuple(ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02) for t in sorted({*tracks}))
        taps = tuple(load.model_copy(update={"track": t}) for load, t in zip(loads, tracks, strict=True))
        ends = (station("A", 0.0), station("M", 10.0, feeder_resistance_ohm=0.03), station("B", 20.0))
        volts.append(Solved(supply(return_circuit=rails, substations=ends, loads=taps), along).u)
    assert volts[0] == {name: pytest.approx(u, abs=1e-9) for name, u in volts[1].items()}


def test_a_branch_of_no_use_changes_nothing():
    taps = (tap("T", 4.0, ampere=1500.0),)
    ends = (station("A", 0.0, tracks=("1",)), station("B", 20.0, tracks=("1",)))
    with_branch, along = branch(substations=ends, loads=taps)
    alone = Solved(supply(substations=ends, loads=taps, return_circuit=rails_of_each("1")), line("1"))
    assert Solved(with_branch, along).u == {name: pytest.approx(u, abs=1e-9) for name, u in alone.u.items()}


def ring(closed):
    """Return a line of 20 km whose ends meet, one substation at km 5."""
    joint = (connection(("1", 0.0), ("1", 20.0)),) if closed else ()
    return lines(("1", 0.0, 20.0), connections=joint)


def test_a_ring_feeds_from_both_sides():
    """15 km from the substation one way, 5 km the other way round the joint."""
    one = (station("A", 5.0),)
    for closed, ohm in ((True, 0.06 * 10.0 * 10.0 / 20.0), (False, 0.06 * 10.0)):
        solved = Solved(supply(substations=one, loads=(tap("T", 15.0, ampere=1000.0),)), ring(closed))
        assert solved.u["T"] == pytest.approx(3600.0 - 120.0 - 1000.0 * ohm, abs=1e-6)


def test_an_open_point_opens_a_ring():
    one = {"substations": (station("A", 5.0),), "loads": (tap("T", 15.0, ampere=1000.0),)}
    rails = (ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0),)
    opened = Solved(supply(section_points=(SectionPoint(id="P", track="1", km=20.0),), return_circuit=rails, **one), ring(True))
    line_only = Solved(supply(return_circuit=rails, **one), ring(False))
    assert opened.u == {name: pytest.approx(u, abs=1e-9) for name, u in line_only.u.items()}


# -- bonds and earth


def bonds(**more):
    return Bonds(**({"from_km": 2.0, "to_km": 18.0, "every_km": 4.0} | more))


def test_bonds_stand_at_equal_distances_on_the_tracks_that_are_there():
    rails = rails_of_each("123")
    along = lines(("1", 0.0, 20.0), ("2", 0.0, 20.0), ("3", 5.0, 15.0))
    found = graph(supply(return_circuit=rails, bonds=(bonds(resistance_ohm=0.1),)), along)
    assert len(found.topology.bonds) == 2 * 1 + 3 * 2  # km 2 and 18; km 6, 10, 14
    assert found.ohms(found.rail("2", 6.0), found.rail("3", 6.0)) == [0.1]
    assert found.ohms(found.rail("1", 6.0), found.rail("3", 6.0)) == []  # neighbours only


def test_bonds_without_resistance_make_rails_one():
    found = graph(supply(return_circuit=rails_of_each(), bonds=(bonds(),)))
    assert found.topology.bonds == []
    for km in (2.0, 6.0, 10.0, 14.0, 18.0):
        assert found.plainly_one(found.rail("1", km), found.rail("2", km))
    assert not found.one(found.rail("1", 2.0), found.rail("1", 6.0))


@pytest.mark.parametrize(("every", "count"), [(0.1, 161), (0.7, 23), (16.0, 2), (16.0005, 2), (16.01, 1), (40.0, 1)])
def test_the_number_of_bonds(every, count):
    """The last one stands at `to_km` itself where the distance divides the stretch, whatever 0.1 km is in binary."""
    found = graph(supply(return_circuit=rails_of_each(), bonds=(bonds(every_km=every, resistance_ohm=0.1),)))
    assert len(found.topology.bonds) == count


def test_bonds_of_chosen_tracks():
    found = graph(supply(return_circuit=rails_of_each("123"), bonds=(bonds(tracks=("3", "1")),)), line("123"))
    assert found.one(found.rail("1", 6.0), found.rail("3", 6.0))
    assert not found.one(found.rail("1", 6.0), found.rail("2", 6.0))


def test_bonds_within_a_common_conductor_are_none():
    found = graph(supply(bonds=(bonds(resistance_ohm=0.1),)))
    assert found.topology.bonds == []
    assert [*found.topology.edges()] == []


def test_denser_bonds_tend_to_a_common_return():
    loads = (tap("T", 9.0, ampere=2000.0),)
    ends = (station("A", 0.0, tracks=("1",)), station("B", 20.0, tracks=("1",)))
    common = Solved(supply(substations=ends, loads=loads), line()).u["T"]
    found = []
    for every in (8.0, 2.0, 0.5):
        bonded = bonds(from_km=0.0, to_km=20.0, every_km=every)
        found.append(
            Solved(supply(substations=ends, loads=loads, return_circuit=rails_of_each(), bonds=(bonded,)), line()).u["T"]
        )
    gaps = [common - u for u in found]
    assert all(later < 0.6 * earlier for earlier, later in pairwise(gaps))
    assert 0.0 <= gaps[-1] < 0.02 * 2000.0 * 0.125  # what 500 m of two rails can differ from one of half


def test_earth_exists_where_something_is_joined_with_it():
    assert graph(supply()).topology.earth is None
    device = VoltageLimitingDevice(id="V", track="1", km=10.0, closes=(VoltageTime(above_v=60.0),))
    earthing = Earthing(id="E", substation="S", resistance_ohm=2.0)
    leaky = rails_of_each(leakage=0.1)
    for more in ({"voltage_limiting_devices": (device,)}, {"earthing": (earthing,), "substations": (station(),)},
                 {"return_circuit": leaky}):  # fmt: skip
        assert graph(supply(**more)).topology.earth is not None


@pytest.mark.parametrize("state", ["open", "closed"])
def test_a_voltage_limiting_device(state):
    device = VoltageLimitingDevice(
        id="V", track="2", km=7.0, closes=(VoltageTime(above_v=60.0),), state=state, closed_resistance_ohm=0.2
    )
    found = graph(supply(voltage_limiting_devices=(device,), return_circuit=rails_of_each()))
    earth = found.topology.earth
    assert found.ohms(found.rail("2", 7.0), earth) == ([0.2] if state == "closed" else [])
    assert [(item.id, item.closed) for item in found.topology.earth_links] == [("V", state == "closed")]


def test_earthings_of_rails_and_of_a_negative_busbar():
    items = (Earthing(id="R", track="1", km=7.0, resistance_ohm=3.0), Earthing(id="N", substation="S", resistance_ohm=2.0))
    one = station(return_resistance_ohm=0.1)
    found = graph(supply(earthing=items, substations=(one,)))
    earth = found.topology.earth
    assert found.ohms(found.negative(), earth) == [2.0]
    assert found.ohms(found.rail("1", 7.0), earth) == [3.0]
