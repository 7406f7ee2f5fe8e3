"""Cases against the limits of their study: what is violated, and by which of them most."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.model.base import format_time
from tractionpower.model.limits import USEFUL_NAMES, common_limits, find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import AT_LEAST, AT_MOST
from tractionpower.supply.ratings import Rating

Row = Mapping[str, Any]
"""A row of table ``cases``."""


@dataclass(frozen=True, slots=True)
class Check:
    """A figure of cases and its limit.

    Attributes
    ----------
    word
        What is wrong, in a word.
    name, figure, unit
        What it is called, its column of table ``cases``, and its unit.
    limit, value, source, status
        Name of the limit, its value, where it comes from and how it is known.
    is_floor
        Whether the figure must not be below it, rather than above.
    tolerance
        By which it may be missed.
    """

    word: str
    name: str
    figure: str
    unit: str
    limit: str
    value: float
    source: str
    status: str
    is_floor: bool = False
    tolerance: float = 0.0

    def is_met(self, row: Row) -> bool:
        """Return whether a case keeps the limit; what has no value violates none: what is not served has figures of its own."""
        return not self.beyond(row) > self.tolerance

    def beyond(self, row: Row) -> float:
        """Return by how much a case is beyond the limit, negative within it; NaN for one without a value."""
        found = row.get(self.figure)
        if found is None:
            return math.nan
        return float(self.value - found if self.is_floor else found - self.value)

    def verdict(self, row: Row) -> dict[str, Any]:
        """Return a verdict as ``run.json`` has it, on a case."""
        where = _where(self.figure, row)
        seconds = row.get("lowest_voltage_s") if self.figure == "lowest_voltage_v" else None
        return {
            "name": self.name, "value": float(row[self.figure]), "unit": self.unit,
            "place": f"{row['case']}: {where}" if where else row["case"], "time": "" if seconds is None else format_time(seconds),
            "limit": self.limit, "limit_value": self.value, "source": self.source, "status": self.status,
            "sense": AT_LEAST if self.is_floor else AT_MOST, "met": self.is_met(row),
        }  # fmt: skip


SUBJECTS = {
    "lowest_voltage_v": "track {lowest_voltage_track}, km {lowest_voltage_km:.2f}",
    "useful_zone_v": "zone {useful_zone}",
    "useful_train_v": "train {useful_train}",
    "useful_zone_time_mean_v": "zone {useful_zone_time_mean}",
    "useful_train_time_mean_v": "train {useful_train_time_mean}",
    "utilisation_percent": "{utilisation_device}",
    "contract_share_percent": "supply point {contract_point}",
    "breaker_share_percent": "{breaker_device}",
}
"""Of what a figure of a case is, with the columns that name it."""


def _where(figure: str, row: Row) -> str:
    """Return in words where or of what a figure of a case is."""
    if figure == "worst_late_s":
        return f"train {row['worst_late_train']}" if row["worst_late_train"] else ""
    return SUBJECTS.get(figure, "").format(**row)


def checks_of(scenario: Scenario) -> tuple[Check, ...]:
    """Return what the cases of a study are held against; limits that the limits table does not have are left out."""
    limits = common_limits(scenario.limits, scenario.supply.system, "u_")
    useful = USEFUL_NAMES[scenario.sizing.useful_voltage.line_class]
    volts = [
        ("low voltage", "lowest voltage", "lowest_voltage_v", "u_min2", True),
        ("high voltage", "highest voltage", "highest_voltage_v", "u_max2", False),
        ("useful voltage", "mean useful voltage of zones, current-weighted", "useful_zone_v", useful, True),
        ("useful voltage", "mean useful voltage of trains, current-weighted", "useful_train_v", useful, True),
        ("useful voltage", "mean useful voltage of zones, time mean", "useful_zone_time_mean_v", useful, True),
        ("useful voltage", "mean useful voltage of trains, time mean", "useful_train_time_mean_v", useful, True),
    ]
    found = [
        Check(word, name, figure, "V", key, limits[key].value, limits[key].source, limits[key].status, is_floor, TOLERANCE_V)
        for word, name, figure, key, is_floor in volts
        if key in limits
    ]
    longest = find_limit(scenario.limits, scenario.supply.system, "t_max2")
    if longest is not None:
        known = longest.name, longest.value, longest.source, longest.status
        found.append(Check("high voltage", "longest spell above U_max1", "above_u_max1_s", "s", *known))
    return (*found, *_study_checks(scenario), *_NOT_SERVED)


def _study_checks(scenario: Scenario) -> Iterator[Check]:
    """Yield what the study itself permits."""
    sizing, tolerance_s = scenario.sizing, scenario.feasibility.tolerance_s
    allowed = sizing.utilisation_percent
    for word, name, figure, limit, value, source in (
        ("overload", "utilisation of devices", "utilisation_percent", "utilisation_percent", allowed, "study"),
        ("contract", DEMAND, "contract_share_percent", "contract_power_kw", 100.0, "contracts of the inputs"),
        ("breaker", PEAK, "breaker_share_percent", "breaker_percent", sizing.breaker_percent, "settings of the inputs"),
    ):
        yield Check(word, name, figure, "%", limit, value, source, "user", tolerance=ROUNDING * value)
    yield Check("late trains", "lateness at calls", "worst_late_s", "s", "tolerance_s", tolerance_s, "study", "user")


def _none(word: str, name: str, figure: str, unit: str = "") -> Check:
    """Return a check of what must not be."""
    return Check(word, name, figure, unit, figure, 0.0, "study", "user")


DEMAND = "highest demand of a quarter of an hour, of the contract"
PEAK = "peak of feeders, of the setting of the breaker"

ROUNDING = 1e-9
"""Share by which a share may be beyond what is permitted, as in `studies.ratings.use`."""

_NOT_SERVED = (
    _none("tripped breakers", "trips of breakers", "trips"),
    _none("stuck trains", "trains that stand for good", "stuck_trains"),
    _none("trains without voltage", "trains without a voltage for longer than they coast", "dark_trains"),
    _none("unfinished trains", "trains that do not end their run though they do in the base case", "unfinished_trains"),
    _none("loads without voltage", "loads without a voltage while they should take something", "unserved_loads"),
    _none("nothing fed", "time in which nothing at all is fed", "blackout_s", "s"),
)


def failures(checks: Sequence[Check], row: Row) -> tuple[str, ...]:
    """Return in words what a case violates, each word once."""
    return tuple(dict.fromkeys(check.word for check in checks if not check.is_met(row)))


def verdicts(checks: Sequence[Check], rows: Sequence[Row], ratings: Mapping[str, Rating] | None = None) -> list[dict[str, Any]]:
    """Return the verdict on each limit by the case that is worst for it: nearest to the limit, or furthest beyond it.

    With `ratings`, by device, the verdict on devices has the source and the status of the rating that rules it.
    """
    return own_verdicts([(checks, row) for row in rows], ratings)


def own_verdicts(
    judged: Iterable[tuple[Sequence[Check], Row]], ratings: Mapping[str, Rating] | None = None
) -> list[dict[str, Any]]:
    """Return the same where each case has limits of its own.

    The worst case is that which is furthest beyond its own limit, as a share of it; of equal ones the first.
    """
    worst: dict[str, tuple[float, Check, Row] | None] = {}
    for checks, row in judged:
        for check in checks:
            known, beyond = worst.setdefault(check.name, None), check.beyond(row) / (abs(check.value) or 1.0)
            if not math.isnan(beyond) and (known is None or beyond > known[0]):
                worst[check.name] = beyond, check, row
    found = []
    for _, check, row in filter(None, worst.values()):
        rating = (ratings or {}).get(row["utilisation_device"]) if check.figure == "utilisation_percent" else None
        said = {} if rating is None else {"source": rating.source, "status": rating.status}
        found.append(check.verdict(row) | said)
    return found
