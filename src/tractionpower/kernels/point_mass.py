"""A train as a point mass from one instant to another (Diviš and Kavička, TrainDyn, eq. 9, 21 and 22).

Acceleration is constant in each piece of a step, so v² and the distance have closed forms in it. A piece ends at the end
of the step and wherever the train changes what it does: at its required speed, where it meets a braking curve, at a
stand. So a stop comes inside a step, at v = 0 and at its place.
"""

from __future__ import annotations

import math

import numpy as np

from tractionpower.kernels.jit import inlined, njit

STANDING, ACCELERATING, CRUISING, DECELERATING, BRAKING_TO_STOP = 0, 1, 2, 3, 4
"""States of a train, as codes of `STATES`."""

STATES = ("standing", "accelerating", "cruising", "decelerating", "braking_to_stop")

POINT_MASS = np.dtype(
    [
        ("time_s", "f8"),
        ("place_m", "f8"),
        ("speed_mps", "f8"),
        ("required_mps", "f8"),  # speed to reach and to keep
        ("goal_m", "f8"),  # where it must have come down to `goal_mps`; infinite: nowhere
        ("goal_mps", "f8"),
        ("stops", "?"),  # brakes to a stand wherever that is
        ("stood_s", "f8"),  # when it came to a stand; NaN while it moves
        ("inertia_kg", "f8"),  # with rotating masses, m rho
        ("weight_n", "f8"),
        ("a_n", "f8"),  # running resistance a + b v + c v2
        ("b_ns_per_m", "f8"),
        ("c_ns2_per_m2", "f8"),
        ("start_n", "f8"),  # without points of the characteristic: the smaller of it and of power over speed
        ("power_w", "f8"),
        ("brake_mps2", "f8"),
        ("state", "i8"),  # what follows is what acts at the instant
        ("acceleration_mps2", "f8"),
        ("force_n", "f8"),  # at the wheel; negative: braking force
        ("resistance_n", "f8"),  # of vehicles and track
    ],
    align=True,
)
"""A train: its state, what it is asked to do, what it is. SI."""

EFFORT = np.dtype([("speed_mps", "f8"), ("effort_n", "f8")])
"""A point of a tractive characteristic: straight between points, level outside."""

SECTION = np.dtype([("from_m", "f8"), ("track_n_per_n", "f8")])
"""Resistance of the track over weight from a place on: gradient, arc, tunnel. Before the first one there is none."""

_NEAR_M, _NEAR_M2_PER_S2 = 1e-9, 1e-9
_SAME_M = 1e-6
_SHORTEST_S = 1e-12
_MOST = 1.001
"""What a brake may give over its deceleration to keep to a curve."""


@inlined
def _effort(train, effort, v):
    """Return the greatest tractive effort [N] at a speed [m/s]."""
    if effort.size == 0:
        return train.start_n if train.start_n * v <= train.power_w else train.power_w / v
    if v <= effort[0].speed_mps:
        return effort[0].effort_n
    for k in range(1, effort.size):
        if v < effort[k].speed_mps:
            low, high = effort[k - 1], effort[k]
            share = (v - low.speed_mps) / (high.speed_mps - low.speed_mps)
            return low.effort_n + share * (high.effort_n - low.effort_n)
    return effort[effort.size - 1].effort_n


@inlined
def _section(sections, place):
    """Return the last section that begins at or before a place [m], -1: none."""
    low, high = 0, sections.size
    while low < high:
        middle = (low + high) // 2
        if sections[middle].from_m <= place + _NEAR_M:
            low = middle + 1
        else:
            high = middle
    return low - 1


@inlined
def _resistance(train, sections, place, v):
    """Return the resistance [N] of vehicles (eq. 10) and track (eq. 13 to 15) at a place [m] and a speed [m/s]."""
    k = _section(sections, place)
    track = sections[k].track_n_per_n if k >= 0 else 0.0
    return train.a_n + (train.b_ns_per_m + train.c_ns2_per_m2 * v) * v + train.weight_n * track


@inlined
def _intent(train, place, v):
    """Return what the train does now, the acceleration it wishes [m/s2], the speed at which that ends [m/s].

    And whether it is on the braking curve to its goal.
    """
    b, left = train.brake_mps2, train.goal_m - place
    if v == 0.0 and (train.stops or train.required_mps == 0.0 or (train.goal_mps == 0.0 and left <= _NEAR_M)):
        return STANDING, 0.0, 0.0, False
    if train.stops:
        return BRAKING_TO_STOP, -b, 0.0, False
    u = train.goal_mps
    if v > u and v * v - u * u >= 2.0 * b * left - _NEAR_M2_PER_S2:
        # v2 - u2 = 2 b d, taken anew from the distance that is left, so that rounding does not add up.
        needed = (v * v - u * u) / (2.0 * left) if left > 0.0 else b
        return BRAKING_TO_STOP if u == 0.0 else DECELERATING, -min(needed, _MOST * b), u, left > 0.0
    if v > train.required_mps:
        return DECELERATING, -b, train.required_mps, False
    if v < train.required_mps:
        return ACCELERATING, np.inf, train.required_mps, False
    return CRUISING, 0.0, v, False


@inlined
def _acceleration(train, effort, sections, wish, place, v):
    """Return the acceleration [m/s2] at a place and speed: that wished, or else all that the effort gives (eq. 9)."""
    return min(wish, (_effort(train, effort, v) - _resistance(train, sections, place, v)) / train.inertia_kg)


