"""Trains alone on a voltage that is given along their way, leaving stops when it is said: running times by place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.train_tables import GONE, STAYING, TrainTables, new_train_state
from tractionpower.movement.blocks_of_rows import blocks_of_rows
from tractionpower.movement.compile import Movement

Floats = NDArray[np.float64]

_SAME_M = 1e-6


@dataclass(frozen=True, eq=False)
class RunningTimes:
    """Running times of one run from its start, stops taken off.

    Attributes
    ----------
    at_calls_s
        Until it arrives at each call, or passes it [s]; NaN where it does not get there.
    at_m, time_s, speed_mps
        Places in rising order [m], running time until there [s] and speed [m/s], at the starts of steps, stops and the end.
    """

    at_calls_s: Floats
    at_m: Floats
    time_s: Floats
    speed_mps: Floats

    def until(self, places_m: Floats) -> Floats:
        """Return the running time until places on the way [s]; NaN behind the last one that it reached.

        Between two known places the acceleration is taken as constant.
        """
        if len(self.at_m) < 2:
            return np.where(places_m <= _SAME_M, 0.0, np.nan)
        k = np.clip(np.searchsorted(self.at_m, places_m, side="right") - 1, 0, len(self.at_m) - 2)
        from_m, length = self.at_m[k], self.at_m[k + 1] - self.at_m[k]
        way = np.clip(places_m - from_m, 0.0, length)
        v, after = self.speed_mps[k], self.speed_mps[k + 1]
        here = np.sqrt(np.maximum(v**2 + (after**2 - v**2) * way / length, 0.0))
        stands = v + after <= 0.0  # from one stop to the next within a step
        share = np.where(stands, way / length, (v + after) * way / np.maximum((v + here) * length, 1e-12))
        time_s = self.time_s[k] + np.minimum(share, 1.0) * (self.time_s[k + 1] - self.time_s[k])
        return np.asarray(np.where(places_m <= self.at_m[-1] + _SAME_M, time_s, np.nan))


def leave_at(movement: Movement, entered_s: Floats, left_s: Floats) -> TrainTables:
    """Return tables of trains that enter and leave their calls at given times [s], or as soon as they can where it is NaN.

    Parameters
    ----------
    movement
        The trains.
    entered_s
        When each enters; shape (trains,).
    left_s
        When each leaves its calls, by row of `stops`.
    """
    trains, stops = movement.tables.trains.copy(), movement.tables.stops.copy()
    trains["start_s"] = entered_s
    stops["departure_s"] = np.where(np.isfinite(left_s), left_s, -np.inf)
    stops["dwell_s"] = 0.0
    return movement.tables._replace(trains=trains, stops=stops)


def run_alone(tables: TrainTables, k: int, clock: tuple[float, float], voltage: NDArray[np.void]) -> RunningTimes:
    """Run train `k` alone and return its running times.

    Parameters
    ----------
    tables
        The trains, by `leave_at`.
    k
        Number of the train.
    clock
        Start of a step, at which the train has not entered yet [s], and length of the steps [s].
    voltage
        Voltage [V] over the distance of the front [m], records of `POINT`.
    """
    train = tables.trains[k]
    own = slice(int(train["first_stop"]), int(train["first_stop"] + train["stops"]))
    state = new_train_state(tables._replace(trains=tables.trains[k : k + 1], stops=tables.stops))
    alone = tables._replace(trains=tables.trains[k : k + 1])
    parts, start = [], clock[0]
    for rows, _, start in blocks_of_rows(run_journey, (alone, state, 0), clock, voltage):  # noqa: B007 - its last value
        parts.append(np.stack([rows[name] for name in ("time_s", "s_m", "v_mps")]))
    mover = state.movers[0]
    is_done = mover["status"] in (STAYING, GONE)
    last = (float(mover["finished_s"]) if is_done else start, float(mover["s_m"]), float(mover["v_mps"]))
    steps = np.concatenate([*parts, np.array(last)[:, None]], axis=1)
    stops = tables.stops[own]
    return _running_times(float(train["start_s"]), stops, (state.arrived_s[own], state.left_s[own]), steps)


def running_at_calls(start_s: float, stops: NDArray[np.bool_], arrived_s: Floats, left_s: Floats) -> Floats:
    """Return the running time from the start until each call [s], stops taken off; NaN where the train has not come.

    Parameters
    ----------
    start_s
        When the run began [s].
    stops
        Whether the train stops at each call; shape (calls,).
    arrived_s, left_s
        When it came and left [s]; NaN: it did not.
    """
    stood = np.where(stops, left_s - arrived_s, 0.0)
    return np.asarray(arrived_s - start_s - np.concatenate(([0.0], np.cumsum(stood)[:-1])) if len(stops) else np.zeros(0))


def _running_times(start_s: float, stops: NDArray[np.void], called: tuple[Floats, Floats], rows: Floats) -> RunningTimes:
    """Return running times from rows of time [s], place [m] and speed [m/s] at the starts of steps and at the end."""
    arrived, left = called
    at_calls = running_at_calls(start_s, stops["stops"], arrived, left)
    halts = stops["stops"] & np.isfinite(arrived)
    come, gone = arrived[halts], np.where(np.isfinite(left[halts]), left[halts], np.inf)
    time_s, at_m, speed = rows
    n = np.searchsorted(come, time_s, side="right")  # halts that it has come to
    stood = np.concatenate(([0.0], np.cumsum(np.where(np.isfinite(gone), gone - come, 0.0))))
    under_way = (time_s >= start_s) & ((n == 0) | (time_s >= np.concatenate(([-np.inf], gone))[n]))
    time_s = np.concatenate((time_s[under_way] - start_s - stood[n[under_way]], at_calls[halts], [0.0]))
    at_m = np.concatenate((at_m[under_way], stops["at_m"][halts], [0.0]))
    speed = np.concatenate((speed[under_way], np.zeros(halts.sum()), [rows[2][0]]))
    order = np.lexsort((time_s, at_m))
    at_m, time_s, speed = at_m[order], time_s[order], speed[order]
    rises = np.diff(at_m, prepend=-np.inf) > _SAME_M
    return RunningTimes(at_calls, at_m[rises], time_s[rises], speed[rises])
