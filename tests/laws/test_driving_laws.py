"""Laws of plans that save energy, on random lines with random trains at random voltages."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_trains import random_study
from ttobench_cases import Driven

from tractionpower.kernels.journey import ARRIVED
from tractionpower.model.driving import Reserve
from tractionpower.movement.compile import compile_trains
from tractionpower.movement.driving.optimal import optimal_plans

LAW = settings(max_examples=50, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


def running_s(movement, found):
    """Return the running time without dwells [s]."""
    dwells = np.nan_to_num(found.left_s - found.arrived_s).clip(0.0).sum()
    return found.finished_s - movement.runs[0].start_s - dwells


@LAW
@given(
    seed=st.integers(0, 10**6),
    voltage_v=st.floats(2400.0, 3400.0),
    percent=st.floats(1.0, 40.0),
    returned=st.sampled_from([0.0, 50.0, 100.0]),
)
def test_a_plan_is_on_time_below_the_ceiling_and_never_needs_more_than_flat_out_with_waiting(seed, voltage_v, percent, returned):
    movement = compile_trains(random_study(seed))
    flat = Driven(movement, voltage=voltage_v)
    if flat.status != ARRIVED:
        return
    saving = Reserve(kind="reserve", percent=percent, returned_percent=returned)
    rows = optimal_plans(movement, [(0, saving)], voltage_v)[0]
    found = Driven(movement, rows, voltage=voltage_v)
    assert found.status == ARRIVED
    shortest, taken = running_s(movement, flat), running_s(movement, found)
    late = taken - shortest * (1.0 + percent / 100.0)
    assert late < 1.0
    if movement.runs[0].formation.driver.drive.kind != "series_motors" and percent < 8.0:
        assert late > -1.0  # with more time the least energy of a short leg may be that of an earlier arrival and waiting
    waiting_j = flat.rows["auxiliary_w"].max() * max(taken - shortest, 0.0)
    gross = flat.energy_j(returned=0.0)
    assert found.energy_j(returned / 100.0) <= flat.energy_j(returned / 100.0) + waiting_j + 1e-3 * gross
    own, at, v = movement.tables.pieces, found.rows["s_m"], found.rows["v_mps"]
    piece = own[np.searchsorted(own["from_m"], at, side="right") - 1]
    assert (v**2 <= piece["w"] + piece["dw"] * (at - piece["from_m"]) + 1e-5).all()
    plan = rows[0][np.searchsorted(rows[0]["from_m"], own["from_m"][:-1] + 1e-6, side="right") - 1]
    assert (plan["w"] + plan["dw"] * (own["from_m"][:-1] + 1e-6 - plan["from_m"]) <= own["w"][:-1] + 1e-3).all()
