"""What a run takes from the feeding grid, and what of it is lost."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.block_tables import Buffers
from tractionpower.results.extremes import add_up
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.supply.devices import sums_of_columns


class EnergyWatch:
    """Sums up the powers of substations.

    Parameters
    ----------
    step_s
        Length of a step [s].

    Attributes
    ----------
    ledger
        The electric ledger of the steps.
    """

    def __init__(self, step_s: float) -> None:
        self._step_s = step_s
        self._busbar_j = np.zeros(1)
        self.ledger = ElectricLedger()

    def add(self, rows: Buffers) -> None:
        """Take steps."""
        self.ledger.add(rows.steps, self._step_s)
        power = sums_of_columns(np.nan_to_num(rows.source_v) * rows.source_a, [range(rows.source_a.shape[1])])
        self._busbar_j = add_up(self._busbar_j, power * self._step_s)

    @property
    def busbar_kwh(self) -> float:
        """Energy of all substations at their busbars."""
        return float(self._busbar_j[0]) / 3.6e6

    @property
    def line_loss_kwh(self) -> float:
        """Heat in contact lines, rails and feeders."""
        return self.ledger.energy_j["conductor"] / 3.6e6
