"""When a train must be where, so that its plan still brings it to its next timed call on time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import POINT
from tractionpower.movement.compile import PlannedCall

Times = NDArray[np.float64]

NEVER_S = 1e12
"""A time that never comes [s]: behind the last timed call no train is late."""

SLOW_MPS = 5.0
"""Below this speed every step is kept [m/s]: there the time is not straight over the distance."""

FAR_M, CHANGE_MPS = 500.0, 1.0
"""Otherwise a step is kept after this way [m] or change of speed [m/s]."""


def dues_of(rows: NDArray[np.void], calls: Sequence[PlannedCall], arrived_s: Times, left_s: Times) -> NDArray[np.void]:
    """Return when the front must be at each place, records of `POINT` by distance.

    With T the time at which the plan alone, simulated, is at a place, and p the planned time of the next timed call c, that is

        due(s) = p(c) - (T(c) - T(s)).

    Parameters
    ----------
    rows
        Steps of the plan alone, records of `TRAIN_ROW`.
    calls
        Calls of the run.
    arrived_s, left_s
        When the plan alone arrives at them and leaves [s].

    Returns
    -------
    No rows if no call has a time.
    """
    timed = [n for n, planned in enumerate(calls) if planned_arrival(planned) is not None and np.isfinite(arrived_s[n])]
    timed = [n for n in timed if calls[n].at_m > 0.0]
    if not timed:
        return np.zeros(0, POINT)
    kept = rows[_kept(rows)]
    moments = [(float(row["s_m"]), float(row["time_s"])) for row in kept]
    moments += [(calls[n].at_m, float(t)) for n in range(len(calls)) for t in (arrived_s[n], left_s[n]) if np.isfinite(t)]
    places = np.array(sorted(moments))
    ends = np.array([arrived_s[n] for n in timed])
    planned = np.array([planned_arrival(calls[n]) for n in timed], float)
    # A moment belongs to the first timed call at which the train arrives at or after it.
    number = np.searchsorted(ends, places[:, 1] - 1e-9, side="left")
    inside = number < len(timed)
    due = np.full(len(places), NEVER_S)
    due[inside] = planned[number[inside]] - (ends[number[inside]] - places[inside, 1])
    points = np.zeros(len(places), POINT)
    points["x"], points["y"] = places[:, 0], due
    last = calls[timed[-1]].at_m
    return np.concatenate((points[inside], np.array([(last, NEVER_S)], POINT)))


def planned_arrival(planned: PlannedCall) -> float | None:
    """Return when a train is to arrive at a call, or pass it [s]; by its departure where no arrival is planned."""
    call = planned.call
    if call.arrival is not None or call.departure is None:
        return call.arrival
    return call.departure - (call.min_dwell_s if call.stops else 0.0)


def _kept(rows: NDArray[np.void]) -> NDArray[np.bool_]:
    """Return which steps are kept: all slow ones, of the others those after which place or speed have changed enough."""
    v, s = rows["v_mps"], rows["s_m"]
    travelled = np.cumsum(np.abs(np.diff(v, prepend=v[:1])) / CHANGE_MPS + np.diff(s, prepend=s[:1]) / FAR_M)
    return (np.diff(np.floor(travelled), prepend=-1.0) > 0.0) | ((v < SLOW_MPS) & (v > 0.0))
