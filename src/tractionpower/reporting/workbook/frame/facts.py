"""What the sheets tell, gathered: the run, its figures by place, its tables, limits."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import pandas as pd

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.limits import Limit, find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.facts.selected import selection_words
from tractionpower.reporting.texts import mark, tr
from tractionpower.results.results import Results

KNOWN_AS = {
    "verified": mark("verified against the text of its source"),
    "secondary": mark("secondary: from a source that quotes it"),
    "recalled": mark("recalled from memory"),
    "user": mark("given by the user"),
    "derived": mark("derived by the program from its source"),
    "assumed": mark("assumed"),
}
"""How the value of a limit is known, by its status."""

STATES = {
    "before": mark("left before the clock"),
    "left": mark("left the line"),
    "stays": mark("stays at its end"),
    "on_line": mark("still on the line at the end"),
    "outside": mark("did not enter"),
    "stuck": mark("stuck on the line"),
    "beyond": mark("goes on beyond the part"),
}
"""What became of a train, by the status in ``run.json``."""


def limit_in_words(name: str) -> str:
    """Return the name of a limit as it is written.

    >>> limit_in_words("u_min2")
    'U_min2'
    """
    if name.startswith("touch_"):
        return tr("time above {limit}", limit=name)
    return f"U_{name[2:]}" if name.startswith("u_") else name


class Subject:
    """What a workbook is about: results, the name of their study."""

    def __init__(self, results: Results) -> None:
        self.results, self.run = results, results.run

    @property
    def study(self) -> str:
        """Name of the study."""
        return str(self.run.get("name") or self.run.get("study") or "study")

    @property
    def input_hash(self) -> str:
        """Hash of the inputs."""
        return str(self.run.get("input_hash", ""))

    @property
    def about(self) -> str:
        """What the document is about, for its properties."""
        return tr("Co-simulation of traction power supply and train movement")


class Computed(Subject):
    """Results of one computation, whatever was computed: verdicts, tables, key figures by place."""

    def __init__(self, results: Results) -> None:
        super().__init__(results)
        self._tables: dict[str, pd.DataFrame] = {}

    @property
    def name(self) -> str:
        """Name of what was computed, whatever part of it this is."""
        return super().study

    @property
    def time_heading(self) -> str:
        """What times are called, English."""
        return mark("time of day")

    @property
    def part(self) -> str:
        """What part of the run this is, in words; empty for all of it."""
        return selection_words(self.run)

    @property
    def verdicts(self) -> list[dict[str, Any]]:
        """Verdicts of the run, each with all its keys."""
        keys = ("name", "value", "unit", "place", "time", "limit", "limit_value", "source", "status", "sense", "met")
        found = [{key: verdict.get(key) for key in keys} for verdict in self.run.get("verdicts", [])]
        return [verdict | {"met": None if verdict["met"] is None else bool(verdict["met"])} for verdict in found]

    def table(self, name: str, columns: tuple[str, ...] | None = None) -> pd.DataFrame:
        """Return a table with all or some of its columns; an empty one where the run has none.

        A table of another kind than asked for last goes.
        """
        key = f"{name} {columns}"
        if key not in self._tables:
            frame = self.results.table(name, columns) if name in self.results.tables else pd.DataFrame()
            self._tables = {key: frame}  # a day of trains with all columns takes half a gigabyte
        return self._tables[key]

    @cached_property
    def places(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Key figures by place, then by name."""
        found: dict[str, dict[str, dict[str, Any]]] = {}
        for figure in self.results.key_figures:
            found.setdefault(figure.get("place") or "", {})[figure["name"]] = figure
        return found

    def value(self, place: str, name: str) -> float | None:
        """Return the value of a key figure, None where there is none."""
        figure = self.places.get(place, {}).get(name)
        return None if figure is None else figure["value"]

    def when(self, place: str, name: str) -> str:
        """Return the time of a key figure as it is written."""
        return str(self.places.get(place, {}).get(name, {}).get("time") or "")


class CaseFacts(Computed):
    """A run of a case of train dynamics, of either kind, as the sheets ask for it."""

    def __init__(self, results: Results, scenario: DynamicsScenario | StationsCase) -> None:
        super().__init__(results)
        self._case_name = scenario.name

    @property
    def name(self) -> str:
        """Name of the case."""
        return self._case_name or super().name

    @property
    def study(self) -> str:
        """Name of the case."""
        return self.name

    @property
    def time_heading(self) -> str:
        """What times are called: they count from the start of the case."""
        return mark("time since the start")


class Facts(Computed):
    """A run and its scenario, as the sheets ask for them."""

    def __init__(self, results: Results, scenario: Scenario) -> None:
        super().__init__(results)
        self.scenario = scenario

    @property
    def name(self) -> str:
        """Name of the study, whatever part of it this is."""
        return self.scenario.name or super().name

    @property
    def study(self) -> str:
        """Name of the study, and of what part of it."""
        return f"{self.name} ({self.part})" if self.part else self.name

    @property
    def input_hash(self) -> str:
        """Hash of the inputs."""
        return super().input_hash or self.scenario.input_hash

    @property
    def feasibility(self) -> dict[str, Any] | None:
        """The verdict on the timetable, if it was judged."""
        told: dict[str, Any] | None = self.run.get("feasibility")
        return told

    @property
    def ledgers(self) -> dict[str, dict[str, Any]]:
        """Ledgers of the run; those of trains only where there are trains."""
        told: dict[str, dict[str, Any]] = self.run.get("ledgers", {})
        return {name: ledger for name, ledger in told.items() if name == "electric" or ledger.get("train", "")}

    def limit(self, name: str) -> Limit | None:
        """Return a limit of the study's system."""
        return find_limit(self.scenario.limits, self.scenario.supply.system, name)

    @cached_property
    def lines(self) -> LinePlaces:
        """The lines with kilometres of their own."""
        selected = self.run.get("selection") or {}
        return LinePlaces(self.scenario, selected.get("from_km", -math.inf), selected.get("to_km", math.inf))

    @cached_property
    def runs(self) -> dict[str, TrainRun]:
        """The runs of the timetable by identifier."""
        return {run.id: run for run in self.scenario.runs}

    @cached_property
    def station_names(self) -> dict[str, str]:
        """Names of the stations by identifier."""
        return {station.id: station.name for station in self.scenario.line.stations}

    @cached_property
    def trains(self) -> list[dict[str, Any]]:
        """What became of each train, by identifier; where ``run.json`` does not tell, trains that have figures."""
        told = self.run.get("trains") or [
            {"train": place.removeprefix("train ")} for place in self.places if place.startswith("train ")
        ]
        return sorted(told, key=lambda train: str(train["train"]))
