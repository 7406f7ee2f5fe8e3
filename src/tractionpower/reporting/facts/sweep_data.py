"""What the figures and sheets of a sweep are made of: the cases that have figures, what each sets, which figures differ."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import pandas as pd

from tractionpower.model.quantity import Quantity
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import mark, recorded
from tractionpower.results.results import Results
from tractionpower.studies.sweep.cases import number_of, short_names

WORDS = {
    "lowest_voltage_v": mark("lowest voltage [V]"),
    "useful_zone_v": mark("lowest mean useful voltage\nof a zone [V]"),
    "utilisation_percent": mark("highest utilisation\nof a device [%]"),
    "worst_late_s": mark("greatest lateness\nat a call [s]"),
    "line_loss_kwh": mark("loss in lines, rails\nand feeders [kWh]"),
    "highest_demand_kw": mark("highest quarter-hour\ndemand [kW]"),
    "rail_potential_v": mark("greatest rail\npotential [V]"),
    "energy_kwh": mark("energy of the\nsubstations [kWh]"),
    "useful_train_v": mark("lowest mean useful voltage\nof a train [V]"),
    "late_trains": mark("late trains"),
    "overloaded": mark("overloaded devices"),
    "trips": mark("trips of breakers"),
}
"""Figures that are drawn, the most telling first, as they are written."""


class SweepData:
    """A sweep as its figures and sheets see it.

    Attributes
    ----------
    scenario
        The base.
    run
        What ``run.json`` says.
    """

    def __init__(self, results: Results, scenario: Scenario) -> None:
        self.results, self.scenario, self.run = results, scenario, results.run

    @property
    def title(self) -> str:
        """Name of the study."""
        return self.scenario.name or str(self.run.get("study", ""))

    @cached_property
    def cases(self) -> pd.DataFrame:
        """All cases, the base first."""
        rows = self.results.table("cases")
        return rows.astype({name: str for name in ("case", "kind", "subject", "status", "reason")})

    @cached_property
    def base(self) -> dict[str, Any] | None:
        """The base case, None if it has no figures."""
        rows = self.measured[self.measured["kind"] == "base"]
        return None if rows.empty else {str(key): value for key, value in rows.iloc[0].items()}

    @cached_property
    def measured(self) -> pd.DataFrame:
        """Cases that have figures."""
        return self.cases[self.cases["status"].isin(("complete", "flagged"))]

    @cached_property
    def changes(self) -> pd.DataFrame:
        """What each case sets: a row for each case, a column for each path in the order in which they were told."""
        rows = self.results.table("case_changes").astype(str)
        wide = rows.pivot_table(index="case", columns="path", values="value", aggfunc="first", sort=False)
        order = [case for case in self.cases["case"] if case in wide.index]
        return wide.reindex(index=order, columns=[path for path in self.run["sweep"]["keys"] if path in wide.columns])

    @property
    def paths(self) -> list[str]:
        """Paths that are varied."""
        return [str(path) for path in self.changes.columns]

    @property
    def keys(self) -> dict[str, list[str]]:
        """Values of each path, numbers rising, others in the order in which they were told."""
        return {path: _sorted(values) for path, values in self.run["sweep"]["keys"].items()}

    @cached_property
    def names(self) -> dict[str, str]:
        """Short names of the paths, with the unit of a quantity."""
        short = short_names(self.keys)
        return {path: _heading(name) for path, name in short.items()}

    def figures(self, most: int) -> list[str]:
        """Return the figures that differ between cases, the most telling first; at most `most`."""
        told = [name for name in WORDS if name in self.run["sweep"]["extremes"]]
        return told[:most]


def _sorted(values: list[str]) -> list[str]:
    numbers = [number_of(value) for value in values]
    if any(number is None for number in numbers):
        return list(values)
    return [value for _, value in sorted(zip((number or 0.0 for number in numbers), values, strict=True))]


def _heading(name: str) -> str:
    """Return a short name with the unit in brackets.

    >>> _heading("A internal_resistance_ohm"), _heading("C state")
    ('A internal resistance [Ω]', 'C state')
    """
    item, _, last = name.rpartition(" ")
    quantity = Quantity(last, "")
    unit = f" [{quantity.unit}]" if quantity.unit else ""
    return name if "." in name else f"{item} {recorded(quantity.words)}{unit}".strip()
