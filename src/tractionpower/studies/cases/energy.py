"""What a run takes from the feeding grid: energies, and the demand of supply points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.scenario import Scenario
from tractionpower.results.extremes import add_up
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.studies.ratings.demand import DemandWatch
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.devices import sums_of_columns

Floats = NDArray[np.float64]


class EnergyWatch:
    """Sums up the powers of substations.

    Parameters
    ----------
    scenario, supply
        What runs.

    Attributes
    ----------
    ledger
        The electric ledger of the steps.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        self._step_s = scenario.clock.step_s
        self._demand = DemandWatch(scenario, supply)
        self._busbar_j = np.zeros(1)
        self.ledger = ElectricLedger()

    def add(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take steps."""
        self.ledger.add(rows.steps, self._step_s)
        power = sums_of_columns(np.nan_to_num(rows.source_v) * rows.source_a, [range(rows.source_a.shape[1])])
        self._busbar_j = add_up(self._busbar_j, power * self._step_s)
        self._demand(time_s, rows, supply)

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
        return float(np.fmax.reduce(self._demand.power_kw, axis=None, initial=np.nan))
