"""What a run does not serve: loads and trains without a voltage, and times in which nothing is fed at all.

A low voltage is no sign of it: what nothing feeds has no voltage that could be low, and takes no energy.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.cosimulation.train_recorder import NO_VOLTAGE_V
from tractionpower.kernels.block_tables import Buffers
from tractionpower.kernels.train_tables import NO_DRIVE
from tractionpower.results.spells import TrainSpells
from tractionpower.supply.characteristics import greatest_demand
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]


class ServiceWatch:
    """Counts loads and trains without a voltage.

    Parameters
    ----------
    run
        What is watched.
    """

    def __init__(self, run: QuietRun) -> None:
        block = run.compiled.block
        self._step_s, self._coast_s = run.scenario.clock.step_s, run.scenario.coast_without_voltage_s
        self._loads, self._load_steps = block.loads, block.load_steps
        self._takes = np.array([greatest_demand(load) > 0.0 for load in run.compiled.supply.loads], bool)
        self._load_s = np.zeros(len(self._takes))
        self._has_motor = run.movement.tables.trains["drive"] != NO_DRIVE
        self._dark = TrainSpells(len(self._has_motor), NO_VOLTAGE_V, above=False, tolerance=0.0)
        self._needs_feeding = run.scenario.coupling == "full" and (len(self._has_motor) > 0 or len(self._takes) > 0)
        self._blackout_s = 0.0

    def add(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take steps, with the supply in its states then."""
        fed = supply.network.ports["start_v"][supply.load_port] > 0.0
        self._load_s += np.where(fed, 0.0, self._wanted(time_s).sum(axis=0) * self._step_s)
        trains = rows.trains
        self._dark.add(trains["time_s"], trains["train"], trains["voltage_v"], self._step_s)
        if self._needs_feeding and not fed.any():
            unfed = len(time_s) - np.count_nonzero(np.isfinite(rows.section_v).any(axis=1))
            self._blackout_s += unfed * self._step_s

    def _wanted(self, time_s: Floats) -> NDArray[np.bool_]:
        """Return when which load should take something, shape (steps, loads)."""
        wanted = np.zeros((len(time_s), len(self._loads)), bool)
        for k, load in enumerate(self._loads):
            steps = self._load_steps[load["first_step"] : load["first_step"] + load["steps"]]
            now = np.searchsorted(steps["time_s"], time_s, side="right") - 1  # as the block of steps does
            factor = np.where(now >= 0, steps["factor"][np.maximum(now, 0)], 0.0)
            wanted[:, k] = self._takes[k] & (load["from_s"] <= time_s) & (time_s < load["to_s"]) & (factor > 0.0)
        return wanted

    def figures(self) -> dict[str, Any]:
        """Return the key figures of what is not served."""
        dark = (self._dark.longest_s > self._coast_s + 1e-6) & self._has_motor
        return {
            "unserved_loads": int(np.count_nonzero(self._load_s > 0.0)),
            "unserved_load_s": float(self._load_s.sum()),
            "dark_trains": int(np.count_nonzero(dark)),
            "blackout_s": float(self._blackout_s),
        }
