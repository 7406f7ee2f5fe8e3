"""The theoretical journey (PT) of one train over time steps, the voltage given along its route, without a network."""

from __future__ import annotations

from tractionpower.kernels.effort import look_up
from tractionpower.kernels.jit import njit
from tractionpower.kernels.train_step import step_alone
from tractionpower.kernels.train_tables import STAYING

ARRIVED, STUCK, OUT_OF_ROWS = 0, 1, 2
"""How a journey ends: the train has left or stays, cannot go on, has used up all rows."""

STUCK_S = 60.0
"""A train that holds itself for so long at constant voltage will not go on [s]."""


@njit
def run_journey(tables, state, k, clock, voltage, rows):
    """Run train `k` alone from the start of `clock` until it has left the line, is stuck, or `rows` are full.

    Parameters
    ----------
    tables : TrainTables
    state : TrainState
        Changed in place.
    k : int
    clock : tuple
        Start [s] and step [s].
    voltage : ndarray of POINT
        Voltage [V] over the distance of the front [m]; constant beyond its ends.
    rows : ndarray of TRAIN_ROW

    Returns
    -------
    count, end : int
        Rows filled, and one of `ARRIVED`, `STUCK`, `OUT_OF_ROWS`.
    now : float
        End of the last row [s].
    """
    start, h = clock
    mover = state.movers[k]
    for n in range(rows.shape[0]):
        t = start + n * h
        u, _ = look_up(voltage, 0, voltage.shape[0], mover.s_m)
        step_alone(tables, state, k, (t, h), u, rows[n])
        if mover.status >= STAYING:
            return n + 1, ARRIVED, t + h
        if mover.held_s >= STUCK_S:
            return n + 1, STUCK, t + h
    return rows.shape[0], OUT_OF_ROWS, start + rows.shape[0] * h
