"""The driver: follows the plan of the train while it is on time, drives flat out while it is late."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.effort import look_up
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.wayside import HERE_M

NO_CEILING = 1e-10
"""Share by which a square of a speed may pass a ceiling by rounding."""

CRAWL_MPS = 1.0
"""Below this speed a driver does not coast on, so that no train comes to a stand on its way [m/s]."""


@njit
def judge_time(tables, train, mover, now):
    """Note whether a train is late at the time `now` [s]: it is from `late_s` behind its plan on until it has caught up."""
    due, _ = look_up(tables.points, train.first_due, train.dues, mover.s_m)
    if mover.late:
        mover.late = now > due
    else:
        mover.late = now > due + train.late_s


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
    room : float
        How far that holds [m].
    p, last : int
        Row of the ceiling that is kept, and its last row: that of the plan, or that of the train where it is faster than the
        plan; then it coasts.
    """
    p, last = _piece_at(tables, train.first_plan, train.plans, mover.s_m)
    piece = tables.pieces[p]
    ceiling = piece.w + piece.dw * (mover.s_m - piece.from_m)
    if mover.v_mps * mover.v_mps > ceiling + NO_CEILING * (1.0 + ceiling):
        p, last = _piece_at(tables, train.first_piece, train.pieces, mover.s_m)
        return 0.0, np.inf, p, last
    if mover.v_mps < CRAWL_MPS:
        return 1.0, np.inf, p, last
    points, low, end = tables.points, train.first_cap, train.first_cap + train.caps
    high = end
    while high - low > 1:
        middle = (low + high) // 2
        if points[middle].x <= mover.s_m + HERE_M:
            low = middle
        else:
            high = middle
    return points[low].y, points[high].x - mover.s_m if high < end else np.inf, p, last


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
