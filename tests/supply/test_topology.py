"""Which conductors meet in which node, for every state of every switch."""

import pytest
from nodes import Graph, line, rails_of_each, station, supply
from solved import seed_network

from tractionpower.model.earthing import Bonds
from tractionpower.model.line import ChainageBreak
from tractionpower.model.loads import Load
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, SectionPoint
from tractionpower.supply.topology import SHORT_OHM
from tractionpower.supply.wiring import build_topology


def graph(declared, along=None):
    return Graph(build_topology(declared, along or line()))


# -- substations


@pytest.mark.parametrize(
    ("state", "through", "tied", "stands"),
    [("in_service", True, True, True), ("rectifiers_out", True, True, True), ("bypassed", True, False, False),
     ("open", False, False, False)],
)  # fmt: skip
def test_states_of_a_substation(state, through, tied, stands):
    found = graph(supply(substations=(station(state=state),)))
    assert found.one(found.low("1"), found.high("1")) is through
    assert found.one(found.low("1"), found.low("2")) is tied
    assert ("S" in found.topology.busbars) is stands
    assert [link.closed for link in found.topology.links] == [stands] * 4
    assert found.one(found.positive(), found.high("2")) is stands
    assert found.one(found.negative(), found.rail("1"))


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out"])
def test_feeders_with_resistance_separate_the_sides(state):
    one = station(state=state, feeder_resistance_ohm=0.02, return_resistance_ohm=0.03)
    found = graph(supply(substations=(one,)))
    nodes = [found.low("1"), found.high("1"), found.low("2"), found.high("2")]
    assert len({found.topology.find(node) for node in nodes}) == 4
    for node in nodes:
        assert found.ohms(found.positive(), node) == [0.02]
    assert found.ohms(found.negative(), found.rail("1")) == [0.03]
    assert len([*found.topology.edges()]) == 5


def test_a_resistance_too_small_to_matter_is_none():
    found = graph(supply(substations=(station(feeder_resistance_ohm=0.5 * SHORT_OHM),)))
    assert [*found.topology.edges()] == []
    assert found.one(found.low("1"), found.high("2"))
    found = graph(supply(substations=(station(feeder_resistance_ohm=2.0 * SHORT_OHM),)))
    assert len([*found.topology.edges()]) == 4


def test_feeders_are_listed_by_substation_track_and_side():
    topology = build_topology(
        supply(substations=(station("B", 20.0), station("A", 0.0), station("M", 5.0, tracks=("2",)))), line()
    )
    assert {link.kind for link in topology.links} == {"feeder"}
    assert [(link.station, link.track, link.side, link.km) for link in topology.links] == [
        ("A", "1", "high_km", 0.0), ("A", "2", "high_km", 0.0),
        ("B", "1", "low_km", 20.0), ("B", "2", "low_km", 20.0),
        ("M", "2", "low_km", 5.0), ("M", "2", "high_km", 5.0),
    ]  # fmt: skip


def test_a_substation_of_one_track_leaves_the_other_alone():
    found = graph(supply(substations=(station(tracks=("1",), feeder_resistance_ohm=0.02),)))
    assert not found.one(found.low("1"), found.high("1"))
    assert found.one(found.low("2"), found.high("2"))


# -- cabins and section points


@pytest.mark.parametrize(
    ("state", "through", "tied"), [("closed", True, True), ("bypassed", True, False), ("open", False, False)]
)
def test_states_of_a_cabin(state, through, tied):
    found = graph(supply(section_cabins=(SectionCabin(id="C", km=10.0, state=state),)))
    assert found.one(found.low("1"), found.high("1")) is through
    assert found.one(found.low("1"), found.low("2")) is tied
    assert found.one(found.high("1"), found.high("2")) is tied
    assert [(link.kind, link.closed) for link in found.topology.links] == [("cabin", state == "closed")] * 4


def test_a_cabin_joins_contact_lines_never_rails():
    found = graph(supply(section_cabins=(SectionCabin(id="C", km=10.0),), return_circuit=rails_of_each()))
    assert found.one(found.low("1"), found.low("2"))
    assert not found.one(found.rail("1"), found.rail("2"))


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out", "bypassed", "open"])
def test_a_substation_joins_the_rails_of_its_tracks_in_every_state(state):
    rails = rails_of_each()
    found = graph(supply(substations=(station(state=state, return_resistance_ohm=0.1, tracks=("1", "2")),), return_circuit=rails))
    assert found.one(found.rail("1"), found.rail("2"))
    other = graph(supply(substations=(station(state=state, tracks=("1",)),), return_circuit=rails, bonds=(bond_beside(),)))
    assert not other.one(other.rail("1"), other.rail("2"))


