"""What a run takes from the feeding grid: energies, and the demand of supply points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.results.extremes import add_up
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.results.windows import ClockDemand
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import grid_power, sums_of_columns, supply_points

Floats = NDArray[np.float64]


class EnergyWatch:
    """Sums up the powers of substations.

    Parameters
    ----------
    supply
        What runs.
    step_s
        Length of a step [s].

    Attributes
    ----------
    ledger
        The electric ledger of the steps.
    """

    def __init__(self, supply: SupplyTables, step_s: float) -> None:
        self._step_s = step_s
        self._stations = list(supply_points(supply).values())
        self._demand = ClockDemand(len(self._stations), step_s)
        self._busbar_j = np.zeros(1)
        self.ledger = ElectricLedger()

    def add(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take steps."""
        self.ledger.add(rows.steps, self._step_s)
        power = np.nan_to_num(rows.source_v) * rows.source_a
        self._busbar_j = add_up(self._busbar_j, power.sum(axis=1, keepdims=True) * self._step_s)
        self._demand.add(time_s, sums_of_columns(grid_power(rows, supply), self._stations))

    @property
    def busbar_kwh(self) -> float:
        """Energy of all substations at their busbars."""
        return float(self._busbar_j[0]) / 3.6e6

    @property
    def line_loss_kwh(self) -> float:
        """Heat in contact lines, rails and feeders."""
        return self.ledger.energy_j["conductor"] / 3.6e6

    @property
    def highest_demand_kw(self) -> float:
        """Highest mean power of a supply point over a quarter of an hour by the clock; NaN where none was complete."""
        best = self._demand.best
        return float(np.fmax.reduce(best, initial=np.nan)) / 1000.0
