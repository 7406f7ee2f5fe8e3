"""Currents at the ends of conductors, heat, and the balance of nodes."""

import numpy as np
import pytest
from solved import Solved, seed_network, single_line, tap

from tractionpower.kernels.flows import conductor_flows, link_current
from tractionpower.kernels.tables import EDGE_CURRENT, LEFT_END, LINK, PORT_CURRENT, RIGHT_END, TERM
from tractionpower.model.line import Line, Track
from tractionpower.model.supply import ReturnCircuit, SectionPoint


def test_currents_of_one_train_between_two_substations():
    solved = Solved(*single_line([tap("T", 5.0, ampere=1000.0)]))
    heat, inside, worst, _ = solved.flows()
    a, b = -solved.i["A"], -solved.i["B"]
    assert a + b == pytest.approx(1000.0, abs=1e-6)
    assert (a, b) == pytest.approx((1000.0 * (0.9 + 0.12) / 1.44, 1000.0 * (0.3 + 0.12) / 1.44), abs=1e-6)
    assert heat == pytest.approx(a**2 * 0.3 + b**2 * 0.9, abs=1e-3)
    assert max(inside, worst) < 1e-6
    contact = solved.work.conductors[0]
    assert (contact["left_a"], contact["right_a"]) == pytest.approx((a, b), abs=1e-6)


def test_currents_of_the_seed_network():
    solved = Solved(*seed_network([tap("T", 10.0, ampere=1500.0)]))
    heat, inside, worst, _ = solved.flows()
    assert heat == pytest.approx(1500.0 * (3510.0 - 3247.5), abs=1e-3)
    assert max(inside, worst) < 1e-6
    conductors = solved.network.conductors
    contact = [k for k in range(len(conductors)) if conductors["ohm_per_m"][k] == 0.05 / 1000.0]
    entering = sorted(float(solved.work.conductors["left_a"][k]) for k in contact)
    assert entering == pytest.approx([-375.0, -375.0, 375.0, 375.0], abs=1e-6)  # four halves of two tracks
    leaving = sorted(float(solved.work.conductors["right_a"][k]) for k in contact)
    assert leaving == pytest.approx([-375.0, 375.0, 375.0, 1500.0 - 375.0], abs=1e-6)  # the train stands at one of the ends


def test_feeders_and_return_feeders_heat_too():
    loads = [tap("T", 5.0, ampere=1000.0)]
    solved = Solved(*single_line(loads, feeder_resistance_ohm=0.02, return_resistance_ohm=0.03))
    heat, _, worst, _ = solved.flows()
    a, b = -solved.i["A"], -solved.i["B"]
    assert heat == pytest.approx(a**2 * 0.35 + b**2 * 0.95, abs=1e-3)
    assert worst < 1e-6
    assert solved.u["A"] - solved.u["T"] == pytest.approx(0.35 * a, abs=1e-6)


def test_the_balance_sees_a_wrong_solution():
    solved = Solved(*single_line([tap("T", 5.0, ampere=1000.0)]))
    solved.work.node_v[0] += 1.0
    assert max(solved.flows()[1:3]) > 1.0


@pytest.mark.parametrize("x_m", [0.0, 0.5, 9999.7, 10_000.0])
def test_a_load_at_the_end_of_a_span(x_m):
    solved = Solved(*seed_network([tap("T", x_m / 1000.0, kw=2000.0), tap("U", 3.0, track="2", kw=500.0)]))
    _, inside, worst, balance = solved.flows()
    assert max(inside, worst) < 1e-6
    assert np.sum(balance) == pytest.approx(0.0, abs=1e-6)


# -- leakage


def leaky(loads=(), ohm=0.02, leakage=0.1, tracks=("1", "2"), **changes):
    """Return the seed network with rails for each track that leak."""
    supply, line = seed_network(loads, **changes)
    row = {"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": ohm, "leakage_s_per_km": leakage}
    rails = tuple(ReturnCircuit(tracks=(t,), **row) for t in tracks)
    return supply.model_copy(update={"return_circuit": rails}), line


LOADS = [tap("T", 4.0, kw=3000.0), tap("U", 13.0, track="2", kw=1500.0), tap("V", 17.3, kw=-400.0)]


def test_every_conductor_balances_with_what_it_loses_to_earth():
    """What enters at its ends leaves by the ports on it or into earth."""
    solved = Solved(*leaky(LOADS))
    _, inside, worst, balance = solved.flows()
    assert max(inside, worst) < 1e-6
    work, ports = solved.work, solved.network.ports
    taken = np.zeros(len(work.conductors))
    for name, port in solved.ports.items():
        if ports["span"][port] >= 0:
            taken[ports["positive"][port]] += solved.i[name]
            taken[ports["negative"][port]] -= solved.i[name]
    np.testing.assert_allclose(
        work.conductors["left_a"] + work.conductors["right_a"], taken + work.conductors["earth_a"], atol=1e-6
    )
    assert np.sum(np.abs(work.conductors["earth_a"])) > 10.0
    assert np.sum(balance) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("leakage", [0.0, 0.001, 0.1, 3.0])
