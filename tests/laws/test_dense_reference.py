"""The judge is judged: the dense reference against closed forms and published numbers."""

import numpy as np
import pytest
from dense_network import DenseNetwork, two_port
from dense_reference import DenseSolver, Ports, balance
from leaky_rails import CONTACT_OHM, RAIL_OHM, chained_v, leaky_line, open_line_v
from solved import LIMITS, seed_network, tap

from tractionpower.model.earthing import Bonds, Earthing, VoltageLimitingDevice
from tractionpower.model.line import ChainageBreak, Connection, Line, Track, TrackPoint
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionPoint, Substation, Supply
from tractionpower.model.switchgear import Feeder, Switch


class Judged:
    """A network as the reference solves it, by the names of places and devices."""

    def __init__(self, supply, line):
        self.network = DenseNetwork(supply, line, LIMITS)
        solver = DenseSolver(self.network)
        self.v, continued = solver.solve()
        u = solver.voltages(self.v)
        np.testing.assert_allclose(solver.voltages(continued), u, rtol=0.0, atol=1e-6)
        assert self.network.live.all()
        assert np.abs(balance(self.network, self.v, u)).max() < 1e-6
        names = [item.id for item in (*self.network.sources, *self.network.loads)]
        self.u = dict(zip(names, u.tolist(), strict=True))
        count = len(self.network.sources)
        self.fed_a = dict(zip(names, (-Ports(self.network).sources(u[:count])[0]).tolist(), strict=False))

    def rail_v(self, km, track="1"):
        return float(self.v[self.network.node(self.network.rail(track, km))])


def change(supply, **fields):
    return supply.model_copy(update=fields)


# -- leaky rails


@pytest.mark.parametrize(("leak", "volts"), [(0.1, 27.37), (0.5, 26.89), (2.5, 24.73)])
def test_one_train_at_the_end_of_leaky_rails_as_printed(leak, volts):
    judged = Judged(*leaky_line([(0.0, 1000.0)], leak=leak))
    assert judged.rail_v(0.0) == pytest.approx(volts, abs=5e-3)
    alpha, impedance = np.sqrt(RAIL_OHM * leak), np.sqrt(RAIL_OHM / leak)
    exact = 1000.0 * impedance * np.tanh(5.0 * alpha)
    assert judged.rail_v(0.0) == pytest.approx(exact, abs=1e-6)
    assert judged.rail_v(10.0) == pytest.approx(-exact, abs=1e-6)


@pytest.mark.parametrize("seed", range(12))
def test_any_trains_and_substations_along_leaky_rails(seed):
    """By superposition of the closed form; what the substations feed is taken from the solution itself."""
    rng = np.random.default_rng(seed)
    length, leak, ohm = rng.uniform(5.0, 60.0), 10.0 ** rng.uniform(-2.0, 1.0), rng.uniform(0.004, 0.03)
    loads = [(float(rng.uniform(0.0, length)), float(rng.uniform(50.0, 600.0))) for _ in range(rng.integers(1, 6))]
    stations = [(float(rng.uniform(0.0, length)), 3600.0 + 40.0 * k) for k in range(rng.integers(1, 4))]
    judged = Judged(*leaky_line(loads, length, leak=leak, ohm=ohm, stations=stations))
    entering = loads + [(km, -judged.fed_a["ABC"[k]]) for k, (km, _) in enumerate(stations)]
    for km, _ in stations:
        assert judged.rail_v(km) == pytest.approx(open_line_v(entering, length, km, ohm, leak), abs=1e-5)
    for k, (km, _) in enumerate(loads):
        rail = judged.v[judged.network.node(judged.network.load_node(judged.network.loads[k])[1])]
        assert rail == pytest.approx(open_line_v(entering, length, km, ohm, leak), abs=1e-5)


def test_rails_so_long_that_their_ends_do_not_matter():
    """Half of the current goes either way: I Zc/2 beside the train, less what the substation takes off."""
    judged = Judged(*leaky_line([(200.0, 1000.0)], 400.0, stations=[(215.0, 3600.0)]))
    alpha, impedance = np.sqrt(RAIL_OHM * 0.5), np.sqrt(RAIL_OHM / 0.5)
    at = judged.v[judged.network.node(judged.network.load_node(judged.network.loads[0])[1])]
    assert at == pytest.approx(500.0 * impedance * (1.0 - np.exp(-15.0 * alpha)), rel=1e-8)


