"""Laws of the network's structure: finer pieces, bonds, branches, rings, leaky rails, states that are switched."""

import numpy as np
import pytest
from dense_places import Places
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from leaky_rails import CONTACT_OHM, RAIL_OHM, leaky_line, open_line_v
from random_networks import draw_network
from solved import LIMITS, Solved, seed_network, tap

from tractionpower.cosimulation.run import Run
from tractionpower.model.earthing import Bonds, Earthing
from tractionpower.model.line import Connection, Line, Track, TrackPoint
from tractionpower.model.scenario import Clock, Scenario
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionPoint, Substation, Supply
from tractionpower.model.switchgear import Feeder, Switch, SwitchEvent
from tractionpower.results.store import MemoryWriter
from tractionpower.supply.states import change_of, with_states

SEEDS = st.integers(0, 2**63 - 1)


def law(examples):
    """Run a test on so many seeds, the same ones every time."""
    return settings(
        max_examples=examples, derandomize=True, deadline=None, database=None,
        phases=[Phase.generate], suppress_health_check=list(HealthCheck),
    )  # fmt: skip


def busy_names(solved):
    """Return the ports whose voltage something holds: they carry current."""
    return [name for name, i in solved.i.items() if abs(i) > 1e-3]


# -- pieces


def halved(supply, line):
    """Return the supply with a closed section point in the middle of every piece that no load stands near."""
    places, points = Places(supply, line), []
    for track, pieces in places.pieces.items():
        for low, high in pieces:
            km = 0.5 * (low + high)
            apart = min(places.way_km(track, low, km), places.way_km(track, km, high)) > 0.002  # a jump may lie between
            if apart and places.exists(track, km) and all(abs(km - load.km) > 0.002 for load in supply.loads):
                points.append(SectionPoint(id=f"half {track} {low}", track=track, km=km, state="closed"))
    return supply.model_copy(update={"section_points": (*supply.section_points, *points)})


@law(80)
@given(seed=SEEDS)
def test_halving_every_piece_changes_nothing(seed):
    supply, line, _ = draw_network(seed)
    loads = tuple(load.model_copy(update={"limits": "range"}) for load in supply.loads)
    supply = supply.model_copy(update={"loads": loads})
    whole, fine = Solved(supply, line), Solved(halved(supply, line), line)
    busy = busy_names(whole)
    assert [fine.u[name] for name in busy] == pytest.approx([whole.u[name] for name in busy], rel=1e-8)
    assert len(fine.rails) >= len(whole.rails)
    for place, volts in whole.rails.items():
        assert fine.rails[place] == pytest.approx(volts, rel=1e-6, abs=1e-4)


# -- leaky rails


@pytest.mark.parametrize("leak", [0.02, 0.1, 0.5, 2.5, 30.0])
def test_a_train_at_every_kilometre_of_leaky_rails(leak):
    """Within 0.1 % of the highest potential at every place, two substations feeding; the closed form takes their currents."""
    length, stations = 24.0, [(5.0, 3600.0), (19.0, 3560.0)]
    for x in np.arange(0.0, length + 0.1, 1.0):
        solved = Solved(*leaky_line([(float(x), 1500.0)], length, leak=leak, stations=stations))
        entering = [(x, 1500.0), *((km, solved.i[name]) for name, (km, _) in zip("AB", stations, strict=True))]
        exact = {km: open_line_v(entering, length, km, RAIL_OHM, leak) for _, km in solved.rails}
        highest = max(abs(open_line_v(entering, length, x, RAIL_OHM, leak)), *map(abs, exact.values()))
        assert len(exact) == 4  # both ends and both substations
        for (_, km), volts in solved.rails.items():
            assert volts == pytest.approx(exact[km], abs=1e-3 * highest)
        drop = (3600.0 + 0.1 * solved.i["A"] - solved.u["T0"]) if x <= stations[0][0] else None
        if drop is not None:  # the contact line between train and substation A, and the rails between
            rails = open_line_v(entering, length, x, RAIL_OHM, leak) - exact[5.0]
            assert drop == pytest.approx(1500.0 * CONTACT_OHM * (5.0 - x) + rails, rel=1e-6)


