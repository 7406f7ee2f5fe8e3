"""Events of a run: spells of steps that could not be served or did not converge, blocked substations, violated limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.kernels.network import CONVERGED, FLAG_A, NOT_CONVERGED, NOT_SERVABLE
from tractionpower.model.base import format_time, parse_time
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.tables import make_table
from tractionpower.supply.compile import SupplyTables

_ORDER = {"tripped": 0, "switched": 0, "vld_closed": 0, "train_entered": 0, "departure": 2, "train_left": 3}
"""Kinds of events that come before or after others of the same time."""

KINDS = {NOT_SERVABLE: "not_servable", NOT_CONVERGED: "not_converged"}


class EventLog:
    """Turns the status of the steps into events, one for each unbroken spell of the same kind and place."""

    def __init__(self, supply: SupplyTables, step_s: float, start_s: float) -> None:
        self.step_s, self.supply, self.start_s = step_s, supply, start_s
        self.load_of_port = {int(port): load for port, load in zip(supply.load_port, supply.loads, strict=True)}
        self.rows: list[dict[str, Any]] = []
        self.flagged_steps = 0
        self._last = (CONVERGED, -1)
        self._last_row: dict[str, Any] = {}
        self._blocked: dict[int, dict[str, Any]] = {}

    def add(self, time_s: NDArray[np.float64], steps: NDArray[np.void]) -> None:
        """Look at steps, records of `tractionpower.kernels.tables.STEP_RESULT`."""
        status, port = steps["status"], steps["port"]
        self.flagged_steps += int(np.count_nonzero(status != CONVERGED))
        changes = np.flatnonzero((status[1:] != status[:-1]) | (port[1:] != port[:-1])) + 1
        bounds = [0, *changes.tolist(), len(steps)]
        for first, end in pairwise(bounds):
            if first == end:  # no steps at all
                continue
            kind = (int(status[first]), int(port[first]))
            if kind[0] != CONVERGED:
                self._note(kind, time_s[first:end], steps[first:end])
            self._last = kind

    def _note(self, kind: tuple[int, int], time_s: NDArray[np.float64], spell: NDArray[np.void]) -> None:
        unserved = kind[0] == NOT_SERVABLE
        value = float(spell["factor"].min() if unserved else spell["worst_a"].max())
        if kind != self._last:
            load = self.load_of_port.get(kind[1])
            self._last_row = {
                "time_s": float(time_s[0]), "kind": KINDS[kind[0]], "subject": load.id if load else "network",
                "track": load.track if load else "", "position_km": load.km if load else np.nan,
                "value": value, "limit": 1.0 if unserved else FLAG_A,
            }  # fmt: skip
            self.rows.append(self._last_row)
        row = self._last_row
        row["end_s"] = float(time_s[-1]) + self.step_s
        row["value"] = (min if unserved else max)(row["value"], value)

    def add_blocked(self, time_s: NDArray[np.float64], busbar_v: NDArray[np.float64], no_load_v: NDArray[np.float64]) -> None:
        """Look at busbar voltages and no-load voltages [V]: what lies above lets no rectifier feed."""
        with np.errstate(invalid="ignore"):
            blocked = busbar_v > no_load_v + TOLERANCE_V
        for k in range(blocked.shape[1]):
            edges = np.flatnonzero(np.diff(blocked[:, k].astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
            before = self._blocked.pop(k, None)
            for first, end in edges.tolist():
                highest, until = float(busbar_v[first:end, k].max()), float(time_s[end - 1]) + self.step_s
                row = before if first == 0 and before is not None else None
                if row is None:
                    substation = self.supply.substations[k]
                    row = {
                        "time_s": float(time_s[first]), "kind": "substation_blocked", "subject": substation.id, "track": "",
                        "position_km": substation.km, "value": highest, "limit": float(no_load_v[k]),
                    }  # fmt: skip
                    self.rows.append(row)
                row["value"], row["end_s"] = max(row["value"], highest), until
                if end == len(blocked):
                    self._blocked[k] = row

    def add_rows(self, rows: Sequence[dict[str, Any]]) -> None:
        """Add events that others have found."""
        self.rows += rows

    def add_violations(self, verdicts: Sequence[dict[str, Any]]) -> None:
        """Add an event for each verdict that is not met, at the time of the worst value."""
        for verdict in verdicts:
            if not verdict["met"]:
                time_s = parse_time(verdict["time"]) if verdict["time"] else self.start_s
                self.rows.append(
                    {
                        "time_s": time_s, "end_s": time_s, "kind": "limit_violated", "subject": verdict["name"], "track": "",
                        "position_km": np.nan, "value": verdict["value"], "limit": verdict["limit_value"],
                        "place": verdict["place"], "unit": verdict["unit"], "limit_name": verdict["limit"],
                        "voltage_v": verdict.get("voltage_v"),
                    }
                )  # fmt: skip

    def messages(self) -> list[str]:
        """Return in words which steps could not be served or did not converge."""
        return [message(row) for row in self.rows if row["kind"] in KINDS.values()]

    def table(self) -> pa.Table:
        """Return the rows of table ``events``, by time; what a train does at the same time in the order that it does it."""
        rows = sorted(self.rows, key=lambda row: (row["time_s"], _ORDER.get(row["kind"], 1), row["kind"], row["subject"]))
        columns: dict[str, Any] = {name: [row[name] for row in rows] for name in ("time_s", "position_km", "value", "limit")}
        columns["message"] = _coded([message(row) for row in rows])
        for name in ("kind", "subject", "track"):
            columns[name] = _coded([row[name] for row in rows])
        return make_table("events", columns)


def message(row: dict[str, Any]) -> str:
    """Return an event in words."""
    return _TOLD[row["kind"]](row)


def _spell(row: dict[str, Any]) -> str:
    return f"{format_time(row['time_s'])} to {format_time(row['end_s'])}"


def _not_servable(row: dict[str, Any]) -> str:
    return (
        f"{_spell(row)}: the demand cannot be served, first at {row['subject']} (track {row['track']},"
        f" km {row['position_km']:g}); {100.0 * row['value']:.4f} % of all demand can be, and is computed"
    )


def _limit_violated(row: dict[str, Any]) -> str:
    at = f" at {row['place']}" if row["place"] else ""
    found = f"{row['subject']}: {row['value']:z.1f} {row['unit']}{at}"
    if row["voltage_v"] is not None:  # a spell above a touch voltage
        return f"{found}, may last {row['limit']:g} s ({row['limit_name']}: {row['voltage_v']:g} V)"
    return f"{found}, {row['limit_name']} is {row['limit']:g} {row['unit']}"


def _switched(row: dict[str, Any]) -> str:
    name, value = row["change"]
    if name == "units_in_service":
        return f"{value} rectifier units in service from now on"
    if row["cause"] == "no_return":
        return "feeds nothing: none of its return feeders is closed"
    by = {"order": "", "reclosure": ", by itself after a trip", "reopening": ", by itself"}[row["cause"]]
    return f"{str(value).replace('_', ' ')}{by}"


def _tripped(row: dict[str, Any]) -> str:
    told = f"trips at {abs(row['value']):.0f} A, above {row['limit']:g} A"
    if row["again_s"] is None:
        return f"{told}; stays open"
    if not row["number"]:
        return f"{told}; stays open, since it has closed by itself as often as it may"
    return f"{told}; closes by itself after {row['again_s']:g} s (number {row['number']})"


def _what_is_cut(reasons: Sequence[str]) -> str:
    return "auxiliaries" if set(reasons) == {"standstill_current"} else "tractive effort"


_TOLD: dict[str, Callable[[dict[str, Any]], str]] = {
    "not_servable": _not_servable,
    "not_converged": lambda row: (
        f"{_spell(row)}: a node balances within {row['value']:.3g} A only; the best solution found is given"
    ),
    "substation_blocked": lambda row: (
        f"{_spell(row)}: rectifiers block, the busbar is at up to {row['value']:z.1f} V, above {row['limit']:g} V without load"
    ),
    "low_voltage": lambda row: f"{_spell(row)}: down to {row['value']:z.1f} V, below {row['limit']:g} V",
    "high_voltage": lambda row: f"{_spell(row)}: up to {row['value']:z.1f} V, above {row['limit']:g} V",
    "current_limited": lambda row: (
        f"{_spell(row)}: {_what_is_cut(row['reasons'])} limited by {' and '.join(sorted(row['reasons'])).replace('_', ' ')},"
        f" down to {row['value']:z.1f} V"
    ),
    "voltage_lost": lambda row: "the contact line is dead: neither traction nor auxiliaries",
    "stopped_without_voltage": lambda row: (
        f"comes to a stand on track {row['track']}, km {row['position_km']:.2f}: the contact line is dead,"
        f" {row['value']:g} s after the voltage was lost"
    ),
    "voltage_back": lambda row: f"the contact line has voltage again, after {row['value']:g} s",
    "regrouped": lambda row: f"{row['limit']:g} motors in series become {row['value']:g}",
    "train_entered": lambda row: "comes onto the line",
    "train_left": lambda row: "leaves the line",
    "stop": lambda row: f"stops at {row['station']}",
    "departure": lambda row: f"departs from {row['station']}",
    "limit_violated": _limit_violated,
    "switched": _switched,
    "tripped": _tripped,
    "vld_closed": lambda row: f"closes: the rail potential is {row['value']:z.1f} V, above {row['limit']:g} V",
    "line_dead": lambda row: f"nothing feeds the contact line from km {row['position_km']:g} to km {row['to_km']:g}",
    "line_live": lambda row: (
        f"the contact line is fed again from km {row['position_km']:g} to km {row['to_km']:g}, after {row['value']:g} s"
    ),
}

KINDS_TOLD = tuple(_TOLD)
"""All kinds of events."""


def _coded(words: list[str]) -> tuple[list[int], list[str]]:
    known = sorted(set(words))
    code = {word: number for number, word in enumerate(known)}
    return [code[word] for word in words], known
