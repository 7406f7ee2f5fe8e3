"""What the figures and sheets of a sweep are made of: the cases that have figures, what each sets, which figures differ."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import pandas as pd

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.input_words import bare_unit, names_of_inputs, value_at, value_in_words
from tractionpower.reporting.texts import decimal, mark, recorded
from tractionpower.results.results import Results
from tractionpower.studies.sweep.cases import number_of

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
        """What the paths are called, with the unit of a quantity."""
        return names_of_inputs(self.keys)

    @cached_property
    def of_base(self) -> dict[str, str]:
        """Values of the paths in the base, where it has one."""
        found = {path: value_at(self.scenario, path) for path in self.keys}
        return {path: value for path, value in found.items() if value is not None}

    @property
    def short_names(self) -> list[str]:
        """What the paths are called, without what they belong to where all can be told apart so."""
        names = list(self.names.values())
        lasts = [name.rpartition(": ")[2] for name in names]
        return lasts if len(set(lasts)) == len(lasts) else names

    def subject(self, case: str, *, short: bool = False) -> str:
        """Return in words what a case sets; nothing for one that sets nothing. `short`: without what inputs belong to."""
        if case not in self.changes.index:
            return ""
        brief = short and self.short_names != list(self.names.values())
        told = ((path, value) for path, value in self.changes.loc[case].items() if isinstance(value, str))
        return ", ".join(self.setting(path, value, short=brief) for path, value in told)

    def setting(self, path: Any, value: str, *, short: bool = False) -> str:
        """Return what a path is set to, such as ``substation A: units in service 1``; `short` leaves out what it belongs to."""
        name, unit = bare_unit(self.names[str(path)])
        name = name.rpartition(": ")[2] if short else name
        told = recorded(value_in_words(value)) if number_of(value) is None else decimal(value)
        return f"{name} {told} {unit}".strip()

    def figures(self, most: int) -> list[str]:
        """Return the figures that differ between cases, the most telling first; at most `most`."""
        told = [name for name in WORDS if name in self.run["sweep"]["extremes"]]
        return told[:most]


def _sorted(values: list[str]) -> list[str]:
    numbers = [number_of(value) for value in values]
    if any(number is None for number in numbers):
        return list(values)
    return [value for _, value in sorted(zip((number or 0.0 for number in numbers), values, strict=True))]
