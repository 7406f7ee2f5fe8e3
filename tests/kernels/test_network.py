"""Published and computed snapshots, greatest powers, and which of several solutions is found."""

import numpy as np
import pytest
from solved import Solved, seed_network, single_line, tap

from tractionpower.kernels.network import CONVERGED, NOT_CONVERGED, NOT_SERVABLE, solve, solve_warm
from tractionpower.kernels.spans import place_ports
from tractionpower.kernels.tables import SEGMENT, new_work


def four(**what):
    return [tap(f"{track} {km}", km, track=track, **what) for track in "12" for km in (5.0, 15.0)]


# -- the seed network


@pytest.mark.parametrize(("cabin", "volts"), [("closed", 3247.5), ("bypassed", 3060.0)])
def test_n1(cabin, volts):
    solved = Solved(*seed_network([tap("T", 10.0, ampere=1500.0, limits="none")], cabin))
    assert solved.u == {
        "A": pytest.approx(3510.0, abs=1e-3),
        "B": pytest.approx(3510.0, abs=1e-3),
        "T": pytest.approx(volts, abs=5e-4),
    }
    assert solved.i["A"] == pytest.approx(-750.0, abs=1e-3)


def test_n3():
    solved = Solved(*seed_network(four(ampere=1000.0)))
    assert [solved.u[name] for name in solved.names] == pytest.approx([3360.0] * 2 + [3010.0] * 4, abs=1e-6)
    assert solved.i["B"] == pytest.approx(-2000.0, abs=1e-6)


def test_n5():
    solved = Solved(*seed_network(four(kw=3000.0)))
    volts = (3600.0 + np.sqrt(3600.0**2 - 4.0 * 0.59 * 3e6)) / 2.0
    assert [solved.u[name] for name in solved.names[2:]] == pytest.approx([volts] * 4, abs=1e-6)
    assert solved.u["A"] == pytest.approx(3360.991, abs=5e-4)
    assert solved.i["A"] == pytest.approx(-1991.744, abs=5e-4)


def test_n7():
    loads = [tap("T1", 5.0, ampere=-800.0, limits="none"), tap("T2", 15.0, track="2", ampere=1000.0, limits="none")]
    solved = Solved(*seed_network(loads, conducts="both"))
    assert [solved.u[name] for name in solved.names] == pytest.approx([3628.213, 3547.787, 3719.356, 3409.144], abs=5e-4)
    assert [-solved.i[name] for name in "AB"] == pytest.approx([-235.106, 435.106], abs=5e-4)


def test_n7_with_rectifiers():
    loads = [tap("T1", 5.0, ampere=-800.0, limits="none"), tap("T2", 15.0, track="2", ampere=1000.0, limits="none")]
    solved = Solved(*seed_network(loads))
    assert [-solved.i[name] for name in "AB"] == pytest.approx([0.0, 200.0], abs=1e-5)


@pytest.mark.parametrize(
    ("cabin", "km", "ohm"),
    [
        ("closed", 2, 0.191596), ("closed", 5, 0.264920), ("closed", 10, 0.235),
        ("bypassed", 2, 0.196596), ("bypassed", 5, 0.296170), ("bypassed", 10, 0.36),
    ],
)  # fmt: skip
def test_source_resistance(cabin, km, ohm):
    solved = Solved(*seed_network([tap("T", float(km), ampere=1000.0)], cabin))
    assert (3600.0 - solved.u["T"]) / 1000.0 == pytest.approx(ohm, abs=5e-7)


# -- the single line


def test_l1():
    solved = Solved(*single_line([tap("T", 10.0, kw=4000.0)]))
    assert [solved.u[name] for name in "ATB"] == pytest.approx([3523.606798, 3141.640786, 3523.606798], abs=5e-7)
    assert solved.i["A"] == pytest.approx(-636.610019, abs=5e-7)
    assert solved.flows()[0] == pytest.approx(486.326779e3, abs=1e-3)


