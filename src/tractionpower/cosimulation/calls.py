"""Calls of trains as rows of a table: planned (RJ) beside computed times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tractionpower.movement.journey import JourneyCall
from tractionpower.results.trains import CallRow

AT_END_M = 0.1
"""A call this near to the start or the end of a run is its first or its last one [m]."""


def call_rows(train: str, calls: Sequence[JourneyCall], end_m: float) -> list[CallRow]:
    """Return the calls of a train as rows: one for each arrival, departure or passing that is planned or takes place.

    Where the run begins there is no arrival, and where it ends, at `end_m` [m], no departure, unless the timetable has one.
    """
    return [row for call in calls for row in _rows_of(train, call, end_m)]


def _rows_of(train: str, call: JourneyCall, end_m: float) -> Iterator[CallRow]:
    planned = {"arrival": _given(call.planned_arrival_s), "departure": _given(call.planned_departure_s)}
    actual = {"arrival": float(call.arrival_s), "departure": float(call.departure_s)}
    if call.kind == "pass":
        times = [_first(planned["arrival"], planned["departure"]), _first(actual["arrival"], actual["departure"])]
        yield CallRow(train, call.station, "pass", *times)
        return
    for kind, is_told in (("arrival", _arrives(call)), ("departure", departs(call, end_m))):
        if is_told:
            dwell = actual["departure"] - actual["arrival"] if kind == "departure" else np.nan
            yield CallRow(train, call.station, kind, planned[kind], actual[kind], dwell)


def departs(call: JourneyCall, end_m: float) -> bool:
    """Tell whether a train departs from a call: not where its run ends, at `end_m` [m], unless the timetable says so."""
    return call.planned_departure_s is not None or not call.at_m > end_m - AT_END_M


def _arrives(call: JourneyCall) -> bool:
    return call.planned_arrival_s is not None or call.at_m >= AT_END_M


def time_at_stops(calls: Sequence[JourneyCall], start_s: float, finished_s: float) -> float:
    """Return how long a train that was on the line from `start_s` to `finished_s` stood at its calls [s]."""
    return sum(_stood(call, start_s, finished_s) for call in calls if call.kind == "stop")


def _stood(call: JourneyCall, start_s: float, finished_s: float) -> float:
    """Return how long a train stood at a call [s]; at the start of its run since it is on the line."""
    if not np.isfinite(call.departure_s):
        return max(0.0, finished_s - max(call.arrival_s, start_s)) if np.isfinite(call.arrival_s) else 0.0
    arrived = call.arrival_s if np.isfinite(call.arrival_s) else start_s if call.at_m < AT_END_M else call.departure_s
    return max(0.0, float(call.departure_s - max(arrived, start_s)))


def late_at_end(rows: Sequence[CallRow], end_s: float) -> float:
    """Return how late a train is at the end `end_s` [s] of a run; NaN without a call that the timetable has a time for [s].

    That is its delay at the last timed call that it came to, or, if it should have come to another one by then, at least
    the time since.
    """
    overdue = overdue_by(rows, end_s)
    if overdue > 0.0:
        return overdue
    return next((row.late_s for row in reversed(rows) if np.isfinite(row.late_s)), float("nan"))


def overdue_by(rows: Sequence[CallRow], end_s: float) -> float:
    """Return for how long a train has been missing at a call that it has not reached at `end_s` [s]; 0 if at none."""
    missing = [end_s - row.planned_s for row in rows if np.isfinite(row.planned_s) and not np.isfinite(row.actual_s)]
    return max([0.0, *missing])


def _given(seconds: float | None) -> float:
    return float("nan") if seconds is None else float(seconds)


def _first(*seconds: float) -> float:
    return next((value for value in seconds if np.isfinite(value)), float("nan"))
