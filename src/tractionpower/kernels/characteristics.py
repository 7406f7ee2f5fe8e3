"""The characteristic F_p(v, u) of a train, traced over speed at one voltage."""

from __future__ import annotations

from tractionpower.kernels.jit import njit
from tractionpower.kernels.pantograph import auxiliary_current
from tractionpower.kernels.series_motors import choose_notch
from tractionpower.kernels.traction import permitted_effort
from tractionpower.kernels.train_step import free_current
from tractionpower.kernels.train_tables import SERIES_MOTORS

_CRAWL_MPS = 1e-3
_NO_LIMIT_A = 1e300


@njit
def trace(tables, movers, u, speed, effort, current):
    """Fill greatest effort [N] and line current [A] of the first train at the voltage `u` [V] over speeds [m/s].

    The notch of series motors is that of the greatest effort at each speed, as a train reaches it that speeds up.
    `movers` holds a record of MOVER to work with.
    """
    train = tables.trains[0]
    mover = movers[0]
    mover.voltage_v, mover.notch, mover.notch_since_s, mover.relay_open = u, 0, -1e9, False
    for n in range(speed.shape[0]):
        v = max(speed[n], _CRAWL_MPS)  # power and effort are compared by the speed
        mover.v_mps = v
        if train.drive == SERIES_MOTORS:
            mover.notch = choose_notch(tables, train, mover, 0.0, free_current(tables, train, mover))
        effort[n], current[n], _, _ = permitted_effort(tables, train, mover, v, (u, _NO_LIMIT_A))
        current[n] += auxiliary_current(train, u)