def test_l4():
    solved = Solved(*single_line([tap("T", 8.0, kw=1000.0), tap("V", 12.0, kw=-3000.0, fold_back_from_v=3900.0)]))
    assert [solved.u[name] for name in "ATVB"] == pytest.approx([3837.458609, 3837.458609, 3900.0, 3900.0], abs=1e-3)
    assert solved.u["V"] * solved.i["V"] == pytest.approx(-1016.297607e3, abs=20.0)
    assert solved.flows()[0] == pytest.approx(16.297607e3, abs=20.0)
    assert max(abs(solved.i[name]) for name in "AB") < 1e-6


def test_l7():
    solved = Solved(*single_line([tap("T", 10.0, kw=8000.0)]))
    assert [solved.u[name] for name in "ATB"] == pytest.approx([3400.0, 2400.0, 3400.0], abs=1e-6)
    assert solved.i["A"] == pytest.approx(-5000.0 / 3.0, abs=1e-6)
    assert solved.flows()[0] == pytest.approx(1e7 / 3.0, abs=1e-2)


# -- the greatest power


@pytest.mark.parametrize(("cabin", "ohm"), [("closed", 0.235), ("bypassed", 0.36)])
def test_the_greatest_power(cabin, ohm):
    most = 3600.0**2 / (4.0 * ohm) / 1e3
    assert most == pytest.approx({"closed": 13787.0, "bypassed": 9000.0}[cabin], abs=0.5)
    below = Solved(*seed_network([tap("T", 10.0, kw=0.9999 * most, limits="none")], cabin))
    assert below.u["T"] == pytest.approx(1800.0 * (1.0 + np.sqrt(1e-4)), abs=0.1)
    above = Solved(*seed_network([tap("T", 10.0, kw=1.0005 * most, limits="none")], cabin), expect=NOT_SERVABLE)
    assert above.factor == pytest.approx(1.0 / 1.0005, abs=1e-5)
    assert above.port == 2
    far = Solved(*seed_network([tap("T", 10.0, kw=2.0 * most, limits="none")], cabin), expect=NOT_SERVABLE)
    assert far.factor == pytest.approx(0.5, abs=1e-3)
    assert far.u["T"] == pytest.approx(1800.0, abs=5.0)  # the network as it stands with the demand cut


@pytest.mark.parametrize(("cabin", "most"), [("closed", 13_617.0), ("bypassed", 8_889.0)])
def test_the_end_of_the_range(cabin, most):
    above = Solved(*seed_network([tap("T", 10.0, kw=most - 2.0)], cabin))
    assert 2000.0 < above.u["T"] < 2010.0
    assert above.i["T"] * above.u["T"] == pytest.approx(1e3 * (most - 2.0), rel=1e-6)
    below = Solved(*seed_network([tap("T", 10.0, kw=most + 2.0)], cabin))
    assert 1990.0 < below.u["T"] < 2000.0
    assert below.i["T"] * below.u["T"] < 1e3 * (most + 2.0)


# -- several solutions


def folded():
    """Two loads without limits on a weak line: a stable solution of low voltages exists beside that of high ones."""
    return single_line([tap("x", 6.0, kw=2500.0, limits="none"), tap("y", 14.0, kw=2500.0, limits="none")])


def low_start(solved):
    """Return the work of the same network with all ports at voltages where one load sits below its range."""
    work = new_work(solved.network)
    place_ports(solved.network, work)
    work.ports["u"] = solved.work.ports["u"]
    work.ports["before_v"] = np.inf
    return work


def test_a_warm_start_does_not_choose_the_low_solution():
    solved = Solved(*folded())
    high = dict(solved.u)
    assert min(high.values()) > 2800.0
    for name, volts in ((2, 120.0), (3, 120.0), (2, 700.0)):
        work = low_start(solved)
        work.ports["u"][name] = volts
        place_ports(solved.network, work)
        status, _, _, factor, port = solve(solved.network, work, True)
        assert (status, factor, port) == (CONVERGED, 1.0, -1)
        assert work.ports["u"] == pytest.approx(list(high.values()), abs=1e-6)


