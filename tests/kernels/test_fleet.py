"""Trains enter, have their ports where they are, and leave."""

import numpy as np
import pytest
from coupled import MIXED, couple, run

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import new_buffers
from tractionpower.kernels.fleet import ask_line, enter_trains
from tractionpower.kernels.ports import port_current


def made(*runs, **more):
    compiled = compile_scenario(couple(*runs, **more))
    return compiled, compiled.block, start_state(compiled)


def on_line(state):
    return state.active[: state.progress[0]["active"]].tolist()


def test_trains_enter_in_the_step_in_which_they_start():
    _, tables, state = made(run("A", time=2.0), run("B", time=0.0), run("C", time=2.5), run("D", time=4.0))
    expected = {0.0: [1], 1.0: [1], 2.0: [0, 1, 2], 3.0: [0, 1, 2], 4.0: [0, 1, 2, 3]}
    for t, trains in expected.items():
        enter_trains(tables, state, t)
        assert on_line(state) == trains  # by number, whatever the order of their starts
    assert state.progress[0]["entered"] == 4


def test_ports_in_service_are_the_fixed_ones_and_those_of_the_trains_on_the_line():
    _, tables, state = made(run("A", time=5.0), run("B"), run("C", time=1.0))
    fixed = len(tables.network.ports) - 3
    assert state.work.in_service[0] == fixed
    enter_trains(tables, state, 0.0)
    enter_trains(tables, state, 1.0)
    assert state.work.in_service[0] == fixed + 2
    order = state.work.order[: fixed + 2].tolist()
    assert order == [*range(fixed), tables.fleet["port"][1], tables.fleet["port"][2]]


@pytest.mark.parametrize(("low", "high"), [(0.0, 20.0), (20.0, 0.0), (7.3, 14.1)])
def test_the_port_moves_with_the_front(low, high):
    compiled, tables, state = made(run("A", low=low, high=high), end_s=900.0)
    spans = {stretch.span: stretch for stretch in compiled.supply.stretches if stretch.track == "1"}
    for end in range(1, 700, 23):
        advance(tables, state, new_buffers(tables, 100), end)
        mover = state.trains.movers[0]
        if not on_line(state):
            break
        ask_line(tables, state, float(end))
        port = tables.network.ports[tables.fleet["port"][0]]
        km = low + np.sign(high - low) * mover["s_m"] / 1000.0
        stretch = spans[int(port["span"])]
        assert stretch.from_m + port["x_m"] == pytest.approx(1000.0 * km, abs=1e-6)
    assert mover["s_m"] > 3000.0


def test_a_train_that_leaves_goes_out_of_service():
    _, tables, state = made(run("A", high=1.0), run("B"), end_s=400.0)
    fixed = len(tables.network.ports) - 2
    advance(tables, state, new_buffers(tables, 200), 200)
    assert on_line(state) == [1]
    assert state.work.in_service[0] == fixed + 1
    assert state.work.order[fixed] == tables.fleet["port"][1]


def test_rows_are_those_of_the_trains_on_the_line_by_step_and_number():
    _, tables, state = made(*MIXED, end_s=600.0)
    buffers = new_buffers(tables, 600)
    advance(tables, state, buffers, 600)
    rows = buffers.trains[: int(buffers.steps["trains"].sum())]
    key = rows["time_s"] * 10.0 + rows["train"]
    assert (np.diff(key) > 0.0).all()
    np.testing.assert_array_equal(np.bincount(rows["time_s"].astype(int), minlength=600), buffers.steps["trains"])


@pytest.mark.parametrize("volts", [2500.0, 3000.0])
def test_at_constant_voltage_a_port_takes_one_current_at_any_voltage(volts):
    _, tables, state = made(run("A"), coupling="constant_voltage", coupling_voltage_v=volts, end_s=100.0)
    advance(tables, state, new_buffers(tables, 60), 60)
    ask_line(tables, state, 60.0)
    port = tables.network.ports[tables.fleet["port"][0]]
    currents = {port_current(tables.network.segments, port, u) for u in (2000.0, 2900.0, 3599.0, 5000.0)}
    assert len(currents) == 1
    assert port_current(tables.network.segments, port, 1000.0) == pytest.approx(0.5 * max(currents))
    assert port_current(tables.network.segments, port, -100.0) == 0.0
    assert currents.pop() > 100.0
