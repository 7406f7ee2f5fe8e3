"""What the track does to a train: additional resistance under its length, calls, train current limits of the line."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined

GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s2] (ISO 80000-3)."""


_POINT_M = 1e-3
"""Shortest way over which the resistance under the front is taken [m]."""


@inlined
def _profile(knots, first, last, i, at):
    """Return the knot before `at` [m], searched from the knot `i`, and height, added resistance and drag there."""
    while i < last and knots[i + 1].at_m <= at:
        i += 1
    while i > first and knots[i].at_m > at:
        i -= 1
    here = knots[i]
    if i == last or at <= here.at_m:
        return i, here.height_m, here.added_m, here.drag_kg
    after = knots[i + 1]
    x = (at - here.at_m) / (after.at_m - here.at_m)
    return (
        i,
        here.height_m + x * (after.height_m - here.height_m),
        here.added_m + x * (after.added_m - here.added_m),
        here.drag_kg + x * (after.drag_kg - here.drag_kg),
    )


@inlined
def additional_resistance(tables, train, mover, s, way):
    """Return the resistance by gradient, curves and tunnels on a `way` [m] in whose middle the front is at `s` [m].

    They act as their mean under the train, which for gradients is m g (z(s) - z(s - L)) / L; where they act under the
    front alone, as their mean over the way.

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
    length = train.spread_m
    if length == 0.0:
        length = max(way, _POINT_M)
        s += 0.5 * length
    i, height, added, drag = _profile(knots, first, last, first + mover.front, s)
    j, tail_height, tail_added, tail_drag = _profile(knots, first, last, first + mover.tail, s - length)
    mover.front, mover.tail = i - first, j - first
    rise = (height - tail_height + added - tail_added) / length
    return train.mass_kg * GRAVITY * rise, (drag - tail_drag) / length


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
