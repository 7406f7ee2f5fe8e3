"""A run that records nothing by itself, which takes half of the work: what is wanted of it is watched while it lasts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.check import step_count
from tractionpower.cosimulation.prepared import prepare
from tractionpower.cosimulation.recorder import Watch
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.switching import Switchboard
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import TRIGGERED, Buffers, State, new_buffers, take_rows
from tractionpower.kernels.network import CONVERGED
from tractionpower.kernels.train_tables import TrainState
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import Movement
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]

STEPS = 500
"""Steps of a block."""


class QuietRun:
    """One run of a scenario of which nothing is written.

    Parameters
    ----------
    scenario
        What to run.

    Attributes
    ----------
    compiled
        Tables of the scenario, with all devices in their normal states.
    warnings
        Warnings of the checks.
    watches
        Called with the rows of each block, in order; put there before `execute`.
    flagged_steps, worst_a
        Steps that did not converge or could not be served, and the greatest imbalance of a node [A].

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.compiled, found = prepare(scenario)
        self.warnings = tuple(found)
        self._board = Switchboard(scenario, self.compiled, start_state(self.compiled))
        self.watches: list[Watch] = []
        self.flagged_steps, self.worst_a = 0, 0.0

    def execute(self, progress: Callable[[int, int], None] | None = None) -> None:
        """Run to the end of the clock; `progress` is called with the steps done and the steps in all."""
        board, steps, done = self._board, step_count(self.scenario.clock), 0
        block = min(STEPS, steps)
        buffers = new_buffers(self.compiled.block, block, block * max(1, len(self.movement.runs)))
        while done < steps:
            board.move(done)
            supply = board.compiled.supply
            rows, reason = advance(board.compiled.block, board.state, buffers, min(done + block, steps, board.next_step))
            self._look(done, take_rows(buffers, slice(rows)), supply)
            done += rows
            if reason == TRIGGERED:
                board.react(done, rows - 1, buffers)
            if progress is not None:
                progress(done, steps)

    def _look(self, first: int, rows: Buffers, supply: SupplyTables) -> None:
        clock = self.scenario.clock
        time_s: Floats = clock.start + np.arange(first, first + len(rows.steps)).astype(float) * clock.step_s
        self.flagged_steps += int(np.count_nonzero(rows.steps["status"] != CONVERGED))
        self.worst_a = max(self.worst_a, float(rows.steps["worst_a"].max(initial=0.0)))
        for watch in self.watches:
            watch(time_s, rows, supply)

    @property
    def movement(self) -> Movement:
        """The trains and their routes."""
        return self.compiled.movement

    @property
    def events(self) -> list[dict[str, Any]]:
        """What was switched so far, and what switched by itself."""
        return self._board.rows

    @property
    def trains(self) -> TrainState:
        """What has become of the trains."""
        return self.state.trains

    @property
    def state(self) -> State:
        """State of the run after the last step."""
        return self._board.state


def run_quietly(scenario: Scenario, watches: Sequence[Watch] = ()) -> QuietRun:
    """Run a scenario to the end of its clock and return what has become of its trains.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """
    run = QuietRun(scenario)
    run.watches += watches
    run.execute()
    return run