@pytest.mark.parametrize("state", ["open", "closed"])
def test_rails_of_two_kinds_earthed_at_both_ends(state):
    """By chain matrices; an earthing at one end, a closed voltage-limiting device at the other."""
    returns = [
        ReturnCircuit(from_km=0.0, to_km=8.0, resistance_ohm_per_km=0.006, leakage_s_per_km=0.3),
        ReturnCircuit(from_km=8.0, to_km=20.0, resistance_ohm_per_km=0.011, leakage_s_per_km=2.0),
    ]
    limiter = VoltageLimitingDevice(
        id="V", track="1", km=20.0, closes=({"above_v": 60.0},), closed_resistance_ohm=0.05, state=state
    )
    devices = {
        "return_circuit": returns,
        "earthing": (Earthing(id="E", track="1", km=0.0, resistance_ohm=0.2),),
        "voltage_limiting_devices": (limiter,),
    }
    judged = Judged(*leaky_line([(6.0, 800.0)], 20.0, stations=[(15.0, 3600.0)], **devices))
    sections = [(8.0, 0.006, 0.3), (20.0, 0.011, 2.0)]
    expected = chained_v([(6.0, 800.0), (15.0, -800.0)], sections, (0.2, 0.05 if state == "closed" else np.inf))
    for km in (0.0, 8.0, 15.0, 20.0):
        assert judged.rail_v(km) == pytest.approx(expected[km], abs=1e-6)
    loop = CONTACT_OHM * 9.0
    assert judged.u["T0"] == pytest.approx(3600.0 - 80.0 - 800.0 * loop - (expected[6.0] - expected[15.0]), abs=1e-6)


def test_the_chain_matrices_know_the_closed_form():
    """The checks above rest on two forms; here they meet."""
    injections = [(0.0, 900.0), (7.0, 300.0), (16.0, -1200.0)]
    chained = chained_v(injections, [(16.0, 0.008, 0.4)], (np.inf, np.inf))
    for km in (0.0, 7.0, 16.0):
        assert chained[km] == pytest.approx(open_line_v(injections, 16.0, km, 0.008, 0.4), rel=1e-10)


def test_an_earthed_negative_busbar_takes_the_potential_off_the_substation():
    """The whole current returns through the rails: nothing flows through the only earthing of rails that do not leak."""
    supply, line = leaky_line([(0.0, 1000.0)], leak=0.0, earthing=(Earthing(id="E", substation="A", resistance_ohm=5.0),))
    judged = Judged(supply, line)
    assert judged.rail_v(10.0) == pytest.approx(0.0, abs=1e-6)
    assert judged.rail_v(0.0) == pytest.approx(1000.0 * RAIL_OHM * 10.0, rel=1e-9)


@pytest.mark.parametrize(("ohm", "leak"), [(0.06, 5.0), (1e-4, 3.0), (0.5, 1e-3), (1e-5, 1e-6)])
def test_the_two_port_of_a_leaky_piece(ohm, leak):
    angle, impedance = np.sqrt(ohm * leak), np.sqrt(ohm / leak)
    series, shunt = two_port(ohm, leak)
    assert series == pytest.approx(1.0 / (impedance * np.sinh(angle)), rel=1e-12)
    assert shunt == pytest.approx(np.tanh(0.5 * angle) / impedance, rel=1e-12)


# -- feeders, cabins, switches


def test_four_trains_of_the_published_network():
    loads = [tap(f"{track}{km}", km, track=track, kw=3000.0) for track in "12" for km in (5.0, 15.0)]
    judged = Judged(*seed_network(loads))
    expected = 0.5 * (3600.0 + np.sqrt(3600.0**2 - 4.0 * 0.59 * 3e6))
    assert [judged.u[load.id] for load in loads] == pytest.approx([expected] * 4, rel=1e-9)
    assert judged.fed_a["A"] == pytest.approx(1991.744, abs=1e-3)


@pytest.mark.parametrize(("km", "volts"), [(0.0, 3446.15), (8.0, 2869.81), (20.0, 2005.29)])
def test_one_sided_feeding_as_published(km, volts):
    """S. Yoo, BSc thesis, Warsaw University of Technology 2024, section 5.1; its feeders as rows of their own."""
    station = Substation(id="A", km=0.0, no_load_voltage_v=3571.2549, internal_resistance_ohm=0.0737211)
    supply = Supply(
        substations=(station,),
        contact_lines=(ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0613),),
        return_circuit=(ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0107431),),
        feeders=(
            Feeder(at="A", track="1", side="high_km", resistance_ohm=0.0210),
            Feeder(at="A", track="1", side="return", resistance_ohm=0.0303819),
        ),
        loads=(tap("train", km, ampere=1000.0, limits="none"),),
    )
    judged = Judged(supply, Line(tracks=(Track(id="1", from_km=0.0, to_km=20.0),)))
    assert judged.u["train"] == pytest.approx(volts, abs=5.5e-3)