@pytest.mark.parametrize(("state", "through"), [("open", False), ("closed", True)])
def test_section_points(state, through):
    found = graph(supply(section_points=(SectionPoint(id="P", track="1", km=7.0, state=state),)))
    assert found.one(found.low("1", 7.0), found.high("1", 7.0)) is through
    assert found.one(found.low("2", 7.0), found.high("2", 7.0))


def test_an_open_point_beside_a_closed_cabin():
    cabin = SectionCabin(id="C", km=10.0)
    point = SectionPoint(id="P", track="1", km=10.0)
    found = graph(supply(section_cabins=(cabin,), section_points=(point,)))
    assert found.one(found.low("1"), found.high("1"))  # by the busbar of the cabin, which takes both sides


# -- spans


def bond_beside():
    """Return a bond at km 5."""
    return Bonds(from_km=5.0, to_km=5.1, every_km=1.0)


def test_spans_between_cuts():
    topology = build_topology(supply(substations=(station(),)), line())
    assert [(span.from_km, span.to_km, len(span.conductors)) for span in topology.spans] == [(0.0, 10.0, 3), (10.0, 20.0, 3)]
    span = topology.spans[0]
    assert [c.ohm_per_m for c in span.conductors] == pytest.approx([5e-5, 5e-5, 1e-5])
    assert span.tracks == ("1", "2")
    assert [span.contact(track) for track in "12"] == [0, 1]
    assert span.rail is span.conductors[2]
    found = Graph(topology)
    assert (span.rail.left, span.rail.right) == (found.rail("1", 0.0), found.rail("2", 10.0))
    assert (span.conductors[1].left, span.conductors[1].right) == (found.high("2", 0.0), found.low("2", 10.0))


def test_returns_of_each_track_make_spans_of_their_own():
    topology = build_topology(supply(return_circuit=rails_of_each(), substations=(station(tracks=("1",)),)), line())
    assert [([*span.tracks], span.from_km, span.to_km) for span in topology.spans] == [
        (["1"], 0.0, 10.0), (["1"], 10.0, 20.0), (["2"], 0.0, 20.0),
    ]  # fmt: skip


def test_groups_of_tracks_that_change_on_the_way():
    rails = (
        ReturnCircuit(tracks=("1", "2"), from_km=0.0, to_km=8.0, resistance_ohm_per_km=0.01),
        ReturnCircuit(tracks=("3",), from_km=0.0, to_km=8.0, resistance_ohm_per_km=0.02),
        ReturnCircuit(tracks=("1",), from_km=8.0, to_km=20.0, resistance_ohm_per_km=0.02),
        ReturnCircuit(tracks=("2", "3"), from_km=8.0, to_km=20.0, resistance_ohm_per_km=0.01),
    )
    found = graph(supply(return_circuit=rails), line("123"))
    assert found.one(*(found.rail("1", 8.0, row) for row in range(4)))  # track 2 links the first and the last
    assert [span.tracks for span in found.topology.spans] == [("1", "2"), ("3",), ("1",), ("2", "3")]


def test_rails_without_resistance_are_one_node():
    rails = (ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0),)
    found = graph(supply(return_circuit=rails, substations=(station(),)))
    assert found.one(found.rail("1", 0.0), found.rail("1", 20.0))
    assert [span.rail.ohm_per_m for span in found.topology.spans] == [0.0, 0.0]


def test_a_change_of_the_contact_line_is_a_cut_and_no_separation():
    wires = (
        ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05),
        ContactLine(from_km=6.0, to_km=20.0, resistance_ohm_per_km=0.08),
    )
    found = graph(supply(contact_lines=wires))
    assert [span.conductors[0].ohm_per_m for span in found.topology.spans] == pytest.approx([5e-5, 8e-5])
    assert found.plainly_one(found.low("1", 6.0), found.high("1", 6.0))


def test_a_gap_of_the_contact_line():
    wires = (
        ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("2",)),
        ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05, tracks=("1",)),
        ContactLine(from_km=9.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("1",)),
    )
    topology = build_topology(supply(contact_lines=wires, substations=(station(km=6.0),)), line())
    assert [span.tracks for span in topology.spans] == [("1", "2"), ("2",), ("1", "2")]
    assert [(link.track, link.side) for link in topology.links] == [("1", "low_km"), ("2", "low_km"), ("2", "high_km")]
    with pytest.raises(LookupError, match="track 1 at km 7"):
        topology.locate("1", 7.0)


