"""Levels and words as reductions, commands as rows."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_controls import compiled, reduction, scenario

from tractionpower.dynamics.commands import (
    PipeRow,
    brake_target,
    compile_commands,
    next_pipe_row,
    reduction_of_level,
    shown_level,
)
from tractionpower.model.dynamics.gear import AirBrake

BAR = 1e5


def test_levels_of_the_paper_are_linear_up_to_full_service():
    air = AirBrake()
    assert [reduction_of_level(air, n) for n in range(16)] == pytest.approx([0.1 * n for n in range(16)])
    assert reduction_of_level(air, 40) == 1.5


def test_a_first_reduction_and_a_table():
    air = AirBrake(levels=12, first_reduction_bar=0.4)
    assert [reduction_of_level(air, n) for n in (0, 1, 2, 12)] == pytest.approx([0.0, 0.4, 0.5, 1.5])
    assert reduction_of_level(AirBrake(levels=1, first_reduction_bar=0.4), 1) == 1.5
    table = AirBrake(levels=3, reductions_bar=(0.5, 0.7, 1.5))
    assert [reduction_of_level(table, n) for n in (0, 1, 2, 3)] == [0.0, 0.5, 0.7, 1.5]


def test_words():
    air = AirBrake(pipe_pressure_bar=6.2, full_service_reduction_bar=1.8)
    assert brake_target(air, "emergency") == (6.2, True)
    assert brake_target(air, "full_service") == (1.8, False)
    assert brake_target(air, "charge") == brake_target(air, "release") == brake_target(air, 0) == (0.0, False)


@pytest.mark.parametrize("air", [AirBrake(), AirBrake(levels=8, first_reduction_bar=0.5), AirBrake(levels=1)])
def test_the_level_shown_is_the_level_set(air):
    assert [shown_level(air, reduction_of_level(air, n)) for n in range(air.levels + 1)] == list(range(air.levels + 1))
    assert shown_level(air, 1e-3) == 1
    assert shown_level(air, 99.0) == air.levels
    assert shown_level(air, 5.0, emergency=True) == air.levels + 1


def test_rows_of_controls_and_pipe():
    case = scenario(
        {"time_s": 1.0, "drive": 4},
        {"time_s": 2.0, "brake": 5},
        {"time_s": 3.0, "brake": "unchanged", "electric": 4.0},
        {"time_s": 4.0, "drive": 0, "independent_bar": 1.5},
        {"time_s": 5.0, "brake": "emergency"},
        {"time_s": 6.0, "reduction_bar": 0.95},
        start={"brake": "full_service"},
        electric_brake={"levels": 8, "effort_kn": 100.0, "power_kw": 900.0},
    ).case
    pipe, controls = compile_commands(case)
    assert controls.tolist() == [
        (0.0, 0, 0.0, 0.0, 15),
        (1.0, 4, 0.0, 0.0, 15),
        (2.0, 4, 0.0, 0.0, 5),
        (3.0, 4, 0.5, 0.0, 5),
        (4.0, 0, 0.5, 1.5e5, 5),
        (5.0, 0, 0.5, 1.5e5, 16),
        (6.0, 0, 0.5, 1.5e5, 10),
    ]
    assert pipe["from_s"].tolist() == [0.0, 2.0, 5.0, 6.0]
    np.testing.assert_allclose(pipe["target_pa"], [1.5e5, 0.5e5, 5e5, 0.95e5], rtol=1e-12)
    air = case.air_brake
    assert pipe["time_constant_s"].tolist() == [
        0.0,
        air.release_time_constant_s,
        air.emergency_time_constant_s,
        air.release_time_constant_s,
    ]
    assert pipe["emergency"].tolist() == [False, False, True, True]
    released = 0.5e5 + 1e5 * math.exp(-3.0 / air.release_time_constant_s)
    assert pipe["start_pa"][2] == pytest.approx(released, rel=1e-14)


def test_commands_out_of_order_are_sorted():
    case = scenario({"time_s": 5.0, "drive": 3}, {"time_s": 1.0, "drive": 7}).case
    assert compile_commands(case)[1]["drive"].tolist() == [0, 7, 3]


@pytest.mark.parametrize("word", ["charge", "full_service", "emergency"])
def test_a_settled_start(word):
    chain, state = compiled(scenario(start={"brake": word}, air_brake={"cylinder_emergency_bar": 4.4}))
    bar = {"charge": (0.0, 0.0), "full_service": (1.5, 3.8), "emergency": (5.0, 4.4)}[word]
    assert [reduction(chain, state, time) for time in (0.0, 7.0)] == [bar[0] * BAR] * 2
    np.testing.assert_allclose(state.movers["cylinder_pa"], bar[1] * BAR, rtol=1e-12)


@given(
    steps=st.lists(st.tuples(st.floats(0.01, 5.0), st.one_of(st.floats(0.0, 2.0), st.just("emergency"))), min_size=1, max_size=8)
)
@settings(max_examples=30, deadline=None, derandomize=True)
def test_driving_row_by_row_is_the_same_as_commands_known_before(steps):
    now, rows, commands = 0.0, [PipeRow(0.0, 0.0, 0.0, 0.0, False)], []
    for wait, asked in steps:
        now += wait
        commands.append({"time_s": now} | ({"brake": asked} if isinstance(asked, str) else {"reduction_bar": asked}))
    case = scenario(*commands).case
    pipe, _ = compile_commands(case)
    for k, (_, asked) in enumerate(steps):
        before = pipe[k] if k % 2 else rows[-1]  # a record of the table serves as well
        target = case.air_brake.pipe_pressure_bar if isinstance(asked, str) else asked
        rows.append(next_pipe_row(case.air_brake, before, commands[k]["time_s"], target, asked == "emergency"))
    assert [tuple(row) for row in rows] == pipe.tolist()
    for before, after in pairwise(rows):  # the reduction never leaps
        left = math.exp(-(after.from_s - before.from_s) / before.time_constant_s) if before.time_constant_s else 0.0
        assert after.start_pa == pytest.approx(before.target_pa + (before.start_pa - before.target_pa) * left, rel=1e-12)
