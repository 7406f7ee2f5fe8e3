"""A run of which only the times of trains are wanted comes to the same times as the whole one, to the last bit."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling

from tractionpower.cosimulation import quiet
from tractionpower.cosimulation.run import Run
from tractionpower.errors import InputError
from tractionpower.results.store import MemoryWriter


@pytest.mark.parametrize("seed", [0, 2, 3])
@pytest.mark.parametrize("block", [1, 37, 500])
def test_the_times_are_those_of_the_whole_run(seed, block, monkeypatch):
    monkeypatch.setattr(quiet, "STEPS", block)
    scenario = RandomCoupling(seed).scenario
    whole = Run(scenario, MemoryWriter())
    whole.execute()
    times = quiet.run_quietly(scenario)
    for name in ("s_m", "v_mps", "status"):
        np.testing.assert_array_equal(times.trains.movers[name], whole.state.trains.movers[name])
    np.testing.assert_array_equal(times.trains.arrived_s, whole.state.trains.arrived_s)
    np.testing.assert_array_equal(times.trains.left_s, whole.state.trains.left_s)


def test_switches_move_in_it_too():
    event = {"device": "A", "time": 30.0, "state": "rectifiers_out"}
    scenario = couple(run("x", "series_motors", calls=[{"station": "P", "arrival": 300.0}]), end_s=500.0, switch_events=[event])
    whole = Run(scenario, MemoryWriter())
    whole.execute()
    times = quiet.run_quietly(scenario)
    np.testing.assert_array_equal(times.trains.arrived_s, whole.state.trains.arrived_s)
    plain = quiet.run_quietly(couple(run("x", "series_motors", calls=[{"station": "P", "arrival": 300.0}]), end_s=500.0))
    assert plain.trains.arrived_s[0] < times.trains.arrived_s[0] - 0.1


def test_a_scenario_with_errors_does_not_run():
    with pytest.raises(InputError):
        quiet.run_quietly(couple(run("x", high=60.0)))
