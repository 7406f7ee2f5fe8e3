"""Currents at the ends of conductors, heat, and the balance of nodes."""

import numpy as np
import pytest
from solved import Solved, seed_network, single_line, tap


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
