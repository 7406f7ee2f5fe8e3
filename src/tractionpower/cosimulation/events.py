"""Events of a run: spells of steps that could not be served or did not converge."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.kernels.network import CONVERGED, FLAG_A, NOT_CONVERGED, NOT_SERVABLE
from tractionpower.model.base import format_time
from tractionpower.results.tables import make_table
from tractionpower.supply.compile import SupplyTables

KINDS = {NOT_SERVABLE: "not_servable", NOT_CONVERGED: "not_converged"}


class EventLog:
    """Turns the status of the steps into events, one for each unbroken spell of the same kind and place."""

    def __init__(self, supply: SupplyTables, step_s: float) -> None:
        self.step_s, self.supply = step_s, supply
        self.load_of_port = {int(port): load for port, load in zip(supply.load_port, supply.loads, strict=True)}
        self.rows: list[dict[str, Any]] = []
        self.flagged_steps = 0
        self._last = (CONVERGED, -1)

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
            self.rows.append(
                {
                    "time_s": float(time_s[0]), "kind": KINDS[kind[0]], "subject": load.id if load else "network",
                    "track": load.track if load else "", "position_km": load.km if load else np.nan,
                    "value": value, "limit": 1.0 if unserved else FLAG_A,
                }
            )  # fmt: skip
        row = self.rows[-1]
        row["end_s"] = float(time_s[-1]) + self.step_s
        row["value"] = (min if unserved else max)(row["value"], value)

    def messages(self) -> list[str]:
        """Return all events in words."""
        return [message(row) for row in self.rows]

    def table(self) -> pa.Table:
        """Return the rows of table ``events``."""
        columns: dict[str, Any] = {name: [row[name] for row in self.rows] for name in ("time_s", "position_km", "value", "limit")}
        columns["message"] = _coded(self.messages())
        for name in ("kind", "subject", "track"):
            columns[name] = _coded([row[name] for row in self.rows])
        return make_table("events", columns)


def message(row: dict[str, Any]) -> str:
    """Return an event in words."""
    when = f"{format_time(row['time_s'])} to {format_time(row['end_s'])}"
    if row["kind"] == "not_servable":
        return (
            f"{when}: the demand cannot be served, first at {row['subject']} (track {row['track']},"
            f" km {row['position_km']:g}); {100.0 * row['value']:.4f} % of all demand can be, and is computed"
        )
    return f"{when}: a node balances within {row['value']:.3g} A only; the best solution found is given"


def _coded(words: list[str]) -> tuple[list[int], list[str]]:
    known = sorted(set(words))
    code = {word: number for number, word in enumerate(known)}
    return [code[word] for word in words], known
