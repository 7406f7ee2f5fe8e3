"""What the figures of a run are drawn from: its tables, each read once, its key figures, its trains on their routes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.scenario import Scenario
from tractionpower.model.vehicle import Train
from tractionpower.movement.compile import PlannedRun, plan_runs
from tractionpower.reporting.facts.formations import kinds_of_trains
from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.facts.selected import selection_words
from tractionpower.reporting.texts import number, tr
from tractionpower.results.results import Results

MOST_TITLE_LETTERS = 120
"""Letters of the name of a study above a figure; of a longer one the beginning stands there."""

SAME_S = 1e-6
"""Times that differ by less are the same [s]."""


@dataclass(frozen=True)
class RunData:
    """A run as the figures see it.

    Attributes
    ----------
    results, scenario
        What the run wrote, and what it was a run of.
    """

    results: Results
    scenario: Scenario
    _read: dict[str, pd.DataFrame] = field(default_factory=dict)
    _parts: dict[tuple[str, str], dict[str, pd.DataFrame]] = field(default_factory=dict)

    def table(self, name: str) -> pd.DataFrame | None:
        """Return a table, or None if the run has none or it is empty: `output.tables` may leave it out."""
        if name not in self._read:
            exists = name in self.results.tables
            self._read[name] = self.results.table(name) if exists else pd.DataFrame()
        rows = self._read[name]
        return rows if len(rows) else None

    def rows_of(self, name: str, key: str) -> Iterator[tuple[str, pd.DataFrame]]:
        """Yield the rows of each device or train of a table in the order of time; `key` is the column of its name."""
        yield from self._by_key(name, key).items()

    def _by_key(self, name: str, key: str) -> dict[str, pd.DataFrame]:
        """Return the rows of each device or train of a table: parts of it in order, which is sorted once for all figures."""
        if (name, key) not in self._parts:
            rows = self.table(name)
            self._parts[name, key] = {} if rows is None else _parts(rows, key)
        return self._parts[name, key]

    @property
    def title(self) -> str:
        """Name of the study; with rows at intervals only, it says so, since a peak between two rows does not show."""
        name = self.scenario.name or str(self.results.run.get("study", ""))
        name = name if len(name) <= MOST_TITLE_LETTERS else f"{name[: MOST_TITLE_LETTERS - 1].rstrip()}…"
        selected = selection_words(self.results.run)
        name = f"{name} ({selected})" if selected else name
        every_s = self.scenario.output.every_s
        if not every_s or every_s <= self.scenario.clock.step_s:
            return name
        return tr("{study} (rows every {seconds} s)", study=name, seconds=number(every_s, 3))

    @cached_property
    def key_figures(self) -> dict[tuple[str, str], dict[str, Any]]:
        """Key figures by name and place."""
        return {(figure["name"], figure["place"]): figure for figure in self.results.key_figures}

    def figure(self, name: str, place: str = "") -> float | None:
        """Return the value of a key figure, or None."""
        found = self.key_figures.get((name, place))
        return None if found is None or found["value"] is None else float(found["value"])

    @cached_property
    def places(self) -> LinePlaces:
        """What stands along each of the lines, as far as it is selected."""
        selected = self.results.run.get("selection") or {}
        return LinePlaces(self.scenario, selected.get("from_km", -math.inf), selected.get("to_km", math.inf))

    @cached_property
    def planned(self) -> dict[str, PlannedRun]:
        """Runs of the timetable on their routes, by identifier."""
        runs = plan_runs(self.scenario, sorted(self.scenario.runs, key=lambda run: run.id))
        return {planned.run.id: planned for planned in runs}

    @cached_property
    def kinds(self) -> dict[str, Train]:
        """Kinds of trains that ran, by name, those of most trains first; none without the table of trains."""
        trains = self.table("trains")
        ran = set() if trains is None else {str(name) for name in trains["train"].unique()}
        runs = (planned.run for name, planned in self.planned.items() if name in ran)
        return kinds_of_trains(runs, self.scenario.trains)

    @cached_property
    def ways(self) -> dict[str, dict[str, Any]]:
        """What became of each train: its status, when it entered and when it finished."""
        return {entry["train"]: entry for entry in self.results.run.get("trains", ())}

    def whole_rows(self, name: str) -> pd.DataFrame | None:
        """Return the rows of a train in order, or None; the step within which it leaves is left out.

        Its means are those of the whole step, of which the train was on the line for a part only.
        """
        rows = self._by_key("trains", "train").get(name)
        if rows is None:
            return None
        finished = self.ways.get(name, {}).get("finished_s")
        leaves = finished is not None and len(rows) > 1
        if leaves and finished < rows["time_s"].iloc[-1] + self.scenario.clock.step_s - SAME_S:
            rows = rows.iloc[:-1]
        return rows

    @property
    def interval_s(self) -> float:
        """From one row of a train to the next [s]."""
        return max(self.scenario.clock.step_s, self.scenario.output.every_s or 0.0)

    @property
    def counts_from_s(self) -> float:
        """Time from which rows count in key figures [s]."""
        return self.scenario.clock.counts_from_s

    @property
    def counted_hours(self) -> float:
        """Length of the run that counts in key figures [h]."""
        clock = self.scenario.clock
        steps = int(self.results.run.get("steps", 0))
        return max(0.0, steps * clock.step_s - (clock.warm_up or 0.0)) / 3600.0


def _parts(rows: pd.DataFrame, key: str) -> dict[str, pd.DataFrame]:
    codes, names = pd.factorize(rows[key], sort=True)
    order = np.lexsort((rows["time_s"].to_numpy(), codes))
    ends = np.searchsorted(codes[order], np.arange(len(names)), side="right")
    begins = np.searchsorted(codes[order], np.arange(len(names)), side="left")
    in_order = rows.iloc[order]
    return {str(name): in_order.iloc[begin:end] for name, begin, end in zip(names, begins, ends, strict=True)}
