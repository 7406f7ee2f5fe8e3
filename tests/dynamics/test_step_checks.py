import numpy as np
import pytest
from chains import WAGON, free, make_chain, spring

from tractionpower.dynamics.session import Session
from tractionpower.dynamics.step_checks import Modes, check_step, largest_step, stiffest_modes


def modes(frequency, damping=0.0):
    return Modes(np.array([frequency]), np.array([damping]))


@pytest.mark.parametrize(("method", "limit"), [("symplectic", 2.0), ("rk4", 2.0 * 2.0**0.5)])
def test_undamped_modes_are_stable_up_to_the_known_limits(method, limit):
    assert largest_step(modes(310.0), method) == pytest.approx(limit / 310.0, rel=1e-6)


def test_euler_is_never_stable_without_damping_and_up_to_twice_the_ratio_with_it():
    assert largest_step(modes(100.0), "euler") * 100.0 < 1e-4
    assert largest_step(modes(100.0, 2.0 * 0.05 * 100.0), "euler") * 100.0 == pytest.approx(0.1, rel=1e-6)


def test_modes_of_a_free_chain_are_those_of_the_closed_form():
    scenario = free([80.0] * 10, spring(20.0, damping_kns_per_m=30.0))
    found = stiffest_modes(scenario)
    n = np.arange(10)
    expected = 2.0 * np.sqrt(20e6 / 80e3) * np.sin(n * np.pi / 20.0)
    assert found.frequency == pytest.approx(expected, abs=1e-4)
    assert found.damping == pytest.approx(expected**2 * 30e3 / 20e6, abs=1e-4)


@pytest.mark.parametrize("method", ["symplectic", "rk4"])
@pytest.mark.parametrize(("share", "grows"), [(0.97, False), (1.05, True)])
def test_the_limit_is_where_the_chain_itself_blows_up(method, share, grows):
    coupling = spring(10.0, damping_kns_per_m=20.0)
    probe = free([60.0] * 6, coupling)
    limit = largest_step(stiffest_modes(probe), method)
    run = {"duration_s": 400 * limit, "step_s": share * limit, "method": method, "record_every_s": 100 * limit}
    session = Session(free([60.0] * 6, coupling, run=run))
    session.state.movers["v_mps"] = [0.01, -0.01, 0.01, -0.01, 0.01, -0.01]
    try:
        session.advance(1e9)
        greatest = np.abs(session.state.movers["v_mps"]).max()
    except Exception:  # it blew up beyond all numbers
        greatest = np.inf
    assert (greatest > 1.0) == grows


def test_a_step_too_large_is_refused_with_the_step_that_is_allowed():
    scenario = make_chain([{"id": "wagon", "count": 5}], spring(600.0), [WAGON | {"mass_t": 25.0}], {"step_s": 0.02})
    (problem,) = check_step(scenario)
    assert problem.code == "step_too_large" and problem.path == "case.run.step_s"
    allowed = float(problem.allowed.split()[2])
    assert allowed == pytest.approx(2.0 / stiffest_modes(scenario).frequency.max(), rel=0.01)
    run = scenario.case.run.model_copy(update={"step_s": allowed})
    assert check_step(scenario.model_copy(update={"case": scenario.case.model_copy(update={"run": run})})) == []


def test_euler_without_damping_is_refused_at_any_step():
    (problem,) = check_step(free([80.0, 80.0], spring(10.0), run={"step_s": 1e-4, "method": "euler", "duration_s": 1.0}))
    assert "no step" in problem.allowed and "symplectic" in problem.remedy


def test_a_variable_step_needs_no_limit():
    assert check_step(free([80.0, 80.0], spring(1e4), run={"step_s": 1.0, "method": "variable", "duration_s": 1.0})) == []
