"""Events of trains: entered and left, stops and departures, spells of low voltage and limited current, groupings."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Places
from tractionpower.kernels.train_tables import BY_LINE_CURRENT, BY_TRAIN_CURRENT, BY_VOLTAGE, LIMITED_BY
from tractionpower.model.limits import SystemVoltages
from tractionpower.results.spells import TOLERANCE_V

Row = dict[str, Any]
Rows = NDArray[np.void]

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
        self._open: dict[tuple[str, int], Row] = {}
        self._grouping: dict[int, int] = {}

    def add(self, rows: Rows) -> None:
        """Look at rows of trains, ordered by time."""
        order = np.argsort(rows["train"], kind="stable")
        for mine in np.split(order, np.flatnonzero(np.diff(rows["train"][order])) + 1):
            if len(mine):
                self._look_at(int(rows["train"][mine[0]]), rows[mine])

    def _look_at(self, k: int, rows: Rows) -> None:
        u_low = self._voltages.u_min2
        low = rows["voltage_v"] < u_low - TOLERANCE_V
        self._spell("low_voltage", k, rows, low, "voltage_v", u_low)
        self._spell(
            "high_voltage", k, rows, rows["voltage_v"] > self._voltages.u_max2 + TOLERANCE_V, "voltage_v", self._voltages.u_max2
        )
        limited = np.isin(rows["limited_by"], LIMITS) & (rows["traction_n"] < rows["wished_n"])
        self._spell("current_limited", k, rows, limited, "voltage_v", np.nan)
        self._regroup(k, rows)

    def _spell(self, kind: str, k: int, rows: Rows, inside: NDArray[np.bool_], field: str, limit: float) -> None:
        """Note spells; one that is open at the end of the rows goes on with the next ones."""
        before = self._open.pop((kind, k), None)
        pick = max if kind == "high_voltage" else min
        edges = np.flatnonzero(np.diff(inside.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
        for first, end in edges.tolist():
            value = float(pick(rows[field][first:end]))
            event = before if first == 0 and before is not None else None
            if event is None:
                event = self._note(kind, k, float(rows["time_s"][first]), float(rows["s_m"][first]), value, limit)
                event["reason"] = LIMITED_BY[rows["limited_by"][first]]
            event["value"], event["end_s"] = pick(event["value"], value), float(rows["time_s"][end - 1]) + self._step_s
            if end == len(rows):
                self._open[kind, k] = event

    def _regroup(self, k: int, rows: Rows) -> None:
        """Note where series motors go from one grouping to another; off in between is no change."""
        on = rows["grouping"] > 0
        if not on.any():
            return
        groupings = rows["grouping"][on]
        before = np.concatenate(([self._grouping.get(k, groupings[0])], groupings[:-1]))
        for n in np.flatnonzero(groupings != before).tolist():
            row = rows[on][n]
            event = self._note("regrouped", k, float(row["time_s"]), float(row["s_m"]), float(groupings[n]), float(before[n]))
            event["end_s"] = event["time_s"]
        self._grouping[k] = int(groupings[-1])

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
