"""Table ``demand``: what supply points take from the feeding grid, in quarters of an hour by the clock."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.scenario import Scenario
from tractionpower.results.words import yes_or_no
from tractionpower.studies.ratings.counted import counted
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import grid_power, sums_of_columns, supply_points

Floats = NDArray[np.float64]

PERIOD_S = 900.0
"""Length of a period of the clock [s]."""

_NEAR = 1e-6
"""Share of a step by which a period may miss its whole length."""


class DemandWatch:
    """Sums up what each supply point takes in each quarter of an hour by the clock.

    Substations of the same supply point are one customer. The power is U I at the busbar and, where it is known, the heat of
    transformers and rectifiers; what is fed back counts against it.

    Parameters
    ----------
    scenario
        What runs.
    supply
        Its supply.

    Attributes
    ----------
    points
        Supply points, sorted.
    contract_kw
        Contracted power of each; NaN without one.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        clock = scenario.clock
        self._from_s, self._step_s = clock.counts_from_s, clock.step_s
        points = supply_points(supply)
        self.points, self._stations = tuple(points), list(points.values())
        given = [[supply.substations[k].contract_power_kw for k in stations] for stations in self._stations]
        self.contract_kw = [next((power for power in powers if power is not None), math.nan) for powers in given]
        self._first = math.floor(self._from_s / PERIOD_S)
        periods = max(0, math.ceil(clock.end / PERIOD_S) - self._first)
        self._energy_j = np.zeros((periods + 1, len(self.points)))  # one more: the last step may reach beyond the clock
        self._covered_s = np.zeros(periods + 1)

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        time_s, rows = counted(self._from_s, time_s, rows)
        watts = sums_of_columns(grid_power(rows, supply), self._stations)
        at = np.floor(time_s / PERIOD_S + _NEAR * self._step_s / PERIOD_S).astype(np.int64)
        here_s = np.minimum((at + 1) * PERIOD_S - time_s, self._step_s)  # of a step over a boundary the part before it
        # The two parts of a step are added before those of the next one, however many come at a time.
        number, seconds = np.stack([at, at + 1], axis=1) - self._first, np.stack([here_s, self._step_s - here_s], axis=1)
        some = seconds > 0.0
        shared = watts[:, np.newaxis, :] * seconds[:, :, np.newaxis]
        np.add.at(self._energy_j, number[some], shared[some])
        np.add.at(self._covered_s, number[some], seconds[some])

    @property
    def power_kw(self) -> Floats:
        """Mean power of each quarter of an hour [kW], shape (quarters, points); NaN where the run does not cover it whole."""
        whole = self._covered_s > PERIOD_S - 2.0 * _NEAR * self._step_s
        return np.where(whole, self._energy_j.T / np.where(whole, self._covered_s, 1.0) / 1000.0, np.nan).T

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the rows of table ``demand``: supply points by quarters of an hour that the run covers as a whole."""
        known = self.power_kw
        whole = np.flatnonzero(np.isfinite(known).all(axis=1))
        for k, (point, contract_kw) in enumerate(zip(self.points, self.contract_kw, strict=True)):
            for number in whole.tolist():
                power_kw = float(known[number, k])
                met = yes_or_no(None if math.isnan(contract_kw) else power_kw <= contract_kw)
                yield {
                    "supply_point": point, "from_s": (self._first + number) * PERIOD_S, "power_kw": power_kw,
                    "contract_power_kw": contract_kw, "met": met,
                }  # fmt: skip
