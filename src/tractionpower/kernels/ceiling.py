"""Where a train that moves with constant acceleration meets its speed ceiling, or the end of its route."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import inlined


@inlined
def meet_ceiling(tables, train, mover, rows, acceleration, way):
    """Shorten a way (distance, time, speed at its end) to where it meets the ceiling or the end of the route.

    `rows` are the row of the ceiling where the front is, and its last one.
    """
    distance, spent, speed = way
    pieces, s, w = tables.pieces, mover.s_m, mover.v_mps * mover.v_mps
    for q in range(rows[0], rows[1]):
        piece = pieces[q]
        until = min(pieces[q + 1].from_m, s + distance)
        ceiling = piece.w + piece.dw * (until - piece.from_m)
        if w + 2.0 * acceleration * (until - s) > ceiling:
            closing = 2.0 * acceleration - piece.dw
            met = until
            if closing > 0.0:
                met = (piece.w - piece.dw * piece.from_m - w + 2.0 * acceleration * s) / closing
                met = min(max(met, piece.from_m, s), until)
            top = np.sqrt(max(piece.w + piece.dw * (met - piece.from_m), 0.0))
            return met - s, time_of(met - s, mover.v_mps, top), top
        if pieces[q + 1].from_m >= s + distance:
            return distance, spent, speed
    rest = train.route_m - s  # the front leaves the route within the step
    top = np.sqrt(max(w + 2.0 * acceleration * rest, 0.0))
    return rest, time_of(rest, mover.v_mps, top), top


@inlined
def time_of(distance, v, speed):
    """Return the time [s] for a `distance` [m] between two speeds [m/s] at constant acceleration."""
    return 2.0 * distance / (v + speed) if v + speed > 0.0 else 0.0