@inlined
def _until_curve(train, place, v, a):
    """Return the time [s] after which a train with acceleration `a` meets the braking curve to its goal; infinite: never."""
    closing = a + train.brake_mps2
    spare = 2.0 * train.brake_mps2 * (train.goal_m - place) - v * v + train.goal_mps * train.goal_mps
    if closing <= 0.0 or not spare < np.inf:
        return np.inf
    square = closing * closing * v * v + a * closing * spare
    below = closing * v + math.sqrt(square) if square >= 0.0 else 0.0
    return max(spare, 0.0) / below if below > 0.0 else np.inf


@inlined
def _until_place(left, v, a):
    """Return the time [s] in which a train runs `left` [m]; infinite: it does not come that far."""
    square = v * v + 2.0 * a * left
    below = v + math.sqrt(square) if square >= 0.0 else 0.0
    return 2.0 * left / below if below > 0.0 else np.inf


@inlined
def _finer(train, effort, sections, wish, step, a):
    """Return acceleration and length of a piece [m/s2, s] by the midpoint rule; it ends where the track changes.

    `a` is the acceleration at its beginning, `step` its greatest length.
    """
    place, v = train.place_m, train.speed_mps
    k = _section(sections, place) + 1
    left = sections[k].from_m - place if k < sections.size else np.inf
    step = min(step, _until_place(left, v, a)) if left < np.inf else step
    middle = max(v + 0.5 * a * step, 0.0)
    ahead = min(0.5 * (v + middle) * 0.5 * step, left - 2.0 * _NEAR_M)
    a = _acceleration(train, effort, sections, wish, place + max(ahead, 0.0), middle)
    return a, min(step, _until_place(left, v, a)) if left < np.inf else step


@inlined
def _piece(train, effort, sections, step, is_fine, held):
    """Move the train by one piece of at most `step` [s] with one acceleration; return its length [s].

    `held` is the speed [m/s] at which its place moves; negative: by the mean of the speeds (eq. 22).
    """
    place, v = train.place_m, train.speed_mps
    state, wish, end, on_curve = _intent(train, place, v)
    if state == STANDING:
        return step
    a = _acceleration(train, effort, sections, wish, place, v)
    if v == 0.0 and a <= 0.0:
        return step  # it cannot start
    if is_fine:
        a, step = _finer(train, effort, sections, wish, step, a)
    length, reaches, passes = step, False, False
    if a < 0.0 and end >= v:
        end = 0.0  # the resistance takes its speed
    if a != 0.0 and (end - v) / a <= length:
        length, reaches = (end - v) / a, True
    if not on_curve and train.goal_m < np.inf:
        meets = _until_curve(train, place, v, a)
        if _SHORTEST_S < meets < length:
            length, reaches = meets, False
        there = _until_place(train.goal_m - place, v, a) if train.goal_mps > 0.0 else np.inf
        if there < length:
            length, reaches, passes = there, False, True
    train.speed_mps = end if reaches else max(v + a * length, 0.0)
    train.place_m = place + (0.5 * (v + train.speed_mps) if held < 0.0 else held) * length
    if passes or (reaches and on_curve and abs(train.place_m - train.goal_m) < _SAME_M):
        train.place_m = train.goal_m  # but for rounding it is there
    return length


@inlined
def _pass_goal(train):
    """Let a goal that has been reached with its speed be the speed to keep from there on."""
    if train.goal_mps > 0.0 and train.place_m >= train.goal_m - _NEAR_M:
        train.required_mps, train.goal_m, train.goal_mps = train.goal_mps, np.inf, 0.0


@inlined
def _tell(train, effort, sections):
    """Write what acts at the instant."""
    place, v = train.place_m, train.speed_mps
    state, wish, _, _ = _intent(train, place, v)
    resistance = _resistance(train, sections, place, v)
    a = _acceleration(train, effort, sections, wish, place, v)
    if state == STANDING or (v == 0.0 and a <= 0.0):
        train.state, train.acceleration_mps2, train.force_n, train.resistance_n = STANDING, 0.0, 0.0, 0.0
        return
    train.state, train.acceleration_mps2 = state, a
    train.force_n, train.resistance_n = train.inertia_kg * a + resistance, resistance


@njit
def advance_point_mass(trains, effort, sections, until_s, substep_s, holds_speed):
    """Move a train, the only row of `trains`, to an instant and write what acts there.

    Parameters
    ----------
    trains, effort, sections
        Arrays of `POINT_MASS`, `EFFORT` and `SECTION`.
    until_s
        The instant [s], not before that of the train.
    substep_s
        0: one evaluation of the forces at the beginning of the step (Euler, eq. 21); else steps of at most that length
        by the midpoint rule, cut where the track changes.
    holds_speed
        Whether the place moves with the speed of the beginning of the step, as between two samples in AnyLogic.
    """
    train = trains[0]
    held = train.speed_mps if holds_speed else -1.0
    while until_s - train.time_s > _SHORTEST_S:
        step = until_s - train.time_s
        step = min(step, substep_s) if substep_s > 0.0 else step
        moved = train.speed_mps > 0.0
        length = max(_piece(train, effort, sections, step, substep_s > 0.0, held), _SHORTEST_S)
        train.time_s = until_s if length >= until_s - train.time_s else train.time_s + length
        _pass_goal(train)
        if train.speed_mps > 0.0:
            train.stood_s = np.nan
        elif moved:
            train.stood_s = train.time_s
    train.time_s = until_s
    _tell(train, effort, sections)
