"""Where a design misses a limit: devices beyond their ratings, voltages below what is asked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.model.scenario import Scenario
from tractionpower.studies.cases.judgement import Check, checks_of
from tractionpower.studies.runner.case import COMPLETE

ALWAYS = ("lowest_voltage_v", "breaker_share_percent", "contract_share_percent", "blackout_s")
"""Figures whose limits are asked of every case."""

NORMALLY = (
    "useful_zone_v", "useful_zone_time_mean_v", "useful_train_v", "useful_train_time_mean_v", "worst_late_s", "stuck_trains",
    "dark_trains", "unserved_loads", "trips",
)  # fmt: skip
"""Figures whose limits are asked of normal operation."""

MENDED_BY_VOLTAGE = frozenset(("low voltage", "useful voltage", "late trains"))
"""Words of limits that more voltage helps to keep; neither contracts nor settings of breakers are among them."""

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
        device, run, or the word of the limit: low voltage, useful voltage, late trains.
    subject
        The device; empty for the others.
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
    """What a scenario asks of its cases.

    Ratings, settings of breakers, contracts and the lowest voltage hold in every case; the mean useful voltage and the
    timetable in the base case at the normal grid voltage, since standards and timetables ask them of normal operation.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.allowed_percent = scenario.sizing.utilisation_percent
        checks = checks_of(scenario)
        self._always = [check for check in checks if check.figure in ALWAYS]
        self._normally = [check for check in checks if check.figure in NORMALLY]

    def facts(self, row: Mapping[str, Any], devices: Iterable[Mapping[str, Any]]) -> CaseFacts:
        """Return what counts of a case: its row of table ``cases``, and its rows of ``case_devices``."""
        percents = {str(item["device"]): item["utilisation_percent"] for item in devices}
        used = {device: float(percent) for device, percent in percents.items() if _known(percent)}
        return CaseFacts(tuple(self._shortfalls(row, used)), used)

    def _shortfalls(self, row: Mapping[str, Any], used: Mapping[str, float]) -> Iterator[Shortfall]:
        case = str(row["case"])
        if row["status"] != COMPLETE:
            yield Shortfall(case, "run", "", "", np.nan, NOT_RUN, f"the run is {row['status']}: {row['reason']}")
        for device, percent in sorted(used.items()):
            if percent > self.allowed_percent * (1.0 + 1e-9):
                words = f"{device} at {percent:.0f} % of its rating, {self.allowed_percent:g} % are allowed"
                yield Shortfall(case, "device", device, "", np.nan, percent / self.allowed_percent - 1.0, words)
        is_normal = row.get("kind") == "base" and row.get("grid") == "normal"
        for check in [*self._always, *(self._normally if is_normal else ())]:
            if _known(row.get(check.figure)) and not check.is_met(row):
                yield _miss(check, row)


def _miss(check: Check, row: Mapping[str, Any]) -> Shortfall:
    """Return by how much a case misses the limit of a figure, and where its voltage is lowest."""
    verdict = check.verdict(row)
    excess = abs(verdict["value"] - check.value) / (check.value or 1.0)
    words = f"{check.name} {verdict['value']:.0f} {check.unit} ({verdict['place']}) against {check.value:g} {check.unit}"
    track, km = str(row["lowest_voltage_track"]), row["lowest_voltage_km"]
    return Shortfall(str(row["case"]), check.word, "", track, float(km) if _known(km) else np.nan, excess, words)


def _known(value: Any) -> bool:
    return value is not None and bool(np.isfinite(value))
