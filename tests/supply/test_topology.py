"""Which conductors meet in which node, for every state of every switch."""

import pytest
from solved import seed_network

from tractionpower.model.line import ChainageBreak, Line, Track
from tractionpower.model.supply import ContactLine, Load, ReturnCircuit, SectionCabin, SectionPoint, Substation, Supply
from tractionpower.supply.topology import SHORT_OHM, Merger, build_topology


def line(tracks="12", low=0.0, high=20.0, **more):
    return Line(tracks=tuple(Track(id=t, from_km=low, to_km=high) for t in tracks), **more)


def station(name="S", km=10.0, **more):
    return Substation(**({"id": name, "km": km, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12} | more))


def supply(**more):
    good = {
        "contact_lines": (ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05),),
        "return_circuit": (ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.01),),
    }
    return Supply(**(good | more))


def joined(topology, first, second):
    return topology.nodes.find(first) == topology.nodes.find(second)


def low(track, km=10.0):
    return "low", track, km


def high(track, km=10.0):
    return "high", track, km


def edges(topology, *ends):
    """Return the resistances between two nodes."""
    wanted = {topology.nodes.find(end) for end in ends}
    return [ohm for a, b, ohm in topology.edges if {topology.nodes.find(a), topology.nodes.find(b)} == wanted]


# -- substations


@pytest.mark.parametrize(
    ("state", "through", "tied", "stands"),
    [("in_service", True, True, True), ("rectifiers_out", True, True, True), ("bypassed", True, False, False),
     ("open", False, False, False)],
)  # fmt: skip
def test_states_of_a_substation(state, through, tied, stands):
    topology = build_topology(supply(substations=(station(state=state),)), line())
    assert joined(topology, low("1"), high("1")) is through
    assert joined(topology, low("1"), low("2")) is tied
    assert ("S" in topology.busbars) is stands
    assert len(topology.feeders) == (4 if stands else 0)
    if stands:
        assert joined(topology, ("positive", "S"), high("2"))
        assert joined(topology, ("negative", "S"), ("rail", 0, 10.0))


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out"])
def test_feeders_with_resistance_separate_the_sides(state):
    one = station(state=state, feeder_resistance_ohm=0.02, return_resistance_ohm=0.03)
    topology = build_topology(supply(substations=(one,)), line())
    nodes = [low("1"), high("1"), low("2"), high("2")]
    assert len({topology.nodes.find(node) for node in nodes}) == 4
    for node in nodes:
        assert edges(topology, ("positive", "S"), node) == [0.02]
    assert edges(topology, ("negative", "S"), ("rail", 0, 10.0)) == [0.03]
    assert len(topology.edges) == 5


def test_a_resistance_too_small_to_matter_is_none():
    topology = build_topology(supply(substations=(station(feeder_resistance_ohm=0.5 * SHORT_OHM),)), line())
    assert topology.edges == []
    assert joined(topology, low("1"), high("2"))


def test_feeders_are_listed_by_substation_track_and_side():
    topology = build_topology(
        supply(substations=(station("B", 20.0), station("A", 0.0), station("M", 5.0, tracks=("2",)))), line()
    )
    assert [(f.substation, f.track, f.side, f.km) for f in topology.feeders] == [
        ("A", "1", "high_km", 0.0), ("A", "2", "high_km", 0.0),
        ("B", "1", "low_km", 20.0), ("B", "2", "low_km", 20.0),
        ("M", "2", "high_km", 5.0), ("M", "2", "low_km", 5.0),
    ]  # fmt: skip


def test_a_substation_of_one_track_leaves_the_other_alone():
    topology = build_topology(supply(substations=(station(tracks=("1",), feeder_resistance_ohm=0.02),)), line())
    assert not joined(topology, low("1"), high("1"))
    assert joined(topology, low("2"), high("2"))


# -- cabins and section points


@pytest.mark.parametrize(
    ("state", "through", "tied"), [("closed", True, True), ("bypassed", True, False), ("open", False, False)]
)
def test_states_of_a_cabin(state, through, tied):
    topology = build_topology(supply(section_cabins=(SectionCabin(id="C", km=10.0, state=state),)), line())
    assert joined(topology, low("1"), high("1")) is through
    assert joined(topology, low("1"), low("2")) is tied
    assert joined(topology, high("1"), high("2")) is tied


def test_a_cabin_joins_contact_lines_never_rails():
    rails = tuple(ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02) for t in "12")
    topology = build_topology(supply(section_cabins=(SectionCabin(id="C", km=10.0),), return_circuit=rails), line())
    assert joined(topology, low("1"), low("2"))
    assert not joined(topology, ("rail", 0, 10.0), ("rail", 1, 10.0))


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out", "bypassed", "open"])
def test_a_substation_joins_the_rails_of_its_tracks_in_every_state(state):
    rails = tuple(ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02) for t in "12")
    topology = build_topology(
        supply(substations=(station(state=state, return_resistance_ohm=0.1),), return_circuit=rails), line()
    )
    assert joined(topology, ("rail", 0, 10.0), ("rail", 1, 10.0))
    other = build_topology(supply(substations=(station(state=state, tracks=("1",)),), return_circuit=rails), line())
    assert not joined(other, ("rail", 0, 10.0), ("rail", 1, 10.0))


