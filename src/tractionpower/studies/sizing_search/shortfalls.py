"""Where a design misses a limit: devices beyond their ratings, voltages below what is asked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.model.limits import find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.results.spells import TOLERANCE_V

USEFUL = {"conventional": "u_useful", "high_speed": "u_useful_high_speed"}
"""Limit of the mean useful voltage for each class of line."""

NOT_RUN = 10.0
"""What a case that does not complete misses: more than any other."""


@dataclass(frozen=True, slots=True)
class Shortfall:
    """A limit that a case misses.

    Attributes
    ----------
    case
        The case.
    what
        device, voltage, useful_voltage or run.
    subject
        The device, zone or train; empty for the lowest voltage.
    track, km
        Where the voltage of the case is lowest; empty and NaN for a device.
    excess
        By how much it is missed, as a share of the limit.
    words
        The same for people.
    """

    case: str
    what: str
    subject: str
    track: str
    km: float
    excess: float
    words: str


@dataclass(frozen=True, slots=True)
class CaseFacts:
    """What the search knows of a case: its shortfalls, and the utilisation of each rated device [%]."""

    shortfalls: tuple[Shortfall, ...]
    utilisation: Mapping[str, float]

    @property
    def excess(self) -> float:
        """By how much all limits are missed together."""
        return sum(item.excess for item in self.shortfalls)


class Asked:
    """What a scenario asks of every case.

    Ratings and the lowest voltage of the system hold in every case, the mean useful voltage in the base case at the normal
    grid voltage: the standards ask it of normal operation.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.allowed_percent = scenario.sizing.utilisation_percent
        system, limits = scenario.supply.system, scenario.limits
        lowest = find_limit(limits, system, "u_min2")
        useful = find_limit(limits, system, USEFUL[scenario.sizing.useful_voltage.line_class])
        self.lowest_v = None if lowest is None else lowest.value
        self.useful_v = None if useful is None else useful.value

    def facts(self, row: Mapping[str, Any], devices: Iterable[Mapping[str, Any]]) -> CaseFacts:
        """Return what counts of a case: its row of table ``cases``, and its rows of ``case_devices``."""
        used = {
            str(item["device"]): float(item["utilisation_percent"]) for item in devices if _known(item["utilisation_percent"])
        }
        return CaseFacts(tuple(self._shortfalls(row, used)), used)

    def _shortfalls(self, row: Mapping[str, Any], used: Mapping[str, float]) -> Iterator[Shortfall]:
        case = str(row["case"])
        if row["status"] != "complete":
            yield Shortfall(case, "run", "", "", np.nan, NOT_RUN, f"the run is {row['status']}: {row['reason']}")
        for device, percent in sorted(used.items()):
            if percent > self.allowed_percent * (1.0 + 1e-9):
                words = f"{device} at {percent:.0f} % of its rating, {self.allowed_percent:g} % are allowed"
                yield Shortfall(case, "device", device, "", np.nan, percent / self.allowed_percent - 1.0, words)
        yield from self._voltages(case, row)

    def _voltages(self, case: str, row: Mapping[str, Any]) -> Iterator[Shortfall]:
        lowest = row.get("lowest_voltage_v")
        if not _known(lowest):
            return
        track, km = str(row["lowest_voltage_track"]), float(row["lowest_voltage_km"])
        if self.lowest_v is not None and float(lowest or 0.0) < self.lowest_v - TOLERANCE_V:
            words = f"{lowest:.0f} V on track {track} at km {km:.1f}, below {self.lowest_v:g} V"
            yield Shortfall(case, "voltage", "", track, km, 1.0 - float(lowest or 0.0) / self.lowest_v, words)
        if self.useful_v is None or row.get("kind") != "base" or row.get("grid") != "normal":
            return
        for name in ("zone", "train"):
            volts, subject = row.get(f"useful_{name}_v"), f"{name} {row.get(f'useful_{name}')}"
            if _known(volts) and float(volts or 0.0) < self.useful_v - TOLERANCE_V:
                words = f"mean useful voltage {volts:.0f} V of {subject}, below {self.useful_v:g} V"
                yield Shortfall(case, "useful_voltage", subject, track, km, 1.0 - float(volts or 0.0) / self.useful_v, words)


def _known(value: Any) -> bool:
    return value is not None and bool(np.isfinite(value))
