"""The driver: follows the plan of the train while it is on time, drives flat out while it is late."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.effort import greatest_effort, look_up
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.wayside import additional_resistance, resistance_at, value_at

NO_CEILING = 1e-10
"""Share by which a square of a speed may pass a ceiling by rounding."""

CRAWL_MPS = 1.0
"""Below this speed a driver does not coast on, so that no train comes to a stand on its way [m/s]."""

_LEAST_SLOWING = 0.01
"""A train that coasts is taken to slow down by this at least [m/s2]."""

_SLOWEST_MPS = 0.5
_LEAST_S = 1e-3


@njit
def judge_time(tables, train, mover, now):
    """Note whether a train is late at the time `now` [s]: it is from `late_s` behind its plan on until it can catch up.

    A train that is faster than its plan comes down to it by coasting, and is early for each metre on the way: what it gains
    counts, or it would come down too late and be early for good.
    """
    due, _ = look_up(tables.points, train.first_due, train.dues, mover.s_m)
    behind = now - due
    if behind > 0.0:
        behind -= _gain(tables, train, mover)
    mover.late = behind > (0.0 if mover.late else train.late_s)


@njit
def _gain(tables, train, mover):
    """Return how much earlier a train is by coasting down to the speed of its plan than it would be by its plan [s].

    With the deceleration a constant on the way D from v down to the speed p of the plan, that is D / p - (v - p) / a. The way
    ends where the train would have to brake for its next stop.
    """
    p, _ = _piece_at(tables, train.first_plan, train.plans, mover.s_m)
    piece, v = tables.pieces[p], mover.v_mps
    planned = max(piece.w + piece.dw * (mover.s_m - piece.from_m), 0.0) ** 0.5
    if v <= planned or planned < _SLOWEST_MPS:
        return 0.0
    track = additional_resistance(tables, train, mover, mover.s_m, 0.0)
    resistance, _ = resistance_at(train, track, 0.5 * (v + planned))
    slowing = max(resistance / train.inertia_kg, _LEAST_SLOWING)
    end = train.route_m
    for row in range(train.first_stop + mover.stop, train.first_stop + train.stops):
        if tables.stops[row].stops:
            end = tables.stops[row].at_m
            break
    room = end - mover.s_m - 0.5 * v * v / train.service_mps2
    way = min(0.5 * (v * v - planned * planned) / slowing, max(room, 0.0))
    slower = max(v * v - 2.0 * slowing * way, 0.0) ** 0.5
    return way / planned - (v - slower) / slowing


@inlined
def follows_plan(train, mover):
    """Tell whether a train has a plan and is on time."""
    return train.plans > 0 and not mover.late


@njit
def planned_here(tables, train, mover):
    """Return what the plan says where the front is.

    Returns
    -------
    share : float
        Share of the greatest effort, 0 while coasting.
    room, time : float
        How far [m] and how long [s] that holds.
    p, last : int
        Row of the ceiling that is kept, and its last row: that of the plan, or that of the train where it is faster than the
        plan; then it coasts.
    """
    p, last = _piece_at(tables, train.first_plan, train.plans, mover.s_m)
    piece = tables.pieces[p]
    ceiling = piece.w + piece.dw * (mover.s_m - piece.from_m)
    if mover.v_mps * mover.v_mps > ceiling + NO_CEILING * (1.0 + ceiling):
        p, last = _piece_at(tables, train.first_piece, train.pieces, mover.s_m)
        return 0.0, np.inf, np.inf, p, last
    share, room = value_at(tables.points, train.first_cap, train.caps, mover.s_m)
    if share == 0.0 and mover.v_mps < CRAWL_MPS:
        return 1.0, room, _time_to_crawl(tables, train, mover), p, last
    return share, room, np.inf, p, last


@inlined
def _time_to_crawl(tables, train, mover):
    """Return how long a train with all its effort takes to the speed from which on its driver coasts [s]."""
    track = additional_resistance(tables, train, mover, mover.s_m, 0.0)
    effort, _, _ = greatest_effort(tables, train, mover, CRAWL_MPS)
    resistance, _ = resistance_at(train, track, CRAWL_MPS)
    if effort <= resistance:
        return np.inf
    return max((CRAWL_MPS - mover.v_mps) * train.inertia_kg / (effort - resistance), _LEAST_S)


@inlined
def _piece_at(tables, first, count, s):
    """Return the row of a ceiling at `s` [m], not the last one, and its last row."""
    low, high = first, first + count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if tables.pieces[middle].from_m <= s:
            low = middle
        else:
            high = middle
    return low, first + count - 1