def test_the_current_that_leaks_is_the_closed_form():
    """What has left the rails of one train's line past the middle: I (1 - 1/cosh(alpha L/2)), printed as 33.42 A."""
    points = (SectionPoint(id="middle", track="1", km=5.0, state="closed"),)
    solved = Solved(*leaky_line([(0.0, 1000.0)], section_points=points))
    rails = {km: volts for (_, km), volts in solved.rails.items()}
    alpha, impedance = np.sqrt(RAIL_OHM * 0.5), np.sqrt(RAIL_OHM / 0.5)
    along = (rails[0.0] - rails[5.0] * np.cosh(5.0 * alpha)) / (impedance * np.sinh(5.0 * alpha))  # that arrives in the middle
    assert rails[5.0] == pytest.approx(0.0, abs=1e-6)
    assert 1000.0 - along == pytest.approx(33.42, abs=5e-3)


# -- bonds


def two_rails(bonds, *, ohm=0.02, leak=0.0):
    """Return two tracks of 12 km with rails of their own, fed from both ends, and a train on the first."""
    whole = {"from_km": 0.0, "to_km": 12.0}
    supply = Supply(
        substations=tuple(
            Substation(id=name, km=km, no_load_voltage_v=3600.0, internal_resistance_ohm=0.12)
            for name, km in (("A", 0.0), ("B", 12.0))
        ),
        contact_lines=(ContactLine(**whole, resistance_ohm_per_km=0.05),),
        return_circuit=tuple(
            ReturnCircuit(**whole, tracks=(track,), resistance_ohm_per_km=ohm, leakage_s_per_km=leak) for track in "12"
        ),
        bonds=bonds,
        loads=(tap("T", 5.005, ampere=1200.0),),
    )
    return supply, Line(tracks=tuple(Track(id=track, **whole) for track in "12"))


@pytest.mark.parametrize("leak", [0.0, 0.4])
def test_bonds_lead_from_separate_rails_to_common_rails(leak):
    """Ever closer bonds without resistance: the voltage rises to that of one conductor with half the resistance."""
    spaced = {km: Solved(*two_rails((Bonds(from_km=0.0, to_km=12.0, every_km=km),), leak=leak)) for km in (6.0, 2.0, 0.4, 0.01)}
    apart = Solved(*two_rails((), leak=leak))
    supply, line = two_rails((), leak=leak)
    row = ReturnCircuit(from_km=0.0, to_km=12.0, resistance_ohm_per_km=0.01, leakage_s_per_km=2.0 * leak)
    common = Solved(supply.model_copy(update={"return_circuit": (row,)}), line)
    volts = [apart.u["T"], *(solved.u["T"] for solved in spaced.values()), common.u["T"]]
    assert np.all(np.diff(volts) > 0.0)
    # Between two bonds 10 m apart the train's current still has one rail of its own: 2.5 m of it more, at most 5 m.
    assert volts[-1] - volts[-2] <= 1200.0 * 0.02 * 0.005
    assert volts[-1] - volts[0] > 5.0


def test_bonds_of_great_resistance_are_no_bonds():
    bonded = Solved(*two_rails((Bonds(from_km=0.0, to_km=12.0, every_km=1.0, resistance_ohm=1e6),)))
    assert bonded.u["T"] == pytest.approx(Solved(*two_rails(())).u["T"], abs=1e-4)


# -- branches and rings


def joined(first, second):
    """Return a connection between two places (track, km)."""
    return Connection(from_=TrackPoint(track=first[0], km=first[1]), to=TrackPoint(track=second[0], km=second[1]))


def laid(tracks, joints, loads, *, leak=0.3, points=(), feeds=(("1", 0.0),)):
    """Return tracks (id, from, to) with equal conductors, joined, fed by like substations at places (track, km)."""
    rows = [{"tracks": (name,), "from_km": low, "to_km": high} for name, low, high in tracks]
    supply = Supply(
        substations=tuple(
            Substation(id=f"S{k}", km=km, tracks=(track,), no_load_voltage_v=3600.0, internal_resistance_ohm=0.12)
            for k, (track, km) in enumerate(feeds)
        ),
        contact_lines=tuple(ContactLine(**row, resistance_ohm_per_km=0.05) for row in rows),
        return_circuit=tuple(ReturnCircuit(**row, resistance_ohm_per_km=0.01, leakage_s_per_km=leak) for row in rows),
        section_points=points,
        loads=tuple(tap(f"T{k}", km, track=track, kw=kw) for k, (track, km, kw) in enumerate(loads)),
    )
    line = Line(
        tracks=tuple(Track(id=name, from_km=low, to_km=high) for name, low, high in tracks),
        connections=tuple(joined(*joint) for joint in joints),
    )
    return supply, line


