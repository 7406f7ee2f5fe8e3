"""Events of trains: entered and left, stops and departures, voltage lost, back, stands without it, spells beyond limits."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Places
from tractionpower.kernels.train_tables import (
    BY_LINE_CURRENT,
    BY_STANDSTILL_CURRENT,
    BY_TRAIN_CURRENT,
    BY_VOLTAGE,
    LIMITED_BY,
)
from tractionpower.model.limits import SystemVoltages
from tractionpower.results.spells import TOLERANCE_V

Row = dict[str, Any]
Rows = NDArray[np.void]
Columns = dict[str, NDArray[Any]]

LIMITS = (BY_LINE_CURRENT, BY_TRAIN_CURRENT, BY_VOLTAGE)


class TrainEvents:
    """Finds what begins and ends in the rows of trains as they come.

    Parameters
    ----------
    names
        Identifiers of the runs.
    places
        Where they are.
    voltages
        Voltage limits of the system.
    step_s
        Step of the clock [s].
    """

    def __init__(self, names: tuple[str, ...], places: Places, voltages: SystemVoltages, step_s: float) -> None:
        self._names, self._places, self._voltages, self._step_s = names, places, voltages, step_s
        self.rows: list[Row] = []
        self._open: defaultdict[str, dict[int, Row]] = defaultdict(dict)
        self._grouping: dict[int, int] = {}
        self._lost_s: dict[int, float] = {}
        self._moves: set[int] = set()

    def add(self, rows: Rows) -> None:
        """Look at rows of trains, ordered by time."""
        order = np.argsort(rows["train"], kind="stable")
        names = ("train", "time_s", "s_m", "voltage_v", "limited_by", "traction_n", "wished_n", "grouping", "v_mps")
        columns = {name: rows[name][order] for name in names}
        volts, low, high = columns["voltage_v"], self._voltages.u_min2, self._voltages.u_max2
        limited = np.isin(columns["limited_by"], LIMITS) & (columns["traction_n"] < columns["wished_n"]) & (volts != 0.0)
        limited |= columns["limited_by"] == BY_STANDSTILL_CURRENT
        self._spells("low_voltage", columns, (volts < low - TOLERANCE_V) & (volts != 0.0), low)
        self._spells("high_voltage", columns, volts > high + TOLERANCE_V, high)
        self._spells("current_limited", columns, limited, np.nan)
        self._regroup(columns)
        self._lose(columns)

    def _spells(self, kind: str, columns: Columns, inside: NDArray[np.bool_], limit: float) -> None:
        """Note spells; one that is open at the end of the rows of a train goes on with its next ones."""
        train, time_s = columns["train"], columns["time_s"]
        first_of_train = np.diff(train, prepend=-1) != 0
        last_of_train = np.diff(train, append=-1) != 0
        starts = np.flatnonzero(inside & (first_of_train | ~np.roll(inside, 1)))
        ends = np.flatnonzero(inside & (last_of_train | ~np.roll(inside, -1))) + 1
        open_before, self._open[kind] = self._open[kind], {}
        pick = max if kind == "high_voltage" else min
        for first, end in zip(starts.tolist(), ends.tolist(), strict=True):
            k = int(train[first])
            value = float(pick(columns["voltage_v"][first:end]))
            event = open_before.get(k) if first_of_train[first] else None
            if event is None:
                event = self._note(kind, k, float(time_s[first]), float(columns["s_m"][first]), value, limit)
                event["reasons"] = []
            found = [LIMITED_BY[code] for code in np.unique(columns["limited_by"][first:end])]
            event["reasons"] += [reason for reason in found if reason not in event["reasons"]]
            event["value"], event["end_s"] = pick(event["value"], value), float(time_s[end - 1]) + self._step_s
            if last_of_train[end - 1]:
                self._open[kind][k] = event

    def _regroup(self, columns: Columns) -> None:
        """Note where series motors go from one grouping to another; off in between is no change."""
        on = np.flatnonzero(columns["grouping"])
        train, grouping = columns["train"][on], columns["grouping"][on]
        starts = np.diff(train, prepend=-1) != 0
        before = np.roll(grouping, 1)
        before[starts] = [self._grouping.get(k, first) for k, first in zip(train[starts], grouping[starts], strict=True)]
        for n in np.flatnonzero(grouping != before).tolist():
            time_s, at_m = float(columns["time_s"][on[n]]), float(columns["s_m"][on[n]])
            event = self._note("regrouped", int(train[n]), time_s, at_m, float(grouping[n]), float(before[n]))
            event["end_s"] = time_s
        ends = np.diff(train, append=-1) != 0
        self._grouping.update(zip(train[ends].tolist(), grouping[ends].tolist(), strict=True))

    def _lose(self, columns: Columns) -> None:
        """Note where trains lose their voltage, come to a stand without one, get it back; on a dead line it is 0 exactly."""
        train, dead, moves = columns["train"], columns["voltage_v"] == 0.0, columns["v_mps"] > 0.0
        starts = np.flatnonzero(np.diff(train, prepend=-1) != 0)
        before, moved = np.roll(dead, 1), np.roll(moves, 1)
        before[starts] = [k in self._lost_s for k in train[starts].tolist()]
        moved[starts] = [k in self._moves for k in train[starts].tolist()]
        stopped = dead & moved & ~moves
        for n in np.flatnonzero((dead != before) | stopped).tolist():
            k, time_s, at_m = int(train[n]), float(columns["time_s"][n]), float(columns["s_m"][n])
            if dead[n] and not before[n]:
                self._lost_s[k] = time_s
                self._note("voltage_lost", k, time_s, at_m, np.nan, np.nan)["end_s"] = time_s
            if stopped[n]:
                self._note("stopped_without_voltage", k, time_s, at_m, time_s - self._lost_s[k], np.nan)["end_s"] = time_s
            if before[n] and not dead[n]:
                self._note("voltage_back", k, time_s, at_m, time_s - self._lost_s.pop(k), np.nan)["end_s"] = time_s
        for n in np.flatnonzero(np.diff(train, append=-1) != 0).tolist():
            (self._moves.add if moves[n] else self._moves.discard)(int(train[n]))

    def note(self, kind: str, k: int, time_s: float, s_m: float, subject: str = "") -> None:
        """Note an event of train `k` at a time [s] and place [m]; `subject` is the station of a call."""
        event = self._note(kind, k, time_s, s_m, np.nan, np.nan)
        event["end_s"], event["station"] = time_s, subject

    def _note(self, kind: str, k: int, time_s: float, s_m: float, value: float, limit: float) -> Row:
        track, km = self._places.name(k, s_m)
        row: Row = {
            "time_s": time_s, "kind": kind, "subject": self._names[k], "track": track, "position_km": km,
            "value": value, "limit": limit,
        }  # fmt: skip
        self.rows.append(row)
        return row
