"""Trains that start before the clock: they come onto it where their theoretical journeys at nominal voltage have brought them."""

import numpy as np
import pytest
from coupled import couple, run

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.train_tables import GONE, OUTSIDE, STANDING
from tractionpower.movement.journey import theoretical_journeys

CALLS = [{"station": "P", "min_dwell_s": 100.0, "departure": 500.0}]


def mover_at(scenario, start):
    clock = scenario.clock.model_copy(update={"start": start})
    return start_state(compile_scenario(scenario.model_copy(update={"clock": clock}))).trains.movers[0]


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
@pytest.mark.parametrize("start", [60.0, 170.0, 250.0])
def test_place_and_speed_are_those_of_the_journey(kind, start):
    scenario = couple(run("E", kind, calls=CALLS), end_s=2000.0)
    (journey,) = theoretical_journeys(scenario)
    mover, row = mover_at(scenario, start), journey.rows[int(start)]
    assert row["time_s"] == start
    assert mover["s_m"] == pytest.approx(row["s_m"], abs=1e-6)
    assert mover["v_mps"] == pytest.approx(row["v_mps"], abs=1e-9)
    assert mover["voltage_v"] == 3000.0


def test_a_train_may_stand_at_a_station_when_the_clock_starts():
    scenario = couple(run("E", calls=CALLS), end_s=2000.0)
    mover = mover_at(scenario, 400.0)
    assert mover["status"] == STANDING
    assert (mover["s_m"], mover["v_mps"]) == (pytest.approx(6000.0, abs=0.1), 0.0)


def test_the_steps_before_the_clock_meet_its_start():
    """A start between two steps: the first short one is that before the clock."""
    scenario = couple(run("E", time=10.37, high=20.0), end_s=2000.0)
    (journey,) = theoretical_journeys(scenario)
    mover = mover_at(scenario, 100.0)
    s, v = (np.interp(100.0, journey.rows["time_s"], journey.rows[name]) for name in ("s_m", "v_mps"))
    assert mover["s_m"] == pytest.approx(s, abs=0.2)
    assert mover["v_mps"] == pytest.approx(v, abs=0.02)


def test_trains_of_later_are_outside_and_those_of_earlier_are_gone():
    scenario = couple(run("E", time=100.0), run("F", time=5000.0), end_s=6000.0)
    clock = scenario.clock.model_copy(update={"start": 4000.0})
    state = start_state(compile_scenario(scenario.model_copy(update={"clock": clock})))
    assert state.trains.movers["status"].tolist() == [GONE, OUTSIDE]
    assert state.trains.movers["finished_s"][0] < 4000.0
    assert state.trains.movers["s_m"][1] == 0.0
    assert state.progress[0]["active"] == 0
