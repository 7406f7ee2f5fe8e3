"""What a drive gives and takes over the speed at one voltage, as a table: greatest effort, electric brake, line power."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.effort import adhesion_limit, efficiency_at, greatest_effort
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.pantograph import auxiliary_current, current_limit
from tractionpower.kernels.series_motors import choose_notch, lowest_notch, notch_below
from tractionpower.kernels.traction import permitted_effort, traction
from tractionpower.kernels.train_tables import INVERTER, SERIES_MOTORS

SHARES = 8
"""Shares of the greatest effort between which the power from the line is taken as linear."""

FULL_N, BRAKE_N, FIRST_POWER = 0, 1, 2
COLUMNS = FIRST_POWER + SHARES + 1
"""Columns of a drive over speed: greatest effort, electric brake [N], power from the line at shares of the effort [W]."""

_CRAWL_MPS = 0.05


@njit
def tabulate_drive(tables, k, movers, lines, dv, drive):
    """Tabulate effort, electric brake and power from the line of train `k` over speed.

    Parameters
    ----------
    movers : ndarray of MOVER
        One record, in which series motors choose their notches.
    lines : tuple
        Voltage [V] and largest train current that the line allows [A]; without voltage the train has neither effort nor
        brake that feeds back.
    dv : float
        Speed between rows of `drive` [m/s].
    drive : ndarray
        Rows of `COLUMNS` values, filled.
    """
    train, mover, u = tables.trains[k], movers[0], lines[0]
    drive[:] = 0.0
    if not u > 0.0:
        return
    mover.notch, mover.notch_since_s, mover.voltage_v, mover.below = 0, -np.inf, u, -1
    limit, _ = current_limit(train, u, lines[1])
    free = max(limit - auxiliary_current(train, u), 0.0)
    for n in range(drive.shape[0]):
        v = max(n * dv, _CRAWL_MPS)
        mover.v_mps = v
        if train.drive == SERIES_MOTORS:
            mover.notch = choose_notch(tables, train, mover, 0.0, free)
        effort, current, _, _ = permitted_effort(tables, train, mover, v, lines)
        drive[n, FULL_N], drive[n, FIRST_POWER + SHARES] = effort, u * current
        if v > train.brake_from_mps:
            drive[n, BRAKE_N] = min(train.brake_n, train.brake_w / v, adhesion_limit(train, v))
        for share in range(1, SHARES):
            drive[n, FIRST_POWER + share] = _power_at(tables, train, mover, lines, (v, effort), share / SHARES)


@njit
def _power_at(tables, train, mover, lines, full, share):
    """Return the power from the line [W] at a share of the full effort: `full` holds speed [m/s] and that effort [N]."""
    v, effort = full
    need_w, midpoint = share * effort * v, (v, 0.0, 0.0, v)
    if need_w <= 0.0:
        return 0.0
    if train.drive == INVERTER:
        greatest, _, _ = greatest_effort(tables, train, mover, v)
        return need_w / efficiency_at(tables, train, v, share * effort / greatest)
    held = mover.notch
    if train.drive == SERIES_MOTORS:
        mover.notch = lowest_notch(tables, train, mover, held, need_w, midpoint)
        mover.below = notch_below(tables, train, mover, mover.notch, need_w, midpoint)
    _, current, _, _, _ = traction(tables, train, mover, need_w, lines, midpoint)
    mover.notch = held
    return lines[0] * current


@inlined
def row_of(drive, eco, v):
    """Return the row of a drive below the speed `v`, and the share of the next one."""
    x = v / eco.dv
    n = min(int(x), drive.shape[0] - 2)
    return n, min(x - n, 1.0)


@inlined
def column_at(drive, row, column):
    """Return the value of a column between the rows that `row_of` gives."""
    n, x = row
    return drive[n, column] + x * (drive[n + 1, column] - drive[n, column])
