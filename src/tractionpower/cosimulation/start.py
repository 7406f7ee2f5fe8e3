"""The state at the start of the clock: trains that started before it have run at nominal voltage until then."""

from __future__ import annotations

import numpy as np

from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.kernels.block_tables import State, new_state
from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.train_tables import POINT, TRAIN_ROW


def start_state(compiled: CompiledScenario) -> State:
    """Return the state before the first step."""
    block = compiled.block
    state, (start, step) = new_state(block), block.clock[:2].tolist()
    voltage = np.array([(0.0, compiled.movement.voltages.u_n)], POINT)
    for k in np.flatnonzero(block.trains.trains["start_s"] < start).tolist():
        steps = int(np.ceil((start - float(block.trains.trains[k]["start_s"])) / step))
        run_journey(block.trains, state.trains, k, (start - steps * step, step), voltage, np.zeros(steps, TRAIN_ROW))
    return state
