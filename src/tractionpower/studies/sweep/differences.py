"""Differences of the key figures of cases from the base case, and which case is best and worst by each."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tractionpower.results.sizing_columns import SIZING_TABLES

PLACES = ("lowest_voltage_km", "lowest_voltage_s", "rail_potential_km")
"""Numeric columns of table ``cases`` that say where or when something is: not better or worse."""

FIGURES = tuple(
    column.name for column in SIZING_TABLES["cases"] if column.kind in ("f4", "f8", "i4") and column.name not in PLACES
)
"""Figures of a case that are compared."""

HIGHER_IS_BETTER = (
    "lowest_voltage_v",
    "useful_zone_v",
    "useful_train_v",
    "useful_zone_time_mean_v",
    "useful_train_time_mean_v",
)
"""Of others less is better: demand, losses, utilisation, lateness."""

NOT_JUDGED = ("energy_kwh",)
"""Trains that are slowed down by low voltage, or stand, take less energy."""

SAME = 1e-9
"""Values that differ by less than this share are the same: they come from sums in another order."""


def differences(rows: Sequence[Mapping[str, Any]], base: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the differences of all figures that the base case and a case have, in the order of the cases."""
    found = []
    for row in rows:
        for name in FIGURES:
            reference, value = figure_of(base, name), figure_of(row, name)
            if row["case"] != base["case"] and reference is not None and value is not None:
                difference, percent = change_of(reference, value)
                case = {"case": row["case"], "figure": name, "base": reference, "value": value}
                found.append(case | {"difference": difference, "percent": percent})
    return found


def change_of(reference: float, value: float) -> tuple[float, float]:
    """Return the difference of `value` from `reference` and the per cent that it is of it; NaN of zero.

    >>> change_of(-200.0, -150.0)
    (50.0, 25.0)
    """
    if reference == value or abs(value - reference) <= SAME * abs(reference):  # also where both are infinite
        return 0.0, 0.0 if reference else math.nan
    difference = value - reference
    return difference, 100.0 * difference / abs(reference) if reference and math.isfinite(reference) else math.nan


def figure_of(row: Mapping[str, Any], name: str) -> float | None:
    """Return a figure of a case, None where it has no value."""
    value = row.get(name)
    return None if value is None or math.isnan(value) else float(value)


def extremes(rows: Iterable[Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return for each figure which case is best and which worst; figures that no case has, or all alike, are left out."""
    kept = list(rows)
    found = {}
    for name in FIGURES:
        values = {str(row["case"]): value for row in kept if (value := figure_of(row, name)) is not None}
        if not values:
            continue
        low, high = (choose(values, key=lambda case: values[case]) for choose in (min, max))
        if change_of(values[high], values[low])[0] == 0.0:
            continue
        words = ("worst", "best") if name in HIGHER_IS_BETTER else ("best", "worst")
        words = ("lowest", "highest") if name in NOT_JUDGED else words
        found[name] = {word: {"case": case, "value": values[case]} for word, case in zip(words, (low, high), strict=True)}
    return found