def test_a_line_in_two_pieces_is_one_line():
    whole = Solved(*laid([("1", 0.0, 20.0)], (), [("1", 6.0, 900.0), ("1", 17.0, 1400.0)], feeds=(("1", 0.0), ("1", 15.0))))
    pieces = [("1", 0.0, 8.0), ("b", 108.0, 120.0)]
    split = Solved(
        *laid(pieces, [(("b", 108.0), ("1", 8.0))], [("1", 6.0, 900.0), ("b", 117.0, 1400.0)], feeds=(("1", 0.0), ("b", 115.0)))
    )
    assert list(split.u.values()) == pytest.approx(list(whole.u.values()), rel=1e-10)
    assert split.rails["b", 120.0] == pytest.approx(whole.rails["1", 20.0], abs=1e-6)


def test_a_branch_without_length_changes_nothing():
    """A metre and a half of branch with no train, and a train at its end, which is as good as on the trunk."""
    loads = [("1", 6.0, 900.0), ("1", 17.0, 1400.0)]
    plain = Solved(*laid([("1", 0.0, 20.0)], (), loads))
    tracks, joint = [("1", 0.0, 20.0), ("b", 50.0, 50.0015)], [(("b", 50.0), ("1", 17.0))]
    stub = Solved(*laid(tracks, joint, loads))
    assert list(stub.u.values()) == pytest.approx(list(plain.u.values()), rel=1e-6)
    ended = Solved(*laid(tracks, joint, [("1", 6.0, 900.0), ("b", 50.0015, 1400.0)]))
    assert ended.u["T1"] == pytest.approx(plain.u["T1"], abs=1.5 * 0.06 * 0.0015 * 1400e3 / plain.u["T1"])


RING = [("1", 0.0, 12.0), ("b", 50.0, 58.0)]
RING_JOINTS = [(("1", 0.0), ("b", 50.0)), (("1", 12.0), ("b", 58.0))]


@pytest.mark.parametrize("km", [1.0, 4.0, 9.0, 11.0])
def test_a_ring_feeds_from_both_ways(km):
    """A train x km from the substation on a ring of 20 km sees x (20 - x)/20 km of line."""
    solved = Solved(*laid(RING, RING_JOINTS, [("1", km, 1000.0)], leak=0.0))
    loop = 0.12 + 0.06 * km * (20.0 - km) / 20.0
    assert solved.u["T0"] == pytest.approx(0.5 * (3600.0 + np.sqrt(3600.0**2 - 4.0 * loop * 1e6)), rel=1e-9)


@pytest.mark.parametrize("leak", [0.0, 0.4])
def test_a_ring_cut_open_is_a_line(leak):
    """Without the second joint, the branch hangs on km 0 of the trunk, where the substation is: a line seen from its middle."""
    loads = [("1", 9.0, 1200.0), ("b", 56.0, 800.0)]
    cut = Solved(*laid(RING, RING_JOINTS[:1], loads, leak=leak))
    line = Solved(*laid([("1", -8.0, 12.0)], (), [("1", 9.0, 1200.0), ("1", -6.0, 800.0)], leak=leak))
    assert list(cut.u.values()) == pytest.approx(list(line.u.values()), rel=1e-10)
    assert Solved(*laid(RING, RING_JOINTS, loads, leak=leak)).u["T0"] > cut.u["T0"] + 1.0


def test_a_ring_whose_contact_line_is_cut_open():
    """The rails stay a ring: the train's current comes one way and goes back both ways."""
    points = (SectionPoint(id="P", track="b", km=52.0),)
    solved = Solved(*laid(RING, RING_JOINTS, [("b", 54.0, 1000.0)], leak=0.0, points=points))
    loop = 0.12 + 0.05 * 16.0 + 0.01 * 4.0 * 16.0 / 20.0
    assert solved.u["T0"] == pytest.approx(0.5 * (3600.0 + np.sqrt(3600.0**2 - 4.0 * loop * 1e6)), rel=1e-9)


def test_islands_do_not_feel_each_other():
    """Two lines without a joint, solved at once as alone; one of them knows remote earth, the other does not."""
    alone = [
        Solved(*laid([("1", 0.0, 20.0)], (), [("1", 13.0, 1100.0)])),
        Solved(*laid([("b", 50.0, 58.0)], (), [("b", 55.0, 700.0)], leak=0.0, feeds=(("b", 52.0),))),
    ]
    supply, line = laid(
        [("1", 0.0, 20.0), ("b", 50.0, 58.0)], (), [("1", 13.0, 1100.0), ("b", 55.0, 700.0)], feeds=(("1", 0.0), ("b", 52.0))
    )
    rows = tuple(
        row.model_copy(update={"leakage_s_per_km": 0.3 if row.tracks == ("1",) else 0.0}) for row in supply.return_circuit
    )
    both = Solved(supply.model_copy(update={"return_circuit": rows}), line)
    assert [both.u["S0"], both.u["T0"]] == pytest.approx(list(alone[0].u.values()), rel=1e-10)
    assert [both.u["S1"], both.u["T1"]] == pytest.approx(list(alone[1].u.values()), rel=1e-10)
    assert both.rails["1", 20.0] == pytest.approx(alone[0].rails["1", 20.0], abs=1e-6)
    assert ("b", 58.0) not in both.rails


