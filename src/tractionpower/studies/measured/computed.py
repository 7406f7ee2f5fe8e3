"""What a run computed of the quantities that were measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.errors import Problem
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.model.measured import SUBJECTS, MeasuredMap, MeasuredSeries
from tractionpower.model.scenario import ROUNDING_S
from tractionpower.results.results import Results

Array = NDArray[Any]

KEYS = {
    "trains": ("train",),
    "substations": ("substation",),
    "loads": ("load",),
    "feeders": ("substation", "track", "side"),
    "cabins": ("section_cabin", "track", "side"),
}
"""Columns that name what a row is of, by table."""

INSTANT = ("position_km", "distance_m", "speed_kmh")
"""Columns whose values are those at the start of a step; all others are means of it."""


@dataclass(frozen=True, slots=True)
class Computed:
    """A computed series.

    Attributes
    ----------
    time_s
        Starts of the steps [s].
    values
        In the unit of the quantity; NaN where there is none.
    step_s, every_s
        Length of a step, and distance of the rows [s].
    instant
        Whether a value is that at the start of the step, not its mean.
    """

    time_s: Array
    values: Array
    step_s: float
    every_s: float
    instant: bool

    @property
    def windows(self) -> Array:
        """Beginnings of the windows of a step's length that the values stand for [s]."""
        return self.time_s - self.step_s / 2.0 if self.instant else self.time_s


class Run:
    """The tables of a run, each read once; rows of the time of warming up are left out.

    Parameters
    ----------
    results
        The run.
    """

    def __init__(self, results: Results) -> None:
        self.results = results
        scenario = results.scenario
        clock = scenario.clock if scenario is not None else None
        self.step_s = float(results.run.get("step_s") or (clock.step_s if clock is not None else 0.0))
        self.from_s = -np.inf if clock is None else clock.counts_from_s
        self._groups: dict[str, dict[str, pd.DataFrame]] = {}

    def has_power(self, each: MeasuredSeries) -> bool:
        """Return whether the table of a series tells the power as well."""
        return "power_kw" in self.results.schema(each.table).names

    def series(self, each: MeasuredSeries, quantity: str = "") -> Computed:
        """Return what was computed of a series, or of another `quantity` of the same thing."""
        name = quantity or each.quantity
        rows = self._of(each.table)[each.subject]
        time_s = rows["time_s"].to_numpy(float)
        every = float(np.median(np.diff(time_s))) if len(time_s) > 1 else self.step_s
        return Computed(time_s, rows[name].to_numpy(float), self.step_s or every, every or 1.0, name in INSTANT)

    def problems(self, asked: MeasuredMap, place: Callable[[int, str], str]) -> list[Problem]:
        """Return what of the map the run does not have; `place` gives file and line of a key of a series."""
        found: list[Problem] = []
        for number, each in enumerate(asked.series):
            problem = self._problem(each, number, place)
            if problem is not None:
                found.append(problem)
        return found

    def _problem(self, each: MeasuredSeries, number: int, place: Callable[[int, str], str]) -> Problem | None:
        path, table = f"series[{number}]", each.table
        if table not in self.results.tables:
            known = [kind for kind, name in SUBJECTS.items() if name in self.results.tables]
            found = f"the run has no table {table}"
            return Problem("no_table", f"{path}.of", found, ", ".join(known), place=place(number, "of"))
        columns = self.results.schema(table)
        numeric = [own.name for own in columns if str(own.type) in ("float", "double") and own.name != "time_s"]
        if each.quantity not in numeric:
            remedy, found = did_you_mean(each.quantity, numeric), shown(each.quantity)
            return Problem("no_quantity", f"{path}.quantity", found, ", ".join(numeric), remedy, place=place(number, "quantity"))
        names = self._of(table)
        if each.subject not in names:
            remedy, allowed = did_you_mean(each.subject, names), f"{each.kind}s of the run: {_listed(list(names))}"
            return Problem("no_subject", f"{path}.of", shown(each.subject), allowed, remedy, place=place(number, "of"))
        if not np.isfinite(self._of(table)[each.subject][each.quantity].to_numpy(float)).any():
            found = f"{each.quantity} of {each.of} has no value in the run"
            return Problem("no_value", path, found, place=place(number, "quantity"))
        return None

    def _of(self, table: str) -> dict[str, pd.DataFrame]:
        if table not in self._groups:
            rows = self.results.table(table)
            rows = rows[rows["time_s"] >= self.from_s - ROUNDING_S]
            groups = rows.groupby(list(KEYS[table]), observed=True, sort=True)
            self._groups[table] = {" ".join(map(str, key)): own.sort_values("time_s", kind="stable") for key, own in groups}
        return self._groups[table]


def _listed(names: list[str], most: int = 12) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