@pytest.mark.parametrize("feeder", [0.0, 0.03])
def test_a_train_at_a_cabin_with_feeders(feeder):
    """By symmetry: 750 A come from each side, of which a share takes the way over the cabin's busbar."""
    supply, line = seed_network([tap("T", 5.0, ampere=1500.0)])
    cabin = supply.section_cabins[0].model_copy(update={"feeder_resistance_ohm": feeder})
    judged = Judged(change(supply, section_cabins=(cabin,)), line)
    half = 10.0 * 0.05
    # Around the train: direct 5 km to A; or 5 km to the cabin, and from its busbar three ways on: two to B, one to A.
    ohm = {"TA": 0.25, "TC": 0.25 + feeder, "CA": feeder + half, "CB": 0.5 * (feeder + half)}
    g = np.zeros((4, 4))  # nodes: train, busbar of the cabin, A, B; rails beside them give the same drop as a common wire
    for (i, j), r in zip(((0, 2), (0, 1), (1, 2), (1, 3)), ohm.values(), strict=True):
        g[[i, j, i, j], [i, j, j, i]] += np.array([1.0, 1.0, -1.0, -1.0]) / r
    # rails: train at 5 km between A and B over 0.05 and 0.15 ohm, sources of 0.12 ohm behind both ends
    full = np.zeros((7, 7))
    full[:4, :4] = g
    for i, j, r in ((4, 5, 0.05), (4, 6, 0.15), (2, 5, 0.12), (3, 6, 0.12)):
        full[[i, j, i, j], [i, j, j, i]] += np.array([1.0, 1.0, -1.0, -1.0]) / r
    right = np.zeros(7)
    right[[2, 3]] += 3600.0 / 0.12
    right[[5, 6]] -= 3600.0 / 0.12
    right[[0, 4]] += [-1500.0, 1500.0]
    keep = [0, 1, 2, 3, 4, 6]
    v = np.zeros(7)
    v[keep] = np.linalg.solve(full[np.ix_(keep, keep)], right[keep])
    assert judged.u["T"] == pytest.approx(v[0] - v[4], abs=1e-6)
    if feeder == 0.0:
        assert judged.u["T"] == pytest.approx(3600.0 - 0.264920 * 1500.0, abs=2e-3)


def test_an_open_feeder_feeds_from_the_other_end():
    supply, line = seed_network([tap("T", 6.0, ampere=700.0)], "bypassed")
    rows = tuple(Feeder(at="A", track=track, side="high_km", state="open") for track in "12")
    judged = Judged(change(supply, feeders=rows, section_cabins=()), line)
    assert judged.fed_a == {"A": pytest.approx(0.0, abs=1e-6), "B": pytest.approx(700.0)}
    assert judged.u["T"] == pytest.approx(3600.0 - 700.0 * (0.12 + 14.0 * 0.06))


def test_switches_bridge_cuts_and_tie_tracks():
    """An open section point is bridged by 0.1 ohm; a tie at km 20 leads on to the other track, cut from its own feeder."""
    supply, line = seed_network([tap("T", 4.0, track="2", ampere=500.0)], "bypassed")
    ends = [{"track": "1", "km": 8.0, "side": side} for side in ("low_km", "high_km")]
    switches = (
        Switch.model_validate({"id": "bridge", "from": ends[0], "to": ends[1], "resistance_ohm": 0.1}),
        Switch.model_validate({"id": "tie", "from": {"track": "1", "km": 12.0}, "to": {"track": "2", "km": 12.0}}),
    )
    cuts = tuple(SectionPoint(id=f"P{t}", track=t, km=km) for t, km in (("1", 8.0), ("2", 16.0)))
    dead = tuple(Feeder(at=s, track="2", side=side, state="open") for s, side in (("A", "high_km"), ("B", "low_km")))
    no_b = (supply.substations[0], supply.substations[1].model_copy(update={"units_in_service": 0}))
    judged = Judged(change(supply, substations=no_b, switches=switches, section_points=cuts, feeders=dead), line)
    assert judged.u["T"] == pytest.approx(3600.0 - 500.0 * (0.12 + 12.0 * 0.05 + 0.1 + 8.0 * 0.05 + 4.0 * 0.01))


@pytest.mark.parametrize(("units", "on", "ohm"), [(2, 1, 0.22), (2, 2, 0.12), (3, None, 0.12), (4, 1, 0.42)])
def test_units_in_service(units, on, ohm):
    """R(k) = R_unit/k + R_grid with 0.02 ohm in the grid."""
    plant = {"units": units, "units_in_service": on, "grid_resistance_ohm": 0.02}
    supply, line = seed_network([tap("T", 0.0, ampere=100.0)], **plant)
    judged = Judged(change(supply, substations=supply.substations[:1]), line)
    assert judged.u["T"] == pytest.approx(3600.0 - 100.0 * ohm)


# -- bonds, branches, breaks