def test_devices_less_than_a_metre_apart_share_a_cut():
    devices = (SectionCabin(id="C", km=10.0), SectionCabin(id="D", km=10.0009, state="bypassed"))
    assert [span.to_km for span in build_topology(supply(section_cabins=devices), line()).spans] == [10.0, 20.0]
    devices = (devices[0], SectionCabin(id="D", km=10.0015, state="bypassed"))
    assert [span.to_km for span in build_topology(supply(section_cabins=devices), line()).spans] == [10.0, 10.0015, 20.0]


def test_a_load_stands_on_its_own_side_of_an_open_point():
    """Regression: less than a metre behind an open point it was put before it."""
    topology = build_topology(supply(section_points=(SectionPoint(id="P", track="1", km=10.0),)), line())
    assert topology.locate("1", 9.9995) == (0, pytest.approx(9999.5))
    assert topology.locate("1", 10.0005) == (1, pytest.approx(0.5))
    assert topology.locate("1", 10.0)[0] == 0


def test_a_load_a_little_beyond_the_end_of_the_contact_line():
    wires = (ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05),)
    topology = build_topology(supply(contact_lines=wires), line())
    assert topology.locate("1", 6.0005) == (0, 6000.0)
    with pytest.raises(LookupError):
        topology.locate("1", 6.002)


# -- lengths


def test_chainage_breaks_count_in_lengths():
    broken = line(chainage_breaks=(ChainageBreak(at_km=7.0, continues_as_km=9.0),))
    wires = (
        ContactLine(from_km=0.0, to_km=7.0, resistance_ohm_per_km=0.05),
        ContactLine(from_km=9.0, to_km=20.0, resistance_ohm_per_km=0.05),
    )
    rails = tuple(ReturnCircuit(from_km=w.from_km, to_km=w.to_km, resistance_ohm_per_km=0.01) for w in wires)
    topology = build_topology(supply(contact_lines=wires, return_circuit=rails, substations=(station(km=12.0),)), broken)
    assert sum(span.length_m for span in topology.spans) == pytest.approx(18_000.0)
    assert topology.locate("1", 11.0)[1] == pytest.approx(2000.0)
    whole = build_topology(supply(substations=(station(km=12.0),)), broken)
    assert [span.length_m for span in whole.spans] == pytest.approx([10_000.0, 8_000.0])
    assert whole.locate("1", 9.5)[1] == pytest.approx(7500.0)


def test_a_jump_back_in_the_chainage():
    back = line(chainage_breaks=(ChainageBreak(at_km=7.0, continues_as_km=6.0),))
    topology = build_topology(supply(substations=(station(km=12.0),)), back)
    assert [span.length_m for span in topology.spans] == pytest.approx([13_000.0, 8_000.0])


def test_the_seed_network():
    topology = build_topology(*seed_network([Load(id="x", track="1", km=3.0, power_kw=1.0)]))
    assert [(span.from_km, span.to_km) for span in topology.spans] == [(0.0, 10.0), (10.0, 20.0)]
    assert topology.locate("1", 3.0) == (0, pytest.approx(3000.0))
    places = [(section.track, section.km) for section in topology.sections]
    assert places == [(track, km) for track in "12" for km in (0.0, 10.0, 10.0, 20.0)]  # both sides of the cabin


# -- places that are recorded


def test_sections_are_the_same_in_every_state():
    """What is recorded does not depend on what is switched: rows of a run go into one table."""
    names = []
    for state in ("in_service", "rectifiers_out", "bypassed", "open"):
        points = (SectionPoint(id="P", track="2", km=4.0, state="open" if state == "open" else "closed"),)
        topology = build_topology(supply(substations=(station(state=state),), section_points=points), line())
        names.append([(section.track, section.km) for section in topology.sections])
    assert names[0] == [
        ("1", 0.0), ("1", 4.0), ("1", 10.0), ("1", 10.0), ("1", 20.0),
        ("2", 0.0), ("2", 4.0), ("2", 4.0), ("2", 10.0), ("2", 10.0), ("2", 20.0),
    ]  # fmt: skip
    assert names[1:] == [names[0]] * 3


def test_lengths_are_the_same_at_once_and_one_by_one():
    broken = line(chainage_breaks=(ChainageBreak(at_km=7.0, continues_as_km=9.0),))
    topology = build_topology(
        supply(substations=(station(km=12.3),), section_points=(SectionPoint(id="P", track="1", km=3.7),)), broken
    )
    for span in topology.spans:
        assert span.length_m == topology.distance_m("1", span.from_km, span.to_km)
    assert topology.distance_m("1", -1.0, 25.0) == pytest.approx(18_000.0)  # as far as the track goes