def test_the_low_solution_exists_and_a_warm_start_there_is_refused():
    """Below 5 % of U_n the solver treats a load without limits as a resistance: a solution, and a stable one."""
    solved = Solved(*folded())
    ohm = 0.05 * 3000.0 * 0.05 * 3000.0 / 2.5e6
    work = low_start(solved)
    # On this line two like loads at 6 and 14 km draw two like currents, each past 0.12 ohm and 6 km.
    current = 3600.0 / (0.12 + 0.36 + ohm)
    work.ports["u"][2:] = current * ohm
    assert work.ports["u"][2] < 150.0
    work.ports["u"][:2] = 3600.0 - 0.12 * current
    assert solve_warm(solved.network, work)[0] == 0


@pytest.mark.parametrize(("segment", "low", "high"), [(0, -1e5, 2000.0), (1, -1e5, 2700.0), (2, 1000.0, 1e5), (3, 2000.0, 1e5)])
def test_a_warm_start_may_move_a_port_by_one_segment(segment, low, high):
    solved = Solved(*single_line([tap("x", 6.0, kw=10.0)]))
    network, work = solved.network, solved.work
    segments = np.zeros(4, SEGMENT)
    segments["from_v"] = [-np.inf, 1000.0, 2000.0, 2700.0]
    network = network._replace(segments=np.concatenate([network.segments, segments]))
    port = network.ports[2]
    port["first_segment"], port["segments"], port["demand"] = len(solved.network.segments), 4, False
    work.ports["u"][2] = [500.0, 1500.0, 2500.0, 3000.0][segment]
    solve_warm(network, work)
    assert (work.ports["lowest_v"][2], work.ports["highest_v"][2]) == (low, high)


def test_a_warm_start_does_not_move_a_demand_below_half_the_voltage():
    solved = Solved(*single_line([tap("x", 6.0, kw=1000.0)]))
    solved.solve(warm=True)
    assert solved.work.ports["lowest_v"][2] >= 1800.0


def test_the_range_has_one_solution_from_anywhere():
    solved = Solved(*single_line([tap("x", 6.0, kw=6000.0), tap("y", 14.0, kw=7000.0)]))
    rng = np.random.default_rng(0)
    for _ in range(30):
        work = low_start(solved)
        work.ports["u"] = rng.uniform(0.0, 4000.0, 4)
        assert solve(solved.network, work, True)[0] == CONVERGED
        assert work.ports["u"] == pytest.approx(list(solved.u.values()), abs=1e-5)


# -- what is not well


def test_a_hard_ceiling_that_is_met_to_rounding_is_no_nonsense():
    """Regression: the line search divided zero by zero, and not-a-number passed for a balance."""
    for kw in np.linspace(-60_000.0, -1_000.0, 40):
        solved = Solved(*single_line([tap("x", 8.0, kw=900.0), tap("y", 12.0, kw=float(kw), fold_back_from_v=3900.0)]))
        assert np.all(np.isfinite(list(solved.u.values())))
        assert solved.worst <= 1e-3


def test_not_a_number_is_not_converged():
    solved = Solved(*single_line([tap("x", 8.0, kw=900.0)]))
    solved.network.segments["a"][-1] = np.nan
    assert solve(solved.network, solved.work, False)[0] == NOT_CONVERGED


def test_potentials_belong_to_the_port_voltages_after_a_shortened_step():
    """Regression: all rectifiers block, the last step goes 1e-11 of its way, and the potentials were left at its end."""
    solved = Solved(*single_line([tap("x", 8.0, ampere=-20_000.0, fold_back_from_v=3900.0)]))
    positive, negative = solved.tables.busbar[0]
    node_v = solved.work.node_v
    assert node_v[positive] - node_v[negative] == pytest.approx(solved.u["A"], abs=1e-6)
    assert solved.work.sides["node_v"][2, 0] - solved.work.sides["node_v"][2, 1] == pytest.approx(solved.u["x"], abs=1e-6)
    heat, inside, worst, _ = solved.flows()
    assert heat < 1.0
    assert max(inside, worst) < 1e-3


def test_the_scale_is_cut_and_stays_cut():
    solved = Solved(*single_line([tap("x", 10.0, kw=20_000.0, limits="none")]), expect=NOT_SERVABLE)
    assert solved.network.ports["scale"][2] == solved.factor
    assert solved.network.ports["scale"][:2].tolist() == [1.0, 1.0]
