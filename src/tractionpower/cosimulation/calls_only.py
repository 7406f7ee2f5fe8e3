"""A run of which only the times of trains are wanted: nothing is recorded, which takes half of the work."""

from __future__ import annotations

from dataclasses import dataclass

from tractionpower.cosimulation.check import check_scenario, step_count
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.switching import Switchboard
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.errors import raise_errors
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import TRIGGERED, new_buffers
from tractionpower.kernels.train_tables import TrainState
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import Movement

STEPS = 500
"""Steps of a block."""


@dataclass(frozen=True, eq=False)
class TrainTimes:
    """The trains of a run, and what became of them."""

    movement: Movement
    trains: TrainState


def run_for_calls(scenario: Scenario) -> TrainTimes:
    """Run a scenario to the end of its clock and return what became of its trains.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """
    raise_errors(check_scenario(scenario))
    compiled = compile_scenario(scenario)
    board = Switchboard(scenario, compiled, start_state(compiled))
    steps, done = step_count(scenario.clock), 0
    block = min(STEPS, steps)
    buffers = new_buffers(compiled.block, block, block * max(1, len(compiled.movement.runs)))
    while done < steps:
        board.move(done)
        rows, reason = advance(board.compiled.block, board.state, buffers, min(done + block, steps, board.next_step))
        done += rows
        if reason == TRIGGERED:
            board.react(done, rows - 1, buffers)
    return TrainTimes(compiled.movement, board.state.trains)
