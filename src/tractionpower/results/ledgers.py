"""Ledgers that must close: what goes in comes out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.network import FLAG_A
from tractionpower.results.extremes import add_up


class ElectricLedger:
    """The electric ledger of a run: sum E I = trains + loads + line + regulation, in every step.

    A step closes within 1e-9 of the gross power exchanged plus 1 mW, if its nodes balance within `FLAG_A`.
    """

    NAMES = ("source", "regulation", "train", "load", "conductor")

    def __init__(self) -> None:
        self._total = np.zeros(len(self.NAMES))
        self.worst_gap_w = self.worst_share = 0.0
        self.balances = True

    def add(self, steps: NDArray[np.void], step_s: float) -> None:
        """Add the results of steps, records of `tractionpower.kernels.tables.STEP_RESULT`."""
        powers = np.stack([steps[f"{name}_w"] for name in self.NAMES], axis=1)
        self._total = add_up(self._total, powers * step_s)
        taken = steps["train_w"] + steps["load_w"] + steps["conductor_w"]
        gap = np.abs(steps["source_w"] - steps["regulation_w"] - taken)
        gap[np.isnan(gap)] = np.inf  # not a number must not pass for a balance
        if gap.size:
            self.balances = self.balances and bool((steps["worst_a"] <= FLAG_A).all())
            self.worst_gap_w = max(self.worst_gap_w, float(gap.max()))
            self.worst_share = max(self.worst_share, float((gap / (1e-9 * np.nan_to_num(steps["gross_w"]) + 1e-3)).max()))

    @property
    def energy_j(self) -> dict[str, float]:
        """Energies by name [J]."""
        return dict(zip(self.NAMES, self._total.tolist(), strict=True))

    @property
    def closes(self) -> bool:
        """Whether every step closes."""
        return self.worst_share <= 1.0 and self.balances

    def as_dict(self) -> dict[str, Any]:
        """Return energies [kWh] and the worst gap [W]."""
        energies = {f"{name}_kwh": joule / 3.6e6 for name, joule in self.energy_j.items()}
        return {"closes": self.closes, "worst_gap_w": self.worst_gap_w} | energies
