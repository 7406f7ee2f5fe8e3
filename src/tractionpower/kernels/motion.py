"""The motion of one train over one step (Krzysztozek 2019, eq. 1 and 2), split wherever something happens inside it.

    M dv/dt = F - B - W_p(v) - W_d(s),   ds/dt = v

A step is cut into phases: standing, accelerating at the greatest effort below the speed ceiling, following the ceiling at
constant speed or down a braking curve. In a phase the acceleration is constant, forces are taken at its mean speed and
middle place, so that force times distance is exactly the change of kinetic energy. In a phase v2 is linear in s, and so is
the ceiling: they meet in a closed form.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.ceiling import meet_ceiling, time_of
from tractionpower.kernels.driver import NO_CEILING, follows_plan, planned_here
from tractionpower.kernels.effort import greatest_effort
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.tally import TINY_S, add_brake, add_resistance, add_traction, clear, mark
from tractionpower.kernels.train_tables import (
    ACCELERATING,
    BRAKING,
    BY_DRIVE,
    BY_NOTHING,
    BY_SPEED,
    COASTING,
    CRUISING,
    DWELLING,
    GONE,
    HOLDING,
    LEAVE,
    NO_DRIVE,
    OUTSIDE,
    POWERED,
    RUNNING,
    STANDING,
    STAY,
    STAYING,
    UNPOWERED,
)
from tractionpower.kernels.wayside import HERE_M, additional_resistance, note_calls, resistance_at
from tractionpower.kernels.without_line import (
    FORCED,
    allowed_here,
    brake_to_stand,
    note_without_line,
    so_far,
    stand_without_line,
)

_MOST_IDLE = 1000
_CUTS = 6
_NEWTON_STEPS = 30


@njit
def run_step(tables, train, mover, tally, clock, cap_w, called):
    """Move a train over one step.

    Parameters
    ----------
    tables : TrainTables
    train, mover, tally : records of TRAIN, MOVER, TALLY
        `mover` is moved, `tally` is filled.
    clock : tuple
        Start [s] and length [s] of the step.
    cap_w : float
        Largest tractive power at the wheel [W]; infinite: only the drive and adhesion limit it.
    called : tuple
        Arrays of arrivals and departures by row of the stops [s], which are written.
    """
    if train.offs > 0 or mover.lost_s < np.inf or train.plans > 0:
        _run_restricted(tables, train, mover, tally, clock, cap_w, called)
    else:
        _run_phases(tables, train, mover, tally, clock, cap_w, called, False)


@njit
def _run_restricted(tables, train, mover, tally, clock, cap_w, called):
    """Do what `run_step` does by a plan, on a route with stretches without power, or on a dead line."""
    _run_phases(tables, train, mover, tally, clock, cap_w, called, True)


@inlined
def _run_phases(tables, train, mover, tally, clock, cap_w, called, is_restricted):
    """Run the phases of a step; whether there is a plan, or power may be off, is known when this is compiled, twice."""
    clear(tally, mover.v_mps)
    now, end = clock[0], clock[0] + clock[1]
    idle = 0
    while idle < _MOST_IDLE:  # arrivals and departures take no time; a phase does
        left = end - now
        idle += 1
        if left <= TINY_S or mover.status == GONE:
            break
        if mover.status == OUTSIDE:
            if mover.leave_s >= end - TINY_S:
                break
            now = max(now, mover.leave_s)
            mover.status = RUNNING
            continue
        if mover.status == RUNNING and _arrive(tables, train, mover, now, called):
            continue
        if mover.status == RUNNING:
            spent = _run(tables, train, mover, tally, (now, left), cap_w, called, is_restricted)
        else:
            spent = _stand(tables, train, mover, tally, (now, left), called, is_restricted)
        tally.on_line_s += spent
        now += spent
        if spent > TINY_S:
            idle = 0


@inlined
def _arrive(tables, train, mover, now, called):
    """End the run of a train that is at a stop or at the end of its route; tell whether it is."""
    if mover.stop < train.stops:
        row = train.first_stop + mover.stop
        stop = tables.stops[row]
        if stop.stops and stop.at_m - mover.s_m <= HERE_M:
            called[0][row] = now
            mover.s_m, mover.v_mps, mover.status = stop.at_m, 0.0, STANDING
            dwell = stop.dwell_s if stop.at_m > HERE_M else 0.0  # a run that begins there has been standing already
            mover.leave_s = max(now + dwell, stop.departure_s)
            return True
        if stop.at_m - mover.s_m <= HERE_M:
            called[0][row] = called[1][row] = now
            mover.stop += 1
            return True
    if train.route_m - mover.s_m <= HERE_M:
        mover.s_m = train.route_m
        _finish(train, mover, now)
        return True
    return False


@inlined
def _stand(tables, train, mover, tally, time, called, is_restricted):
    """Let a train stand until it may leave; return the time spent [s]."""
    now, left = time
    if is_restricted and stand_without_line(tables, train, mover, tally, time):
        return left
    if tally.phase < 0:
        tally.phase = DWELLING
    if mover.status == STAYING or mover.leave_s >= now + left:
        return left
    row = train.first_stop + mover.stop
    spent = max(mover.leave_s - now, 0.0)
    called[1][row] = now + spent
    mover.stop += 1
    mover.status = RUNNING
    if mover.stop == train.stops and train.end != LEAVE and train.route_m - mover.s_m <= HERE_M:
        _finish(train, mover, now + spent)
    return spent


@inlined
def _finish(train, mover, now):
    mover.status = STAYING if train.end == STAY else GONE
    mover.finished_s = now


@inlined
def _run(tables, train, mover, tally, time, cap_w, called, is_restricted):
    """Run one phase; return the time spent [s]."""
    pieces, p = tables.pieces, train.first_piece + mover.piece
    last = train.first_piece + train.pieces - 1
    while p < last - 1 and pieces[p + 1].from_m <= mover.s_m:
        p += 1
    mover.piece = p - train.first_piece
    now, left = time
    if is_restricted:
        return _run_where_allowed(tables, train, mover, tally, time, cap_w, called)
    rows, caps = (p, last), (cap_w, 1.0)
    if _is_below(tables, mover, p):
        return _accelerate(tables, train, mover, tally, (now, left, mover.v_mps * left, True, np.inf), rows, caps, called)
    return _follow(tables, train, mover, tally, (now, left, np.inf), rows, caps, called)


@inlined
def _is_below(tables, mover, p):
    """Tell whether a train may go faster: it stands, or is below its ceiling, whose row is `p`."""
    piece = tables.pieces[p]
    ceiling = piece.w + piece.dw * (mover.s_m - piece.from_m)
    return mover.v_mps * mover.v_mps < ceiling - NO_CEILING * (1.0 + ceiling) or mover.v_mps == 0.0


@njit
def _run_where_allowed(tables, train, mover, tally, time, cap_w, called):
    """Run one phase by a plan, on a route with stretches without power, or on a dead line; return the time spent [s]."""
    now = time[0]
    allowed, room, left = allowed_here(tables, train, mover, time)
    share, rows = 1.0, (train.first_piece + mover.piece, train.first_piece + train.pieces - 1)
    if follows_plan(train, mover):
        share, way, seconds, p, last = planned_here(tables, train, mover)
        room, left, rows = min(room, way), min(left, seconds), (p, last)
    caps = (cap_w if allowed == POWERED else 0.0, share)
    before = so_far(tally)
    is_below, falls = _is_below(tables, mover, rows[0]), tables.pieces[rows[0]].dw < 0.0
    if allowed == FORCED and (is_below or not falls):
        spent = brake_to_stand(tables, train, mover, tally, (now, left), rows, called)
    elif is_below:
        spent = _accelerate(tables, train, mover, tally, (now, left, mover.v_mps * left, True, room), rows, caps, called)
    else:
        spent = _follow(tables, train, mover, tally, (now, left, room), rows, caps, called)
    if allowed != POWERED:
        note_without_line(train, mover, tally, before, allowed, spent)
    return spent


@inlined
def _effort(tables, train, mover, v, caps):
    """Return effort [N], its derivative and what limits it.

    `caps` are a power at the wheel [W] and the share of the greatest effort that the driver asks for.
    """
    cap_w, share = caps
    if cap_w <= 0.0 or share <= 0.0:
        return 0.0, 0.0, BY_DRIVE if share > 0.0 else BY_NOTHING
    effort, slope, by = greatest_effort(tables, train, mover, v)
    effort, slope = share * effort, share * slope
    if effort * v > cap_w:
        effort = cap_w / v
        slope = -effort / v
    return effort, slope, by


@inlined
def _balance(tables, train, mover, track, tau, caps):
    """Return effort and resistance [N] at the mean speed [m/s] that they lead to within `tau` [s], and what limits it.

    The mean speed solves v_m = v + (F(v_m) - W(v_m)) tau / 2 M: the implicit midpoint rule, by Newton's method. A small
    power gives an effort so steep near standstill that Newton alone would jump over the solution and back for ever: a
    step that leaves what is known to hold the solution goes to the middle of it.
    """
    v = mover.v_mps
    half = 0.5 * tau / train.inertia_kg
    mean, low, high = v, -1.0, v + half * train.start_n + 1e3
    effort, resistance, by = 0.0, 0.0, BY_DRIVE
    for _ in range(_NEWTON_STEPS):
        effort, slope, by = _effort(tables, train, mover, mean, caps)
        resistance, rise = resistance_at(train, track, mean)
        gap = v + half * (effort - resistance) - mean
        if gap > 0.0:
            low = mean
        else:
            high = mean
        after = max(mean + gap / max(1.0 - half * (slope - rise), 1e-3), 0.0)  # tables may rise with the speed
        if abs(after - mean) <= 1e-12 * (1.0 + v):
            mean = after
            break
        mean = after if low < after < high else 0.5 * (low + high)
    return mean, effort, resistance, by


@inlined
def _accelerate(tables, train, mover, tally, time, rows, caps, called):
    """Run with the greatest effort until the time is up, the ceiling is met, the route ends or the train comes to a stand.

    `time` holds now, the time left, about how far the train comes [m], whether the ceiling can be met, and the way to where
    power goes off or on, or the plan changes [m]; `rows` are the row of the ceiling here and its last one, `caps` those of
    `_effort`.
    """
    now, tau, distance, free, room = time
    v, meant = mover.v_mps, tau
    effort = resistance = acceleration = spent = speed = 0.0
    by = BY_DRIVE
    near = 1e-3 if train.spread_m == 0.0 else 0.1  # slopes change little under a long train
    for _ in range(_CUTS):  # a way that is cut short has another middle and mean speed
        thought = distance
        track = additional_resistance(tables, train, mover, mover.s_m + 0.5 * distance, distance)
        mean, effort, resistance, by = _balance(tables, train, mover, track, meant, caps)
        if v == 0.0 and mean <= 0.0:
            mark(tally, HOLDING if effort > 0.0 else _unpowered(train, caps), by)
            tally.wished_ns += caps[1] * train.start_n * tau
            return tau
        acceleration = (effort - resistance) / train.inertia_kg
        spent, speed = tau, v + acceleration * tau
        if speed < 0.0:
            spent, speed = -v / acceleration, 0.0
        distance = 0.5 * (v + speed) * spent
        if free:
            distance, spent, speed = meet_ceiling(tables, train, mover, rows, acceleration, (distance, spent, speed))
        if distance > room:
            distance, speed = room, np.sqrt(max(v * v + 2.0 * acceleration * room, 0.0))
            spent = time_of(distance, v, speed)
        if abs(spent - meant) <= TINY_S and abs(distance - thought) <= near * (0.1 + distance):
            break
        meant = max(spent, TINY_S)
    full_n = caps[1] * train.start_n
    mark(tally, ACCELERATING if effort > 0.0 else _unpowered(train, caps), BY_NOTHING if effort >= full_n else by)
    tally.wished_ns += full_n * spent
    add_traction(tables, train, mover, tally, effort, (distance, spent))
    add_resistance(tally, resistance, distance, spent)
    _advance(tables, train, mover, called, (now, distance, acceleration), speed)
    return spent


@inlined
def _follow(tables, train, mover, tally, time, rows, caps, called):
    """Follow the ceiling to the end of its piece or of the time; fall below it where the effort is too small."""
    now, left, room = time
    p = rows[0]
    piece, end = tables.pieces[p], min(tables.pieces[p + 1].from_m, mover.s_m + room)
    v, slowing = mover.v_mps, -0.5 * piece.dw
    final = np.sqrt(max(piece.w + piece.dw * (end - piece.from_m), 0.0))
    spent = time_of(end - mover.s_m, v, final)
    speed, distance = final, end - mover.s_m
    if spent > left:
        spent, speed = left, max(v - slowing * left, 0.0)
        distance = 0.5 * (v + speed) * spent
    mean = 0.5 * (v + speed)
    track = additional_resistance(tables, train, mover, mover.s_m + 0.5 * distance, distance)
    resistance, _ = resistance_at(train, track, mean)
    needed = resistance - train.inertia_kg * slowing
    if needed > 0.0:
        effort, _, _ = _effort(tables, train, mover, mean, caps)
        if needed > effort:
            return _accelerate(tables, train, mover, tally, (now, spent, distance, False, room), rows, caps, called)
        add_traction(tables, train, mover, tally, needed, (distance, spent))
    else:
        add_brake(train, tally, -needed, distance, spent)
    mark(tally, CRUISING if slowing == 0.0 else BRAKING, BY_SPEED if slowing == 0.0 else BY_NOTHING)
    tally.wished_ns += needed * spent
    add_resistance(tally, resistance, distance, spent)
    _advance(tables, train, mover, called, (now, distance, -slowing), speed)
    return spent


@inlined
def _advance(tables, train, mover, called, way, speed):
    note_calls(tables, train, mover, called, way)
    mover.s_m += way[1]
    mover.v_mps = speed


@inlined
def _unpowered(train, caps):
    return COASTING if train.drive == NO_DRIVE or caps[1] == 0.0 else UNPOWERED