@pytest.mark.parametrize(("state", "through"), [("open", False), ("closed", True)])
def test_section_points(state, through):
    topology = build_topology(supply(section_points=(SectionPoint(id="P", track="1", km=7.0, state=state),)), line())
    assert joined(topology, low("1", 7.0), high("1", 7.0)) is through
    assert joined(topology, low("2", 7.0), high("2", 7.0))


def test_an_open_point_beside_a_closed_cabin():
    cabin = SectionCabin(id="C", km=10.0)
    point = SectionPoint(id="P", track="1", km=10.0)
    topology = build_topology(supply(section_cabins=(cabin,), section_points=(point,)), line())
    assert joined(topology, low("1"), high("1"))  # by the busbar of the cabin, which takes both sides


# -- spans


def test_spans_between_cuts():
    topology = build_topology(supply(substations=(station(),)), line())
    assert [(span.from_km, span.to_km, len(span.conductors)) for span in topology.spans] == [(0.0, 10.0, 3), (10.0, 20.0, 3)]
    span = topology.spans[0]
    assert [c.ohm_per_m for c in span.conductors] == pytest.approx([5e-5, 5e-5, 1e-5])
    assert span.returns == {"1": 2, "2": 2}
    assert [span.contact(track) for track in "12"] == [0, 1]
    assert span.conductors[2].name == ("rail", "0")


def test_returns_of_each_track_make_spans_of_their_own():
    rails = tuple(ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02) for t in "12")
    topology = build_topology(supply(return_circuit=rails, substations=(station(tracks=("1",)),)), line())
    assert [(sorted(span.returns), span.from_km, span.to_km) for span in topology.spans] == [
        (["1"], 0.0, 10.0), (["1"], 10.0, 20.0), (["2"], 0.0, 20.0),
    ]  # fmt: skip


def test_groups_of_tracks_that_change_on_the_way():
    rails = (
        ReturnCircuit(tracks=("1", "2"), from_km=0.0, to_km=8.0, resistance_ohm_per_km=0.01),
        ReturnCircuit(tracks=("3",), from_km=0.0, to_km=8.0, resistance_ohm_per_km=0.02),
        ReturnCircuit(tracks=("1",), from_km=8.0, to_km=20.0, resistance_ohm_per_km=0.02),
        ReturnCircuit(tracks=("2", "3"), from_km=8.0, to_km=20.0, resistance_ohm_per_km=0.01),
    )
    topology = build_topology(supply(return_circuit=rails), line("123"))
    assert len({topology.nodes.find(("rail", k, 8.0)) for k in range(4)}) == 1  # track 2 links the first and the last
    assert [sorted(span.returns) for span in topology.spans] == [["1", "2"], ["3"], ["1"], ["2", "3"]]


def test_rails_without_resistance_are_one_node():
    rails = (ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0),)
    topology = build_topology(supply(return_circuit=rails, substations=(station(),)), line())
    assert joined(topology, ("rail", 0, 0.0), ("rail", 0, 20.0))
    assert [span.conductors[-1].ohm_per_m for span in topology.spans] == [0.0, 0.0]


def test_a_change_of_the_contact_line_is_a_cut_and_no_separation():
    wires = (
        ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05),
        ContactLine(from_km=6.0, to_km=20.0, resistance_ohm_per_km=0.08),
    )
    topology = build_topology(supply(contact_lines=wires), line())
    assert [span.conductors[0].ohm_per_m for span in topology.spans] == pytest.approx([5e-5, 8e-5])
    assert joined(topology, low("1", 6.0), high("1", 6.0))


def test_a_gap_of_the_contact_line():
    wires = (
        ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("2",)),
        ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05, tracks=("1",)),
        ContactLine(from_km=9.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("1",)),
    )
    topology = build_topology(supply(contact_lines=wires, substations=(station(km=6.0),)), line())
    assert [sorted(span.returns) for span in topology.spans] == [["1", "2"], ["2"], ["1", "2"]]
    assert [(f.track, f.side) for f in topology.feeders] == [("1", "low_km"), ("2", "high_km"), ("2", "low_km")]
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
    assert {track for track, *_ in topology.sections} == {"1", "2"}
    assert [(track, km) for track, km, _, _ in topology.sections][:4] == [("1", 0.0), ("1", 10.0), ("2", 0.0), ("2", 10.0)]


def test_a_merger_names_the_smallest():
    merger = Merger()
    merger.join("c", "b")
    merger.join("b", "a")
    assert merger.find("c") == "a"
    assert merger.find("z") == "z"
