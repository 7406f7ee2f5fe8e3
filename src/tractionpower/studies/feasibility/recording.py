"""What the run with the network tells of each train: its way, speed and voltage over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.kernels.train_tables import POINT
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]

LEAST_S = 1e-6
"""Shorter than this nothing is held: times are rounded [s]."""

TRACE = np.dtype(
    [
        ("train", "i4"), ("time_s", "f8"), ("s_m", "f8"), ("voltage_v", "f8"), ("on_line_s", "f8"), ("still", "?"),
    ]
)  # fmt: skip
"""A step of a train: what of `TRAIN_ROW` is kept; still: it does not move in it."""


@dataclass(frozen=True, eq=False)
class Trace:
    """The steps of one train, by time.

    Attributes
    ----------
    rows
        Records of `TRACE`.
    step_s
        Length of a step [s].
    """

    rows: NDArray[np.void]
    step_s: float

    @property
    def begins_s(self) -> Floats:
        """When each step begins for it [s]: that in which it enters when it does."""
        return np.asarray(self.rows["time_s"] + self.step_s - np.minimum(self.rows["on_line_s"], self.step_s))

    def voltages(self, before_v: float) -> NDArray[np.void]:
        """Return the voltage over the distance of the front, records of `POINT`; `before_v` [V] where it ran before the clock.

        Of a place where it stood the last step counts, in which it left.
        """
        rows = self.rows
        if not len(rows):
            return np.array([(0.0, before_v)], POINT)
        last = np.diff(rows["s_m"], append=np.inf) > 0.0
        at, volts = rows["s_m"][last], rows["voltage_v"][last]
        points = np.zeros(len(at), POINT)
        points["x"], points["y"] = at, volts
        if at[0] <= 0.0:
            return points
        first = np.array([(0.0, before_v), (np.nextafter(at[0], 0.0), before_v)], POINT)
        return np.concatenate((first, points))

    def held(self, stops: Sequence[tuple[float, float]]) -> Floats:
        """Return for how long it stands on its way in each step since effort or voltage lack [s].

        Parameters
        ----------
        stops
            From when to when it stood at its stops, and from when on it stays at its end [s].
        """
        rows = self.rows
        begin, end = self.begins_s, rows["time_s"] + self.step_s
        held = np.where(rows["still"], end - begin, 0.0)
        for arrived, left in stops:
            held -= np.where(rows["still"], np.maximum(np.minimum(end, left) - np.maximum(begin, arrived), 0.0), 0.0)
        return np.asarray(np.where(held > LEAST_S, held, 0.0))

    def lowest_v(self, from_s: float, until_s: float) -> float:
        """Return the lowest voltage of the steps between two times [s]; NaN without one [V]."""
        time_s = self.rows["time_s"]
        first, end = np.searchsorted(time_s, from_s - self.step_s, side="right"), np.searchsorted(time_s, until_s)
        volts = self.rows["voltage_v"][first:end]
        return float(volts.min()) if len(volts) else np.nan


class Recording:
    """Keeps what is needed of the rows of trains as they come; a `Watch` of the run."""

    def __init__(self) -> None:
        self._parts: list[NDArray[np.void]] = []

    def __call__(self, time_s: Floats, steps: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        rows = steps.trains
        kept = np.empty(len(rows), TRACE)
        for name in ("train", "time_s", "s_m", "voltage_v", "on_line_s"):
            kept[name] = rows[name]
        kept["still"] = (rows["moved_m"] == 0.0) & (rows["v_mps"] == 0.0)
        self._parts.append(kept)

    def traces(self, trains: int, step_s: float) -> list[Trace]:
        """Return the traces of all trains, by their number."""
        rows = np.concatenate([np.zeros(0, TRACE), *self._parts])
        rows = rows[np.argsort(rows["train"], kind="stable")]
        ends = np.searchsorted(rows["train"], np.arange(trains + 1))
        return [Trace(rows[a:b], step_s) for a, b in pairwise(ends.tolist())]