# -- switching by events equals studies with the states set

SWITCH_S = 5.0
EVENTS = [
    {"device": "A 1 high_km", "state": "open"},
    {"device": "C", "state": "bypassed"},
    {"device": "C", "state": "open"},
    {"device": "A", "state": "rectifiers_out"},
    {"device": "A", "state": "bypassed"},
    {"device": "A", "state": "open"},
    {"device": "B", "units_in_service": 1},
    {"device": "B", "units_in_service": 0},
    {"device": "P", "state": "closed"},
    {"device": "W", "state": "closed"},
    {"device": "V", "state": "closed"},
]


def switched_supply():
    """Return the published network with breakers, an open section point and tie, leaky rails, a device to earth."""
    loads = [
        tap(f"{track}-{km}", km, track=track, kw=kw + 70.0 * km)
        for track, kw in (("1", 900.0), ("2", 1800.0))
        for km in (4.0, 13.0)
    ]
    supply, line = seed_network(loads, units=2, grid_resistance_ohm=0.03, feeder_resistance_ohm=0.01)
    ends = {"from": {"track": "1", "km": 7.0}, "to": {"track": "2", "km": 7.0}}
    limiter = {"id": "V", "track": "1", "km": 0.0, "closes": [{"above_v": 1e4}], "closed_resistance_ohm": 0.05}
    leaky = supply.return_circuit[0].model_copy(update={"leakage_s_per_km": 0.4})
    more = {
        "return_circuit": (leaky,),
        "section_points": (SectionPoint(id="P", track="2", km=16.0),),
        "switches": (Switch.model_validate({"id": "W", "state": "open", "resistance_ohm": 0.01} | ends),),
        "voltage_limiting_devices": (limiter,),
        "earthing": (Earthing(id="E", substation="B", resistance_ohm=2.0),),
        "feeders": (Feeder(at="B", track="1", side="low_km", resistance_ohm=0.02),),
    }
    return Supply.model_validate(supply.model_dump(by_alias=True) | {key: tuple(rows) for key, rows in more.items()}), line


def recorded(supply, line, end_s):
    """Run a supply from 0 to `end_s` and return its rows with voltages and currents, by table, time and device."""
    clock = Clock(start=0.0, end=end_s, step_s=1.0)
    writer = MemoryWriter()
    assert not Run(Scenario(line=line, supply=supply, clock=clock, limits=LIMITS), writer).execute().flagged
    found = {}
    for table, keys in (("substations", ("substation",)), ("loads", ("load",)), ("feeders", ("substation", "track", "side"))):
        for row in writer.tables()[table].to_pylist():
            numbers = {name: row[name] for name in ("voltage_v", "current_a", "power_kw") if row.get(name) is not None}
            found[table, row["time_s"], *(row[key] for key in keys)] = numbers
    return found


@pytest.mark.parametrize(
    "event", EVENTS, ids=lambda event: f"{event['device']} {event.get('state', event.get('units_in_service'))}"
)
def test_switching_by_events_equals_studies_joined(event):
    supply, line = switched_supply()
    moved = SwitchEvent(time=SWITCH_S, **event)
    there_and_back = recorded(supply.model_copy(update={"switch_events": (moved,)}), line, 2.0 * SWITCH_S)
    before = recorded(supply, line, SWITCH_S)
    after = recorded(with_states(supply, {moved.device: [change_of(moved)]}), line, SWITCH_S)
    joined_rows = before | {(table, time_s + SWITCH_S, *rest): row for (table, time_s, *rest), row in after.items()}
    assert there_and_back.keys() == joined_rows.keys()
    for key, row in joined_rows.items():
        assert there_and_back[key] == pytest.approx(row, rel=1e-6, abs=1e-6, nan_ok=True), key
    key = ("loads", 2.0 * SWITCH_S - 1.0, "1-4.0")
    assert there_and_back[key] != pytest.approx(before["loads", 0.0, "1-4.0"], rel=1e-6) or event["device"] == "V"
