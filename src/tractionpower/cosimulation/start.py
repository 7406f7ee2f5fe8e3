"""The state at the start of the clock: trains that started before it have run at nominal voltage until then."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.kernels.block_tables import State, new_state
from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.tally import TINY_S
from tractionpower.kernels.train_tables import GONE, OUTSIDE, POINT, STAYING, TRAIN_ROW, TrainState, TrainTables
from tractionpower.kernels.turns import hands_over, may_begin, note_finish


def start_state(compiled: CompiledScenario) -> State:
    """Return the state before the first step.

    A train that others become before the clock starts begins in the step after they have finished, as it does in a run.
    """
    block = compiled.block
    state, (start, step) = new_state(block), block.clock[:2].tolist()
    voltage = np.array([(0.0, compiled.movement.voltages.u_n)], POINT)
    trains, movers = block.trains.trains, state.trains.movers
    due = np.flatnonzero((trains["start_s"] < start) & (trains["waits"] == 0)).tolist()
    while due:
        for k in due:
            before = (start - float(state.trains.entered_s[k])) / step
            steps = int(np.floor(before + 1e-9) if trains[k]["takes_over"] else np.ceil(before))
            _run_until(block.trains, state.trains, k, (start, step, steps), voltage)
            if movers[k]["status"] >= STAYING and note_finish(block.trains, state.trains, k):
                state.progress["turning"] = True
        due = _turned(block.trains, state.trains, start)
    return state


def _run_until(
    tables: TrainTables, state: TrainState, k: int, clock: tuple[float, float, int], voltage: NDArray[np.void]
) -> None:
    """Run train `k` for so many steps up to the start of the clock; `clock` holds this, the step [s] and their number."""
    start, step, steps = clock
    run_journey(tables, state, k, (start - steps * step, step), voltage, np.zeros(steps, TRAIN_ROW))


def _turned(tables: TrainTables, state: TrainState, start: float) -> list[int]:
    """Let trains whose forerunners have all finished before the clock begin and return them; take those off the line."""
    waiting = np.flatnonzero((tables.trains["waits"] > 0) & (state.missing == 0) & (state.movers["status"] == OUTSIDE)).tolist()
    begun = [k for k in waiting if may_begin(tables, state, k, start - TINY_S)]
    state.missing[begun] = 0  # they come onto the line with the first step
    for k in np.flatnonzero((tables.trains["turns"] > 0) & (state.movers["status"] < GONE)).tolist():
        hands_over(tables, state, k)
    return begun
