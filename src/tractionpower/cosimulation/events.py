"""Events of a run: spells of steps that could not be served or did not converge."""

from __future__ import annotations

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
        self._last: tuple[int, int] | None = None

    def add(self, time_s: NDArray[np.float64], steps: NDArray[np.void]) -> None:
        """Look at steps, records of `tractionpower.kernels.tables.STEP_RESULT`."""
        status = steps["status"]
        bad = np.flatnonzero(status != CONVERGED)
        self.flagged_steps += len(bad)
        if not len(bad) and len(steps):
            self._last = None
        for k in bad:
            key = (int(status[k]), int(steps["port"][k]))
            fresh = self._last != key or bool(k > 0 and status[k - 1] == CONVERGED)
            self._note(float(time_s[k]), steps[k], key, fresh=fresh)
            self._last = key
        if len(steps) and status[-1] == CONVERGED:
            self._last = None

    def _note(self, time_s: float, step: np.void, key: tuple[int, int], *, fresh: bool) -> None:
        value = float(step["factor"] if key[0] == NOT_SERVABLE else step["worst_a"])
        if fresh:
            load = self.load_of_port.get(key[1])
            self.rows.append(
                {
                    "time_s": time_s, "kind": KINDS[key[0]], "subject": load.id if load else "network",
                    "track": load.track if load else "", "position_km": load.km if load else np.nan,
                    "value": value, "limit": 1.0 if key[0] == NOT_SERVABLE else FLAG_A, "end_s": time_s,
                }
            )  # fmt: skip
        row = self.rows[-1]
        row["end_s"] = time_s + self.step_s
        row["value"] = (min if key[0] == NOT_SERVABLE else max)(row["value"], value)

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
    return [known.index(word) for word in words], known
