"""A train where it may take no traction current: stretches without power of the line, and a dead line.

In both it coasts, keeps its ceiling and its stops with the brakes, and feeds nothing back. On a dead line it brakes to a
stand when that has lasted for long, and does not start.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.ceiling import meet_ceiling
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.tally import TINY_S, add_brake, add_resistance, mark
from tractionpower.kernels.train_tables import (
    BRAKING,
    BY_NOTHING,
    BY_POWER_OFF,
    BY_VOLTAGE,
    COASTS,
    DARK,
    NO_DRIVE,
    POWERED,
    STANDING,
    UNPOWERED,
)
from tractionpower.kernels.wayside import additional_resistance, note_calls, power_off_at, resistance_at

DEAD, FORCED = 3, 4
"""On a dead line: the train coasts; it brakes to a stand, or stands."""

LOWEST_SHARE = 0.1
"""Least share of the service brake that is left on a fall, as in braking curves (`movement.ceiling`)."""

_CUTS = 6


@inlined
def allowed_here(tables, train, mover, time):
    """Return what the train may take: `POWERED`, `COASTS`, `DARK`, `DEAD`, `FORCED`; how far [m] and how long [s] it is so.

    `time` holds now and the time left [s].
    """
    now, left = time
    kind, room = POWERED, np.inf
    if mover.lost_s < np.inf:
        until = mover.lost_s + train.coast_s - now
        if mover.v_mps == 0.0 or until <= TINY_S:
            return FORCED, room, left
        return DEAD, room, min(left, until)
    if train.offs > 0:
        kind, room = power_off_at(tables, train, mover)
    return kind, room, left


@inlined
def so_far(tally):
    """Return what `note_without_line` compares: moving time, way, work of the resistance, electric brake, wish."""
    return tally.moving_s, tally.moved_m, tally.resistance_j, tally.electric_ns, tally.electric_j, tally.wished_ns


@njit
def note_without_line(train, mover, tally, before, allowed, spent):
    """Note that a phase of `spent` [s], behind the state `before`, was one in which the train had no traction current.

    What the electric brake gives goes to the resistors as far as they can take it, never to the line.
    """
    moving_s, moved_m, resistance_j, electric_ns, electric_j, wished_ns = before
    if moving_s - tally.off_s <= TINY_S:  # it has not pulled yet
        tally.entry_mps = mover.v_mps
    tally.off_s += tally.moving_s - moving_s
    tally.off_m += tally.moved_m - moved_m
    tally.off_j += tally.resistance_j - resistance_j
    if allowed != COASTS:
        tally.dark_s += spent
    gained_j = train.brake_efficiency * (tally.electric_j - electric_j)
    if gained_j > 0.0:
        share = min(train.rheostat_w * spent / gained_j, 1.0)
        tally.off_brake_ns += share * (tally.electric_ns - electric_ns)
        tally.off_brake_j += share * (tally.electric_j - electric_j)
        tally.electric_ns, tally.electric_j = electric_ns, electric_j
    if tally.wished_ns > wished_ns and train.drive != NO_DRIVE:
        tally.limited_by = BY_VOLTAGE if allowed >= DEAD else BY_POWER_OFF


@njit
def stand_without_line(tables, train, mover, tally, time):
    """Note the auxiliaries that a train at a stop does not get; tell whether a dead line keeps it from leaving.

    `time` holds now and the time left [s].
    """
    now, left = time
    is_dead = mover.lost_s < np.inf
    dark = is_dead
    if train.offs > 0 and not is_dead:
        dark = power_off_at(tables, train, mover)[0] == DARK
    keeps = is_dead and mover.status == STANDING and mover.leave_s < now + left
    spent = left
    if mover.status == STANDING and not keeps:
        spent = min(max(mover.leave_s - now, 0.0), left)
    if dark:
        tally.dark_s += spent
    if keeps and mover.leave_s <= now:
        mark(tally, UNPOWERED, BY_VOLTAGE)
        tally.wished_ns += train.start_n * left
    return keeps


@njit
def brake_to_stand(tables, train, mover, tally, time, rows, called):
    """Brake with the service brake on a dead line until the train stands or the time is up; return the time spent [s].

    The deceleration is that of braking curves: changed by the slope under the train, not below a tenth of the service brake.
    """
    now, left = time
    v = mover.v_mps
    if v == 0.0:
        mark(tally, UNPOWERED, BY_VOLTAGE)
        tally.wished_ns += train.start_n * left
        return left
    spent, speed, distance = left, v, v * left
    rate = resistance = 0.0
    for _ in range(_CUTS):  # a way that is cut short has another middle and mean speed
        thought = distance
        track = additional_resistance(tables, train, mover, mover.s_m + 0.5 * distance, distance)
        resistance, _ = resistance_at(train, track, 0.5 * (v + speed))
        rate = max(train.service_mps2 + track[0] / train.inertia_kg, LOWEST_SHARE * train.service_mps2)
        rate = max(rate, resistance / train.inertia_kg)
        spent, speed = left, v - rate * left
        if speed < 0.0:
            spent, speed = v / rate, 0.0
        distance = 0.5 * (v + speed) * spent
        distance, spent, speed = meet_ceiling(tables, train, mover, rows, -rate, (distance, spent, speed))
        if abs(distance - thought) <= 1e-3 * (0.1 + distance):
            break
    resistance, _ = resistance_at(train, track, 0.5 * (v + speed))
    brake = max(train.inertia_kg * rate - resistance, 0.0)
    mark(tally, BRAKING, BY_NOTHING)
    tally.wished_ns -= brake * spent
    add_brake(train, tally, brake, distance, spent)
    add_resistance(tally, train.inertia_kg * rate - brake, distance, spent)
    note_calls(tables, train, mover, called, (now, distance, -rate))
    mover.s_m += distance
    mover.v_mps = speed
    return spent