@pytest.mark.parametrize("ohm", [0.02, 0.0])
def test_heat_and_leakage_are_what_is_put_in_less_what_is_taken_out(leakage, ohm):
    solved = Solved(*leaky(LOADS, ohm=ohm, leakage=leakage))
    heat, *_ = solved.flows()
    exchanged = sum(solved.u[name] * solved.i[name] for name in solved.names)
    assert heat == pytest.approx(-exchanged, abs=1e-3)


def test_what_leaks_is_counted_where_it_leaves():
    """It hardly leaks: along track 1 the potential rises straight by 400 V, along track 2, joined at A, it is that of A.

    As nothing is left over, A is at -100 V: the rails of track 1 are positive from km 5 on, 150 V in the mean.
    """
    supply, line = leaky([tap("T", 20.0, ampere=1000.0)], leakage=1e-4)
    alone = supply.model_copy(update={"substations": supply.substations[:1], "section_cabins": ()})
    solved = Solved(alone, line)
    _, _, leaked = conductor_flows(solved.network, solved.work, np.zeros(solved.network.nodes + 1))
    assert leaked == pytest.approx(150.0 * 15.0 * 1e-4, rel=0.01)
    assert sum(solved.work.conductors["leaked_a"]) == leaked


@pytest.mark.parametrize("leakage", [1e-4, 0.1, 5.0, 1000.0])
def test_what_leaks_does_not_depend_on_where_rails_are_cut(leakage):
    supply, line = leaky(LOADS, leakage=leakage)
    points = tuple(SectionPoint(id=f"{t} {k}", track=t, km=0.37 * k, state="closed") for t in "12" for k in range(1, 54))
    found = []
    for cuts in ((), points):
        solved = Solved(supply.model_copy(update={"section_points": cuts}), line)
        found.append(conductor_flows(solved.network, solved.work, np.zeros(solved.network.nodes + 1)))
    (heat, _, leaked), (heat_cut, _, leaked_cut) = found
    assert leaked == pytest.approx(leaked_cut, rel=1e-6)  # 1 uA that is left over is a fraction of a millivolt here
    assert heat == pytest.approx(heat_cut, rel=1e-6)


def test_leaky_rails_against_the_closed_form():
    """Rails of 20 km with open ends and a characteristic length of 3 km; the substation at km 5, the train at km 15."""
    supply, _line = leaky([tap("T", 15.0, ampere=1000.0)], ohm=0.02, leakage=5.0)
    alone = supply.model_copy(
        update={"substations": (supply.substations[0].model_copy(update={"km": 5.0}),), "section_cabins": ()}
    )
    solved = Solved(alone, Line(tracks=(Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=1.0))))
    z, a, length = np.sqrt(0.02 / 5.0), np.sqrt(0.02 * 5.0), 20.0

    def green(x, y):
        """Return the potential at x of 1 A into the rails at y [ohm]; both ends are open."""
        low, high = min(x, y), max(x, y)
        return z * np.cosh(a * low) * np.cosh(a * (length - high)) / np.sinh(a * length)

    for km in (0.0, 5.0, 20.0):
        assert solved.rails["1", km] == pytest.approx(1000.0 * (green(km, 15.0) - green(km, 5.0)), abs=1e-6)
    rail_at_train = 1000.0 * (green(15.0, 15.0) - green(15.0, 5.0))
    busbar = 1000.0 * (green(5.0, 15.0) - green(5.0, 5.0)) + 3600.0 - 120.0
    assert solved.u["T"] == pytest.approx(busbar - 1000.0 * 0.05 * 10.0 - rail_at_train, abs=1e-6)


# -- links


def test_a_link_is_the_sum_of_its_terms():
    """One term of each kind, on a network whose currents are known, and a link without terms."""
    solved = Solved(*single_line([tap("T", 5.0, ampere=1000.0)], feeder_resistance_ohm=0.02, return_resistance_ohm=0.03))
    solved.flows()
    a, tables, network = -solved.i["A"], solved.tables, solved.network
    edge = next(k for k, row in enumerate(tables.edges) if row["conductance_s"] == pytest.approx(50.0))
    drop = solved.work.node_v[tables.edges["first"][edge]] - solved.work.node_v[tables.edges["second"][edge]]
    rows = [(EDGE_CURRENT, edge, 1.0), (PORT_CURRENT, solved.ports["A"], -1.0), (LEFT_END, 0, 2.0), (RIGHT_END, 0, 1.0)]
    expected = [50.0 * drop, a, 2.0 * a, 1000.0 - a]
    links = np.array([(k, 1) for k in range(4)] + [(0, 4), (2, 0)], LINK)
    found = [
        link_current(links, np.array(rows, TERM), k, solved.work, tables.edges, network.ports, network.segments)
        for k in range(len(links))
    ]
    # the current that enters the right end is what the load takes less what comes from the left
    assert found == pytest.approx([*expected, sum(expected), 0.0], abs=1e-6)
