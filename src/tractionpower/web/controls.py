"""The driver's controls as the page holds them: levels that stay within the case's, and what is told when they do not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.web.orders import Action, Order, SetLevel, SetPressure, StepLevel

WORDS = ("emergency", "full_service", "charge")
"""What the brake control also knows beside its levels."""


class Controls:
    """Drive, brake, electric and independent brake.

    Parameters
    ----------
    highest
        Highest level of each control; 0 where the case has no such control.
    independent
        Whether there is an independent brake.
    """

    def __init__(self, highest: Mapping[str, int], *, independent: bool) -> None:
        self.highest = dict(highest)
        self.independent = independent
        self.levels: dict[str, int] = dict.fromkeys(highest, 0)
        self.independent_bar = 0.0

    def obey(self, order: Order) -> tuple[dict[str, Any], str]:
        """Return what a session has to set for an order, and a notice where the order is not followed as given."""
        match order:
            case SetLevel(control, level):
                return self._set(control, level)
            case StepLevel(control, by):
                return self._set(control, min(max(self.levels[control] + by, 0), self.highest[control]))
            case SetPressure(bar):
                return self._set_independent(bar)
            case Action(name) if name in WORDS:
                return self._say(name)
        return {}, ""

    def _set_independent(self, bar: float) -> tuple[dict[str, Any], str]:
        if not self.independent:
            return {}, "this train has no independent brake"
        self.independent_bar = bar
        return {"independent_bar": bar}, ""

    def _say(self, word: str) -> tuple[dict[str, Any], str]:
        if not self.highest["brake"]:
            return {}, "this train has no brake control"
        self.levels["brake"] = 0 if word == "charge" else self.highest["brake"]
        return {"brake": word}, ""

    def _set(self, control: str, level: int) -> tuple[dict[str, Any], str]:
        highest = self.highest[control]
        if not highest:
            return {}, f"this train has no {control} control"
        taken = min(level, highest)
        self.levels[control] = taken
        setting = {control: float(taken) if control == "electric" else taken}
        return setting, "" if taken == level else f"{control} level {level} is above the highest, {highest}: taken as {highest}"
