"""A train that is driven while it is computed: its statistics are at hand at any time."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.session import Rows, Session
from tractionpower.dynamics.statistics import EXPONENT, RainflowCounter
from tractionpower.errors import UsageError
from tractionpower.kernels.chain import TINY_S
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.results.dynamics_snapshot import KN

REFERENCE_KN = 100.0
"""Range of the cycles in which the index of damage counts [kN]."""


class DrivenSession(Session):
    """A case in motion whose controls a driver sets, with the statistics of Zobory and Bekefi, section 8, updated as it runs.

    Parameters
    ----------
    scenario
        The case with all that it names; checked. Of its commands those at the very beginning are taken.
    """

    def __init__(self, scenario: DynamicsScenario) -> None:
        super().__init__(scenario, live=True)
        self._damage = 0.0
        self._peaks = (np.inf, -np.inf)
        self._cycles: RainflowCounter | None = None
        try:
            self._cycles = RainflowCounter(1)
        except UsageError:  # the page shows no cycles then
            pass

    def advance(self, until_s: float) -> Literal["done", "ended"]:
        """Run until a time [s]; the extremes of the first coupling in these steps are kept for `take_peaks`."""
        first = self.state.links[:1]
        before = first.copy()
        first["greatest_n"], first["least_n"] = -np.inf, np.inf  # the kernel compares every step with them
        try:
            return super().advance(until_s)
        finally:
            self._keep_peaks(before)

    def take_peaks(self) -> tuple[float, float]:
        """Return least and greatest force of the first coupling [kN] in the steps since the last call, or else that of now."""
        now = float(self.state.links["force_n"][:1].sum())
        least, greatest = self._peaks
        self._peaks = (np.inf, -np.inf)
        return min(least, now) / KN, max(greatest, now) / KN

    def snapshot(self) -> dict[str, Any]:
        """Return what is the case now, with the index of damage of the first coupling as the last `statistics` found it.

        The papers leave the operational evaluation index open. This one is ours: the rainflow cycles of the force of the first
        coupling, by their range to the power of three, as the number of cycles of 100 kN that would do the same damage.
        """
        return super().snapshot() | {"damage_index": self._damage}

    def statistics(self) -> dict[str, Any]:
        """Return the distributions up to now, and the rainflow cycles of the first coupling: range [kN], mean [kN], number."""
        found = self.distributions()
        if self._cycles is None or not len(self.state.links):
            return found | {"rainflow": []}
        self._collect()
        now = self.state.links["turn_n"][:1]
        self._damage = float(self._cycles.damage(now)[0]) / REFERENCE_KN**EXPONENT
        cycles = self._cycles.cycles(now)[0]
        return found | {"rainflow": [(range_kn, mean_kn, count) for (range_kn, mean_kn), count in cycles.items()]}

    def end(self) -> None:
        """End the case here and now, as it would have ended by time: the last state is recorded."""
        setup, ledger = self.compiled.chain.chain, self.state.ledger[0]
        is_recorded = self.time_s < ledger["next_record_s"] - setup[0]["record_s"] + TINY_S
        if is_recorded or self.has_ended:
            self.state.ledger["ended"] = True
        else:
            setup["end_s"] = self.time_s
            self.advance(self.time_s)

    def _keep_peaks(self, before: NDArray[np.void]) -> None:
        """Take the extremes of the steps just computed, and put those of the whole drive back in their place."""
        first = self.state.links[:1]
        if not len(first):
            return
        least, greatest = self._peaks
        self._peaks = min(least, float(first["least_n"][0])), max(greatest, float(first["greatest_n"][0]))
        if first["greatest_n"][0] <= before["greatest_n"][0]:
            first[["greatest_n", "greatest_at_s"]] = before[["greatest_n", "greatest_at_s"]]
        if first["least_n"][0] >= before["least_n"][0]:
            first[["least_n", "least_at_s"]] = before[["least_n", "least_at_s"]]

    def _taken(self, rows: Rows) -> None:
        if self._cycles is not None:
            first = rows.turns[rows.turns["link"] == 0]
            if len(first):
                self._cycles.add(first)
