"""One step of one train in two halves: what it wishes, before the voltage is known, and what it does once it is.

Between them the network is solved, or a voltage is given.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.demand import demand_current, demanded_traction, fill_row, own_current
from tractionpower.kernels.driver import judge_time
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.motion import run_step
from tractionpower.kernels.pantograph import auxiliary_current, current_limit
from tractionpower.kernels.series_motors import at_full, choose_notch, lowest_notch, notch_below
from tractionpower.kernels.tally import TINY_S, powered_time
from tractionpower.kernels.train_tables import (
    BY_POWER_OFF,
    BY_STANDSTILL_CURRENT,
    DWELLING,
    HOLDING,
    INVERTER,
    NO_DRIVE,
    OUTSIDE,
    SERIES_MOTORS,
    STANDING,
    WAITING,
)
from tractionpower.kernels.wayside import line_current_limit

_SAME = 1e-12
_EXPECTED = 1e-9
_FULL = 1e-9
_MATCH = 1e-10
_MOST_TRIES = 60


@inlined
def wish(tables, state, k, t, h, is_dead=False):
    """Let train `k` try the step from `t` [s] of length `h` [s] as if the voltage did not limit it.

    Writes the trial, its tally and its demand; series motors choose their notch, held while the network is solved. On a
    dead line a train knows that it has no voltage; one without a drive wants none.
    """
    train, mover, trial = tables.trains[k], state.movers[k], state.trials[k]
    called = (state.arrived_s, state.left_s)
    if is_dead or mover.lost_s < np.inf:
        mover.lost_s = min(mover.lost_s, t) if is_dead and train.drive != NO_DRIVE else np.inf
    if train.dues > 0:
        judge_time(tables, train, mover, t)
    state.trials[k] = mover
    if train.drive == SERIES_MOTORS:
        _switch_relay(train, trial, t, h)
        trial.notch = choose_notch(tables, train, trial, t, free_current(tables, train, trial))
    tally = state.wishes[k]
    run_step(tables, train, trial, tally, (t, h), np.inf, called)
    if train.drive == SERIES_MOTORS:
        _hold_notch(tables, train, mover, trial, tally, t)
    demand = state.demands[k]
    _write_demand(tables, train, mover, tally, demand, h)
    trial.limit = mover.limit  # where the train was is what counts
    if brakes_after_traction(train, tally):
        expect_braking(tables, state, k, (t, h), mover.voltage_v)


@inlined
def brakes_after_traction(train, tally):
    """Tell whether a step holds both traction and braking that could feed back."""
    return train.regenerates and tally.electric_j > 0.0 and tally.traction_j > 0.0


@njit
def expect_braking(tables, state, k, clock, u):
    """Take the braking of a step that begins with traction from what the voltage `u` [V] permits; tell whether it changes.

    With the whole effort the train would come onto its braking curve faster, or at all.
    """
    train, mover, trial, demand = tables.trains[k], state.movers[k], state.trials[k], state.demands[k]
    got_w, _, _, _, _ = demanded_traction(tables, train, trial, demand, u)
    if abs(got_w - demand.expected_w) <= _EXPECTED * demand.need_w:
        return False
    before = demand.gained_w
    if got_w >= demand.need_w * (1.0 - _SAME):
        demand.gained_w = train.brake_efficiency * state.wishes[k].electric_j / clock[1]
    else:
        _retry(tables, state, k, clock, got_w * demand.moving)
        demand.gained_w = train.brake_efficiency * state.done[k].electric_j / clock[1]
        _restart(tables, state, k)
        run_step(tables, train, trial, state.wishes[k], clock, np.inf, (state.arrived_s, state.left_s))
        trial.limit = mover.limit
    demand.expected_w = got_w
    return demand.gained_w != before


@inlined
def _write_demand(tables, train, mover, tally, demand, h):
    """Note what the trial asks of the line; limits hold while the train moves, powers are means of the step."""
    powered_s, supplied_s = powered_time(tally), tally.on_line_s - tally.dark_s
    demand.moving, demand.on_line = powered_s / h, supplied_s / h if supplied_s > TINY_S else 0.0
    demand.need_w = tally.line_j / powered_s if powered_s > 0.0 else 0.0
    demand.line_a = line_current_limit(tables, train, mover, tally.moving_s > 0.0)
    demand.gained_w, demand.expected_w = train.brake_efficiency * tally.electric_j / h, demand.need_w
    demand.speed_mps, demand.half_s_per_kg, demand.resistance_n, demand.mean_mps = midpoint_of(train, tally)


@inlined
def _hold_notch(tables, train, mover, trial, tally, t):
    """Hold the notch of the trial, or a lower one where the train wishes less than it gives."""
    best = trial.notch
    trial.below = -1
    powered_s = powered_time(tally)
    need_w = tally.line_j / powered_s if powered_s > 0.0 else 0.0
    is_full = tally.wished_ns >= train.start_n * tally.moving_s * (1.0 - _FULL)
    if need_w > 0.0 and not (is_full or trial.relay_open):
        speeds = midpoint_of(train, tally)
        _, most, _ = at_full(tables, tables.notches[train.first_notch + best], mover.voltage_v, speeds)
        if need_w < most:
            trial.notch = lowest_notch(tables, train, mover, best, need_w, speeds)
            trial.below = notch_below(tables, train, mover, trial.notch, need_w, speeds)
    if trial.notch != mover.notch:
        trial.notch_since_s = t


@inlined
def midpoint_of(train, tally):
    """Return speed at the start [m/s], half of time over inertia [s/kg], resistance [N], mean speed [m/s] of a step.

    Of a step a part of which is without power they are those of the rest.

    The mean speed of another effort F follows from the first three, v + (F - W) t / 2 M. The resistance is that of the
    trial, whose effort differs from the one permitted by what the voltage takes away.
    """
    v, way, time = tally.entry_mps, tally.moved_m - tally.off_m, powered_time(tally)
    if way <= 0.0 or time == 0.0:
        return v, 0.0, 0.0, v
    return v, 0.5 * time / train.inertia_kg, (tally.resistance_j - tally.off_j) / way, way / time


@inlined
def free_current(tables, train, mover):
    """Return the current that limits leave for traction at the last voltage [A]."""
    u = mover.voltage_v
    limit, _ = current_limit(train, u, line_current_limit(tables, train, mover, True))
    return max(limit - auxiliary_current(train, u), 0.0)


@inlined
def _switch_relay(train, mover, t, h):
    """Open or close the undervoltage relay by the voltage of the step before; closing starts in the first grouping."""
    u = mover.voltage_v
    asks = u > train.relay_on_v if mover.relay_open else u < train.relay_off_v
    if not asks:
        mover.relay_since_s = np.inf
        return
    mover.relay_since_s = min(mover.relay_since_s, t - h)
    if t - mover.relay_since_s >= train.relay_s:
        mover.relay_open = not mover.relay_open
        mover.relay_since_s = np.inf
        mover.notch, mover.notch_since_s = 0, t


@inlined
def settle(tables, state, k, clock, line, row):
    """Let train `k` do what the voltage permits of its wish, and fill `row`.

    Parameters
    ----------
    clock : tuple
        Start and length of the step [s].
    line : tuple
        Voltage [V], current of the whole train [A], and the share of its demand that the line serves: 1 unless all demand
        had to be cut.
    """
    t, h = clock
    u, current, served = line
    train, mover, trial, demand = tables.trains[k], state.movers[k], state.trials[k], state.demands[k]
    wished = done = state.wishes[k]
    got_w, taken, resistor_w, by, _ = demanded_traction(tables, train, trial, demand, u)
    got_w *= served
    row.train, row.time_s, row.s_m, row.v_mps = k, t, mover.s_m, mover.v_mps
    limited_by = wished.limited_by
    if not got_w >= demand.need_w * (1.0 - _SAME):
        _retry(tables, state, k, clock, got_w * demand.moving)
        done, limited_by = state.done[k], by if limited_by != BY_POWER_OFF else limited_by
    v = mover.v_mps
    state.movers[k] = trial
    mover.voltage_v, mover.slowing = u, mover.v_mps < v
    row.grouping = 0
    if train.drive == SERIES_MOTORS:
        if done.traction_j > 0.0:
            row.grouping = tables.notches[train.first_notch + mover.notch].series
        else:  # motors that were off start in the first grouping
            mover.notch, mover.notch_since_s = 0, -np.inf
    stuck = mover.status <= STANDING and mover.v_mps == 0.0 and done.phase >= HOLDING
    mover.held_s = mover.held_s + h if stuck else 0.0
    part = demand.moving * served
    parts = (u * own_current(train, demand, u) * served, u * taken * part, resistor_w * part)
    fill_row(train, done, row, h, (u, current), parts)
    row.wished_n = wished.wished_ns / h
    row.acceleration_mps2 = (mover.v_mps - v) / h
    row.phase = done.phase
    if row.phase < 0:
        row.phase = WAITING if mover.status == OUTSIDE else DWELLING
    row.limited_by = limited_by
    if done.phase == DWELLING and _cuts_auxiliaries(train, done, demand, u):
        row.limited_by = BY_STANDSTILL_CURRENT
    state.done[k] = done  # last: a copy of what has just been written makes the processor wait


@inlined
def _cuts_auxiliaries(train, done, demand, u):
    """Tell whether the line cuts the auxiliaries of a train that stands through the step."""
    if done.moving_s > 0.0 or demand.on_line == 0.0 or not u > 0.0:
        return False
    return auxiliary_current(train, max(u, train.lowest_v)) > demand.line_a


@njit
def step_alone(tables, state, k, clock, u, row):
    """Run train `k` over the step (start, length) [s] on an infinite bus of the voltage `u` [V], and fill `row`."""
    wish(tables, state, k, clock[0], clock[1], not u > 0.0)
    current, _ = demand_current(tables, tables.trains[k], state.trials[k], state.demands[k], u)
    settle(tables, state, k, clock, (u, current, 1.0), row)


@njit
def _retry(tables, state, k, clock, target_w):
    """Run the step again with the mean power `target_w` [W] (of an inverter drive from the line, of others at the wheel).

    A step in one phase meets it at once. In a step of several phases the power within a phase is sought by regula
    falsi: the work grows with it.
    """
    train, trial, done = tables.trains[k], state.trials[k], state.done[k]
    ratio = train.efficiency if train.drive == INVERTER else 1.0
    low, low_w, high, high_w = 0.0, 0.0, np.inf, np.inf
    cap = target_w
    for _ in range(_MOST_TRIES):
        _restart(tables, state, k)
        run_step(tables, train, trial, done, clock, cap * ratio, (state.arrived_s, state.left_s))
        got = done.line_j / clock[1]
        if abs(got - target_w) <= _MATCH * target_w or target_w <= 0.0:
            return
        if got < target_w:
            low, low_w = cap, got
        else:
            high, high_w = cap, got
        if high == np.inf:
            cap = min(cap * max(target_w / got, 1.5), 1e12) if got > 0.0 else 1e12
        elif high - low <= _MATCH * high:
            return
        else:
            cap = low + (high - low) * min(max((target_w - low_w) / (high_w - low_w), 0.05), 0.95)


@njit
def _restart(tables, state, k):
    """Put the trial of train `k` back to the start of the step; its notch and relay stay as they were chosen."""
    train, mover, trial = tables.trains[k], state.movers[k], state.trials[k]
    for n in range(mover.stop, min(trial.stop + 1, train.stops)):
        state.left_s[train.first_stop + n] = np.nan
        if n > mover.stop or mover.status != STANDING:
            state.arrived_s[train.first_stop + n] = np.nan
    notch, below, since = trial.notch, trial.below, trial.notch_since_s
    is_open, asked = trial.relay_open, trial.relay_since_s
    state.trials[k] = mover
    trial.notch, trial.below, trial.notch_since_s = notch, below, since
    trial.relay_open, trial.relay_since_s = is_open, asked
