"""Cases against the limits of their study: what is violated, and by which of them most."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.model.base import format_time
from tractionpower.model.limits import USEFUL_NAMES, common_limits
from tractionpower.model.scenario import Scenario
from tractionpower.results.spells import TOLERANCE_V
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
        """Return whether a case keeps the limit; what has no value violates none."""
        found = row.get(self.figure)
        if found is None:
            return True
        return bool(found >= self.value - self.tolerance if self.is_floor else found <= self.value + self.tolerance)

    def worst(self, rows: Iterable[Row]) -> Row | None:
        """Return the case that is nearest to the limit or furthest beyond it, the first of equals; None if none has a value."""
        known = [row for row in rows if row.get(self.figure) is not None]
        sign = 1.0 if self.is_floor else -1.0
        return min(known, key=lambda row: sign * row[self.figure], default=None)

    def verdict(self, row: Row) -> dict[str, Any]:
        """Return a verdict as ``run.json`` has it, on a case."""
        where = _where(self.figure, row)
        seconds = row.get("lowest_voltage_s") if self.figure == "lowest_voltage_v" else None
        return {
            "name": self.name, "value": float(row[self.figure]), "unit": self.unit,
            "place": f"{row['case']}: {where}" if where else row["case"], "time": "" if seconds is None else format_time(seconds),
            "limit": self.limit, "limit_value": self.value, "source": self.source, "status": self.status, "met": self.is_met(row),
        }  # fmt: skip


def _where(figure: str, row: Row) -> str:
    """Return in words where or of what a figure of a case is."""
    match figure:
        case "lowest_voltage_v":
            return f"track {row['lowest_voltage_track']}, km {row['lowest_voltage_km']:.2f}"
        case "useful_zone_v" | "useful_zone_time_mean_v":
            return f"zone {row[figure.removesuffix('_v')]}"
        case "useful_train_v" | "useful_train_time_mean_v":
            return f"train {row[figure.removesuffix('_v')]}"
        case "utilisation_percent":
            return str(row["utilisation_device"])
        case "worst_late_s":
            return f"train {row['worst_late_train']}" if row["worst_late_train"] else ""
    return ""


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
    allowed, tolerance = scenario.sizing.utilisation_percent, scenario.feasibility.tolerance_s
    user = "user"
    return (
        *found,
        Check("overload", "utilisation of devices", "utilisation_percent", "%", "utilisation_percent", allowed, "study", user),
        Check("late trains", "lateness at calls", "worst_late_s", "s", "tolerance_s", tolerance, "study", user),
        Check("stuck trains", "trains that stand for good", "stuck_trains", "", "stuck_trains", 0.0, "study", user),
    )


def failures(checks: Sequence[Check], row: Row) -> tuple[str, ...]:
    """Return in words what a case violates, each word once."""
    return tuple(dict.fromkeys(check.word for check in checks if not check.is_met(row)))


def verdicts(checks: Sequence[Check], rows: Sequence[Row], ratings: Mapping[str, Rating] | None = None) -> list[dict[str, Any]]:
    """Return the verdict on each limit by the case that is worst for it.

    With `ratings`, by device, the verdict on devices has the source and the status of the rating that rules it.
    """
    found = []
    for check in checks:
        row = check.worst(rows)
        if row is not None:
            rating = (ratings or {}).get(row["utilisation_device"]) if check.figure == "utilisation_percent" else None
            said = {} if rating is None else {"source": rating.source, "status": rating.status}
            found.append(check.verdict(row) | said)
    return found
