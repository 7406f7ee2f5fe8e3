"""What the track does to a train: additional resistance, calls, stretches without power, train current limits."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import inlined

GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s2] (ISO 80000-3)."""

HERE_M = 1e-6
"""A front this near to a place is there [m]."""

_POINT_M = 1e-3
"""Shortest way over which the resistance under the front is taken [m]."""


@inlined
def _find(knots, first, last, i, at):
    """Return the knot before `at` [m], searched from the knot `i`."""
    while i < last and knots[i + 1].at_m <= at:
        i += 1
    while i > first and knots[i].at_m > at:
        i -= 1
    return i


@inlined
def _profile(knots, last, i, at):
    """Return height and drag at a place `at` [m] behind the knot `i`, or before the first knot."""
    here = knots[i]
    if i == last or at <= here.at_m:
        return here.height_m, here.drag_kg
    after = knots[i + 1]
    x = (at - here.at_m) / (after.at_m - here.at_m)
    return here.height_m + x * (after.height_m - here.height_m), here.drag_kg + x * (after.drag_kg - here.drag_kg)


@inlined
def _mean_profile(knots, last, i, at, way):
    """Return the means of height and drag over a `way` [m] from `at` [m] on, which lies behind the knot `i`."""
    height, drag = _profile(knots, last, i, at)
    if way <= 0.0:
        return height, drag
    heights = drags = 0.0
    end, x = at + way, at
    while x < end:
        while i < last and knots[i + 1].at_m <= x:
            i += 1
        corner = end
        if knots[i].at_m > x:  # before the first knot
            corner = knots[i].at_m
        elif i < last:
            corner = knots[i + 1].at_m
        until = min(end, corner)
        height_after, drag_after = _profile(knots, last, i, until)
        heights += 0.5 * (height + height_after) * (until - x)
        drags += 0.5 * (drag + drag_after) * (until - x)
        x, height, drag = until, height_after, drag_after
    return heights / way, drags / way


@inlined
def additional_resistance(tables, train, mover, s, way):
    """Return the mean resistance by gradient, curves and tunnels on a `way` [m] in whose middle the front is at `s` [m].

    They act as their mean under the train, which for gradients is m g (z(s) - z(s - L)) / L, or under the front alone.

    Returns
    -------
    constant_n : float
        Gradient, curves, tunnels [N].
    drag : float
        Factor of v2 that tunnels add [N s2/m2].
    """
    knots, first = tables.knots, train.first_knot
    last = first + train.knots - 1
    if last <= first:
        return 0.0, 0.0
    length, start = train.spread_m, s - 0.5 * way
    if length == 0.0:  # the mean over the way is that under a train as long as the way
        length = max(way, _POINT_M)
        start, way = s + 0.5 * length, 0.0
    i = _find(knots, first, last, first + mover.front, start)
    j = _find(knots, first, last, first + mover.tail, start - length)
    mover.front, mover.tail = i - first, j - first
    height, drag = _mean_profile(knots, last, i, start, way)
    tail_height, tail_drag = _mean_profile(knots, last, j, start - length, way)
    return train.mass_kg * GRAVITY * (height - tail_height) / length, (drag - tail_drag) / length


@inlined
def resistance_at(train, track, v):
    """Return the resistance [N] and its derivative [N s/m] at the speed `v`, with the additional one of the place."""
    drag = train.c_ns2_per_m2 + track[1]
    return train.a_n + track[0] + (train.b_ns_per_m + drag * v) * v, train.b_ns_per_m + 2.0 * drag * v


@inlined
def value_at(points, first, count, s):
    """Return what holds at the place `s` [m] by rows that hold from their `x` on, and how far it holds [m]."""
    low, end = first, first + count
    high = end
    while high - low > 1:
        middle = (low + high) // 2
        if points[middle].x <= s + HERE_M:
            low = middle
        else:
            high = middle
    return points[low].y, points[high].x - s if high < end else np.inf


@inlined
def power_off_at(tables, train, mover):
    """Return what the front may take where it is, one of `POWERED`, `COASTS`, `DARK`, and how far that holds [m]."""
    kind, room = value_at(tables.points, train.first_off, train.offs, mover.s_m)
    return int(kind), room


@inlined
def line_current_limit(tables, train, mover, moves):
    """Return the largest train current that the line allows where the front is [A], standing if it does not move."""
    if train.limits == 0:
        return 1e300
    limits, first = tables.limits, train.first_limit
    while mover.limit + 1 < train.limits and limits[first + mover.limit + 1].from_m <= mover.s_m:
        mover.limit += 1
    here = limits[first + mover.limit]
    return here.max_a if moves else here.standstill_a


@inlined
def note_calls(tables, train, mover, called, way):
    """Note when the front passes calls without a stop on its way.

    Parameters
    ----------
    called : tuple
        Arrays of arrivals and departures [s].
    way : tuple
        Time at its start [s], distance [m] and acceleration [m/s2]; it starts at the place and speed of `mover`.
    """
    now, distance, acceleration = way
    stops, arrived, left = tables.stops, called[0], called[1]
    while mover.stop < train.stops:
        row = train.first_stop + mover.stop
        ahead = stops[row].at_m - mover.s_m
        if stops[row].stops or ahead > distance:
            return
        v, w = mover.v_mps, mover.v_mps * mover.v_mps + 2.0 * acceleration * ahead
        speeds = v + (w**0.5 if w > 0.0 else 0.0)
        arrived[row] = now + (2.0 * ahead / speeds if speeds > 0.0 else 0.0)
        left[row] = arrived[row]
        mover.stop += 1
