"""The theoretical journey integrated over the speed (Krzysztozek 2019, eq. 3 and 4):

    t = M int dv / (F - W),   s = M int v dv / (F - W)

Both integrals are singular where effort and resistance balance, so the form holds only while the acceleration keeps its
sign; standing, cruising, braking and the neighbourhood of the balance are run in time steps.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.effort import look_up
from tractionpower.kernels.jit import njit
from tractionpower.kernels.journey import ARRIVED, OUT_OF_ROWS, STUCK, STUCK_S
from tractionpower.kernels.pantograph import auxiliary_current
from tractionpower.kernels.series_motors import choose_notch
from tractionpower.kernels.traction import permitted_effort
from tractionpower.kernels.train_step import free_current, step_alone
from tractionpower.kernels.train_tables import (
    ACCELERATING,
    COASTING,
    NO_DRIVE,
    POWERED,
    RUNNING,
    SERIES_MOTORS,
    STAYING,
    UNPOWERED,
)
from tractionpower.kernels.wayside import additional_resistance, line_current_limit, note_calls, power_off_at

SPEED_PER_TIME = 0.2
"""Speed step over time step of the clock [m/s2]."""

BALANCE_MPS2 = 0.02
"""Below this acceleration the time form takes over."""

_CRAWL_MPS = 1e-3
_HALVINGS = 60


@njit
def run_over_speed(tables, state, k, clock, voltage, rows):
    """Run train `k` alone as `journey.run_journey` does, integrating over the speed where that is possible.

    The speed step is `SPEED_PER_TIME` times the step of `clock`; parameters and return values are the same, the rows
    are of different length.
    """
    now, h = clock
    mover = state.movers[k]
    for n in range(rows.shape[0]):
        u, _ = look_up(voltage, 0, voltage.shape[0], mover.s_m)
        spent = 0.0
        if mover.status == RUNNING:
            spent = _speed_step(tables, state, k, (now, h * SPEED_PER_TIME), u, rows[n])
        if spent == 0.0:
            step_alone(tables, state, k, (now, h), u, rows[n])
            spent = h
        now += spent
        if mover.status >= STAYING:
            return n + 1, ARRIVED, now
        if mover.held_s >= STUCK_S:
            return n + 1, STUCK, now
    return rows.shape[0], OUT_OF_ROWS, now


@njit
def _rates(tables, train, mover, v, s, u):
    """Return acceleration at greatest effort [m/s2]; power from the line, at the wheel, in resistors [W], effort [N]."""
    effort, current, resistor_w, _ = permitted_effort(tables, train, mover, max(v, _CRAWL_MPS), _lines(tables, train, mover, u))
    constant, drag = additional_resistance(tables, train, mover, s, 0.0)
    resistance = train.a_n + constant + (train.b_ns_per_m + (train.c_ns2_per_m2 + drag) * v) * v
    return (effort - resistance) / train.inertia_kg, (u * current, effort * v, resistor_w, effort)


@njit
def _speed_step(tables, state, k, clock, u, row):
    """Run one step over the speed and return its time [s]; 0 where the form does not hold, and nothing has happened."""
    now, dv = clock
    train, mover = tables.trains[k], state.movers[k]
    gap = _ceiling(tables, train, mover, mover.s_m) - mover.v_mps * mover.v_mps
    if train.plans > 0 or not u > 0.0 or (train.offs > 0 and power_off_at(tables, train, mover)[0] != POWERED):
        return 0.0
    if train.drive == SERIES_MOTORS and (mover.relay_open or u < train.relay_off_v or mover.relay_since_s < np.inf):
        return 0.0
    if gap <= 1e-6 * (1.0 + mover.v_mps * mover.v_mps) or _is_at_call(tables, train, mover):
        return 0.0
    if train.drive == SERIES_MOTORS:
        notch = choose_notch(tables, train, mover, now, free_current(tables, train, mover))
        if notch != mover.notch:
            mover.notch, mover.notch_since_s = notch, now
    first, _ = _rates(tables, train, mover, mover.v_mps, mover.s_m, u)
    if abs(first) < BALANCE_MPS2:
        return 0.0
    most = min(dv, abs(first) * dv / SPEED_PER_TIME)  # no longer than a time step: slopes and voltages change on the way
    change = most if first > 0.0 else -min(most, mover.v_mps)
    low, high, ended = 0.0, 1.0, False
    time, distance, work = _integrate(tables, train, mover, change, u)
    share = 1.0
    if time > 0.0 and _is_above(tables, train, mover, distance, change):
        for _ in range(_HALVINGS):
            share = 0.5 * (low + high)
            time, distance, work = _integrate(tables, train, mover, share * change, u)
            ended = _is_above(tables, train, mover, distance, share * change)
            if ended:
                high = share
            else:
                low = share
        share = low
        time, distance, work = _integrate(tables, train, mover, share * change, u)
    if not time > 0.0:
        return 0.0
    v = mover.v_mps
    lines = _lines(tables, train, mover, u)
    _write(train, row, (now, time, distance), (v, v + share * change), lines, work)
    _, _, _, row.limited_by = permitted_effort(tables, train, mover, max(v, _CRAWL_MPS), lines)
    row.train, row.s_m, row.moved_m, row.on_line_s = k, mover.s_m, distance, time
    row.grouping = 0
    if train.drive == SERIES_MOTORS and row.wheel_w > 0.0:
        row.grouping = tables.notches[train.first_notch + mover.notch].series
    note_calls(tables, train, mover, (state.arrived_s, state.left_s), (now, distance, share * change / time))
    mover.s_m += distance
    mover.v_mps = v + share * change
    mover.voltage_v, mover.held_s, mover.slowing, mover.lost_s = u, 0.0, change < 0.0, np.inf
    return time


@njit
def _lines(tables, train, mover, u):
    return u, line_current_limit(tables, train, mover, True)


@njit
def _is_at_call(tables, train, mover):
    if mover.stop < train.stops and tables.stops[train.first_stop + mover.stop].at_m - mover.s_m <= 1e-6:
        return True
    return train.route_m - mover.s_m <= 1e-6


@njit
def _ceiling(tables, train, mover, s):
    """Return the square of the speed ceiling at `s` [m2/s2], 0 behind the end of the route."""
    p, last = train.first_piece, train.first_piece + train.pieces - 1
    if s > tables.pieces[last].from_m:
        return 0.0
    while p < last - 1 and tables.pieces[p + 1].from_m <= s:
        p += 1
    return tables.pieces[p].w + tables.pieces[p].dw * (s - tables.pieces[p].from_m)


@njit
def _is_above(tables, train, mover, distance, change):
    """Tell whether a way passes the ceiling anywhere: a stop or a short limit may lie within it, the square of v straight.

    Where the power goes off it ends as well.
    """
    if not distance > 0.0:
        return False
    if train.offs > 0 and distance > power_off_at(tables, train, mover)[1]:
        return True
    v, w, end = mover.v_mps + change, mover.v_mps * mover.v_mps, mover.s_m + distance
    slope = (v * v - w) / distance
    for p in range(train.first_piece + mover.piece, train.first_piece + train.pieces - 1):
        piece, until = tables.pieces[p], tables.pieces[p + 1].from_m
        if until > mover.s_m:
            at = min(until, end)
            if w + slope * (at - mover.s_m) > piece.w + piece.dw * (at - piece.from_m):
                return True
            if until >= end:
                return False
    return True


@njit
def _integrate(tables, train, mover, change, u):
    """Return time, distance and the energies of `_rates` over a change of speed; time 0 where the sign changes.

    The classical Runge-Kutta method over the speed, with the distance as the only state that the right side depends on.
    """
    v, s = mover.v_mps, mover.s_m
    a1, p1 = _rates(tables, train, mover, v, s, u)
    middle, end = v + 0.5 * change, v + change
    a2, p2 = _rates(tables, train, mover, middle, s + 0.5 * change * v / a1, u)
    if a2 * a1 <= 0.0:
        return 0.0, 0.0, (0.0, 0.0, 0.0, 0.0)
    a3, p3 = _rates(tables, train, mover, middle, s + 0.5 * change * middle / a2, u)
    if a3 * a1 <= 0.0:
        return 0.0, 0.0, (0.0, 0.0, 0.0, 0.0)
    a4, p4 = _rates(tables, train, mover, end, s + change * middle / a3, u)
    if a4 * a1 <= 0.0 or abs(a4) < 0.25 * BALANCE_MPS2:
        return 0.0, 0.0, (0.0, 0.0, 0.0, 0.0)
    sixth = change / 6.0
    return (
        sixth * (1.0 / a1 + 2.0 / a2 + 2.0 / a3 + 1.0 / a4),
        sixth * (v / a1 + 2.0 * middle / a2 + 2.0 * middle / a3 + end / a4),
        (
            sixth * (p1[0] / a1 + 2.0 * p2[0] / a2 + 2.0 * p3[0] / a3 + p4[0] / a4),
            sixth * (p1[1] / a1 + 2.0 * p2[1] / a2 + 2.0 * p3[1] / a3 + p4[1] / a4),
            sixth * (p1[2] / a1 + 2.0 * p2[2] / a2 + 2.0 * p3[2] / a3 + p4[2] / a4),
            sixth * (p1[3] / a1 + 2.0 * p2[3] / a2 + 2.0 * p3[3] / a3 + p4[3] / a4),
        ),
    )


@njit
def _write(train, row, way, speeds, lines, work):
    now, time, distance = way
    line_j, wheel_j, resistor_j, effort_ns = work
    u, line_a = lines
    auxiliary_w = u * min(auxiliary_current(train, u), line_a)
    row.time_s, row.v_mps = now, speeds[0]
    row.phase = ACCELERATING if wheel_j > 0.0 else COASTING if train.drive == NO_DRIVE else UNPOWERED
    row.acceleration_mps2 = (speeds[1] - speeds[0]) / time
    row.traction_n, row.wished_n = effort_ns / time, train.start_n
    row.resistance_n = row.traction_n - train.inertia_kg * (speeds[1] ** 2 - speeds[0] ** 2) / (2.0 * distance)
    row.voltage_v, row.auxiliary_w, row.wheel_w = u, auxiliary_w, wheel_j / time
    row.power_w = line_j / time + auxiliary_w
    row.current_a = row.power_w / u if u > 0.0 else 0.0
    row.starting_resistor_w = resistor_j / time
    row.drive_loss_w = (line_j - resistor_j) / time - row.wheel_w