def test_bonds_join_the_rails_of_neighbouring_tracks():
    """A bond of 0.01 ohm at km 4 and 8; the current of track 1 goes back by both rails, by hand."""
    line = Line(tracks=tuple(Track(id=t, from_km=0.0, to_km=8.0) for t in "12"))
    whole = {"from_km": 0.0, "to_km": 8.0}
    supply = Supply(
        substations=(Substation(id="A", km=0.0, no_load_voltage_v=3600.0, internal_resistance_ohm=0.1),),
        contact_lines=(ContactLine(**whole, resistance_ohm_per_km=0.05),),
        return_circuit=tuple(ReturnCircuit(**whole, tracks=(t,), resistance_ohm_per_km=0.02) for t in "12"),
        bonds=(Bonds(from_km=4.0, to_km=8.0, every_km=4.0, resistance_ohm=0.01),),
        loads=(tap("T", 8.0, ampere=100.0),),
    )
    judged = Judged(supply, line)
    upper = 1.0 / (1.0 / 0.08 + 1.0 / (0.01 + 0.08))  # km 8: own rail, or over the bond and the other rail to its bond
    rail = np.zeros((4, 4))  # track 1 at km 8 and 4, track 2 at km 8 and 4; km 0 is the reference
    for i, j, r in ((0, 1, 0.08), (2, 3, 0.08), (0, 2, 0.01), (1, 3, 0.01), (1, None, 0.08), (3, None, 0.08)):
        rail[i, i] += 1.0 / r
        if j is not None:
            rail[j, j] += 1.0 / r
            rail[[i, j], [j, i]] -= 1.0 / r
    drop = np.linalg.solve(rail, [100.0, 0.0, 0.0, 0.0])[0]
    assert 100.0 * upper < drop < 100.0 * 0.16
    assert judged.u["T"] == pytest.approx(3600.0 - 10.0 - 40.0 - drop, abs=1e-9)


def test_a_branch_of_other_kilometres_behind_a_jump():
    """2 km of trunk, of which a jump leaves out 0.5 km; then 3 km of branch whose own jump back adds 0.4 km."""
    line = Line(
        tracks=(Track(id="1", from_km=0.0, to_km=10.0), Track(id="b", from_km=100.0, to_km=103.0)),
        connections=(Connection(from_=TrackPoint(track="1", km=2.0), to=TrackPoint(track="b", km=100.0)),),
        chainage_breaks=(
            ChainageBreak(at_km=1.0, continues_as_km=1.5, tracks=("1",)),
            ChainageBreak(at_km=101.0, continues_as_km=100.6, tracks=("b",)),
        ),
    )
    supply = Supply(
        substations=(Substation(id="A", km=0.0, no_load_voltage_v=3600.0, internal_resistance_ohm=0.1),),
        contact_lines=tuple(
            ContactLine(from_km=low, to_km=high, resistance_ohm_per_km=0.05) for low, high in ((0.0, 10.0), (100.0, 103.0))
        ),
        return_circuit=tuple(
            ReturnCircuit(from_km=low, to_km=high, tracks=(t,), resistance_ohm_per_km=0.01)
            for t, low, high in (("1", 0.0, 10.0), ("b", 100.0, 103.0))
        ),
        loads=(tap("T", 103.0, track="b", ampere=100.0),),
    )
    assert Judged(supply, line).u["T"] == pytest.approx(3600.0 - 10.0 - 100.0 * 0.06 * (1.5 + 3.4))


def test_a_distant_feeder_feeds_another_line_and_takes_its_rails():
    """Substation A feeds the isolated track b at its km 101, to the side of higher kilometres, with a return of its own."""
    line = Line(tracks=(Track(id="1", from_km=0.0, to_km=10.0), Track(id="b", from_km=100.0, to_km=103.0)))
    supply = Supply(
        substations=(Substation(id="A", km=0.0, no_load_voltage_v=3600.0, internal_resistance_ohm=0.1),),
        contact_lines=tuple(
            ContactLine(from_km=low, to_km=high, resistance_ohm_per_km=0.05) for low, high in ((0.0, 10.0), (100.0, 103.0))
        ),
        return_circuit=tuple(
            ReturnCircuit(from_km=low, to_km=high, tracks=(t,), resistance_ohm_per_km=0.01)
            for t, low, high in (("1", 0.0, 10.0), ("b", 100.0, 103.0))
        ),
        feeders=(
            Feeder(at="A", track="b", side="high_km", km=101.0, resistance_ohm=0.3),
            Feeder(at="A", track="b", side="return", km=101.0, resistance_ohm=0.2),
        ),
        loads=(tap("T", 103.0, track="b", ampere=100.0),),
    )
    assert Judged(supply, line).u["T"] == pytest.approx(3600.0 - 10.0 - 100.0 * (0.3 + 0.2 + 0.06 * 2.0))
