"""Outages as reports see them: the cases along the line, what each fails at, the worst of a case over the grid voltages."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.io.wording import counted
from tractionpower.model.limits import Limit, find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.results.results import Results
from tractionpower.studies.cases.judgement import SUBJECTS, Check, checks_of

KIND_WORDS = {
    "base": mark("nothing is out"),
    "unit": mark("rectifier unit"),
    "substation": mark("substation"),
    "feeder": mark("feeder"),
    "section_cabin": mark("section cabin"),
    "contact_line": mark("contact line"),
    "pair": mark("pair"),
    "variant": mark("variant"),
}
"""Kinds of cases in words, in the order of the sheets."""

KINDS_WORDS = {
    "base": mark("Nothing is out"),
    "unit": mark("Rectifier units"),
    "substation": mark("Substations"),
    "feeder": mark("Feeders"),
    "section_cabin": mark("Section cabins"),
    "contact_line": mark("Sections of contact line"),
    "pair": mark("Pairs of outages"),
    "variant": mark("Variants"),
}
GRIDS = ("normal", "low", "high")
GRID_WORDS = {
    "normal": mark("normal grid voltage"),
    "low": mark("low grid voltage"),
    "high": mark("high grid voltage"),
}
"""Grid voltages in words."""
COMPUTED = ("complete", "flagged")
NOT_COMPUTED = "not computed"

_OF = {**SUBJECTS, "lowest_voltage_v": "", "worst_late_s": "train {worst_late_train}"}
"""Of what the figure of a case is, in words."""

_KM = re.compile(r"km (-?[\d.]+)(?:\s*(?:-|–|to)\s*(-?[\d.]+))?")
_UNITS = re.compile(r"(\d+ of \d+)")


@dataclass(frozen=True)
class Failure:
    """What a case fails at: what is judged, in a word what is wrong, and how it stands."""

    what: str
    short: str
    words: str


def outcome_words(outages: int, failing: int, beyond_base: int) -> str:
    """Return how many outages fail, and how many of these at more than what fails with nothing out.

    >>> outcome_words(1, 0, 0), outcome_words(5, 1, 1)
    ('the one outage holds', '1 of 5 outages fails')
    >>> outcome_words(5, 4, 1)
    '4 of 5 outages fail, 1 of them at something that holds with nothing out'
    """
    if not outages:
        return "no outage was looked at"
    if not failing:
        return "the one outage holds" if outages == 1 else f"all {outages} outages hold"
    beyond = f", {beyond_base or 'none'} of them at something that holds with nothing out" if beyond_base < failing else ""
    return f"{failing} of {counted(outages, 'outage')} fail{'s' if failing == 1 else ''}{beyond}"


class Outages:
    """The cases of a study of outages.

    Parameters
    ----------
    results
        Tables ``cases``, ``case_*``, ``envelope``, ``device_envelope``; each may be missing.
    scenario
        The base, for limits and places.
    """

    def __init__(self, results: Results, scenario: Scenario) -> None:
        self.results, self.scenario = results, scenario
        self._read: dict[str, pd.DataFrame] = {}

    def table(self, name: str) -> pd.DataFrame:
        """Return a table; an empty one where there is none."""
        if name not in self._read:
            self._read[name] = self.results.table(name) if name in self.results.tables else pd.DataFrame()
        return self._read[name]

    @cached_property
    def places(self) -> LinePlaces:
        """What stands along each of the lines."""
        return LinePlaces(self.scenario)

    @cached_property
    def cases(self) -> pd.DataFrame:
        """All cases by kind, along the line, by grid voltage; ``words`` says what is out, ``at_km`` where (NaN: unknown)."""
        rows = self.table("cases").copy()
        if rows.empty:
            return rows
        for name in ("case", "kind", "subject", "mode", "grid", "status", "reason"):
            rows[name] = rows[name].astype(str)
        rows["words"] = [self.words(row) for row in rows.to_dict("records")]
        rows["at_km"] = [self.place(subject) for subject in rows["subject"]]
        kinds = {kind: number for number, kind in enumerate(KIND_WORDS)}
        grids = {grid: number for number, grid in enumerate(GRIDS)}
        rows = rows.assign(
            _kind=[kinds.get(kind, len(kinds)) for kind in rows["kind"]], _grid=[grids.get(grid, 3) for grid in rows["grid"]]
        )
        keys = ["_kind", "at_km", "subject", "mode", "_grid"]
        return rows.sort_values(keys, kind="stable").drop(columns=["_kind", "_grid"]).reset_index(drop=True)

    @staticmethod
    def words(row: Mapping[Any, Any]) -> str:
        """Return in words what is out in a case."""
        if row["kind"] == "base":
            return tr(KIND_WORDS["base"])
        if row["kind"] == "pair":
            parts = zip(row["subject"].split(" + "), row["mode"].split(" + "), strict=False)
            return tr(" and ").join(_out("", subject, mode) for subject, mode in parts) or str(row["case"])
        return _out(row["kind"], row["subject"] or row["case"], row["mode"])

    def place(self, subject: str) -> float:
        """Return the kilometre of what is out, not a number if its name does not tell."""
        supply = self.scenario.supply
        stations = {each.id: each.km for each in supply.substations} | {each.id: each.km for each in supply.section_cabins}
        named = [name for name in stations if subject == name or subject.startswith((f"{name} ", f"{name},"))]
        if named:
            return float(stations[max(named, key=len)])
        found = _KM.search(subject)
        if found is None:
            return float("nan")
        ends = [float(text.rstrip(".")) for text in found.groups() if text]
        return sum(ends) / len(ends)

    @cached_property
    def grids(self) -> list[str]:
        """The grid voltages that were looked at, normal first."""
        found = set(self.cases["grid"]) if len(self.cases) else set()
        return [grid for grid in GRIDS if grid in found] + sorted(found - set(GRIDS))

    @cached_property
    def by_id(self) -> dict[str, dict[str, Any]]:
        """The cases by identifier, None where a figure has no value."""
        return {str(row["case"]): _known(row) for row in self.cases.to_dict("records")}

    def told(self, case: str) -> str:
        """Return a case in words, with its grid voltage where that is not the normal one."""
        row = self.by_id.get(str(case))
        if row is None:
            return str(case)
        return row["words"] if row["grid"] in ("normal", "") else f"{row['words']}, {grid_told(row['grid'])}"

    def groups(self) -> Iterator[tuple[dict[str, Any], dict[str, dict[str, Any]]]]:
        """Yield each outage once, the base first: what is out, and its cases by grid voltage."""
        if self.cases.empty:
            return
        for _, rows in self.cases.groupby(["kind", "subject", "mode", "words"], sort=False, dropna=False):
            own = [self.by_id[str(case)] for case in rows["case"]]
            yield own[0], {row["grid"]: row for row in own}

    def limit(self, name: str) -> Limit | None:
        """Return a limit of the study's system."""
        return find_limit(self.scenario.limits, self.scenario.supply.system, name)

    @cached_property
    def added_s(self) -> dict[str, tuple[float, str]]:
        """Greatest lateness that a case adds to a train against its base [s], and the train."""
        rows = self.table("case_trains")
        if rows.empty:
            return {}
        known = rows[rows["added_late_s"].notna()]
        worst = known.loc[known.groupby(known["case"].astype(str))["added_late_s"].idxmax()]
        return {
            str(case): (float(seconds), str(train))
            for case, seconds, train in zip(worst["case"], worst["added_late_s"], worst["train"], strict=True)
        }

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """What the cases are held against."""
        return checks_of(self.scenario)

    def failures(self, case: Mapping[str, Any]) -> list[Failure]:
        """Return what a case fails at; none for one that holds. One that was not computed fails at that."""
        if case["status"] not in COMPUTED:
            reason = " ".join(str(case["reason"]).split())
            status = recorded(str(case["status"]))
            words = f"{status}: {reason}" if reason else status
            return [Failure(NOT_COMPUTED, words, words)]
        return [Failure(check.name, check.word, _missed(check, case)) for check in self.checks if not check.is_met(case)]

    def is_worse(self, case: Mapping[str, Any]) -> bool:
        """Return whether an outage fails at something that holds with nothing out at the same grid voltage."""
        base = next((row for row in self.by_id.values() if row["kind"] == "base" and row["grid"] == case["grid"]), None)
        known = set() if base is None else {failure.what for failure in self.failures(base)}
        return any(failure.what not in known for failure in self.failures(case))

    def failing(self) -> dict[str, list[tuple[str, str]]]:
        """Return for each thing that outages fail at the cases with it, the worst first, each with how it stands in words."""
        found = {}
        rows = [row for row in self.by_id.values() if row["kind"] != "base" and row["status"] in COMPUTED]
        for check in self.checks:
            missed = [row for row in rows if not check.is_met(row)]
            missed.sort(key=lambda row, check=check: row[check.figure] if check.is_floor else -row[check.figure])  # type: ignore[misc]
            if missed:
                found[check.name] = [(row["case"], _missed(check, row)) for row in missed]
        return found

    @property
    def tolerance_s(self) -> float:
        """Lateness that is accepted [s]."""
        return self.scenario.feasibility.tolerance_s


def grid_told(grid: str) -> str:
    """Return a grid voltage in words.

    >>> grid_told("low")
    'low grid voltage'
    """
    return tr(GRID_WORDS[grid]) if grid in GRID_WORDS else tr("grid voltage {name}", name=grid)


def _missed(check: Check, case: Mapping[str, Any]) -> str:
    """Return in words how a limit is missed."""
    value, unit = case[check.figure], f" {check.unit}" if check.unit else ""
    of = _OF.get(check.figure, "").format(**case)
    shown = number(value, 0 if abs(value - check.value) >= 1.0 else 1, bare=False)
    if not unit:
        return tr("{value}, permitted {limit}", value=shown, limit=_limit(check))
    told = {"value": f"{shown}{unit}{f' ({device_told(of)})' if of else ''}", "limit": f"{_limit(check)}{unit}"}
    return tr("{value}, below {limit}", **told) if check.is_floor else tr("{value}, above {limit}", **told)


def _limit(check: Check) -> str:
    return number(check.value, 6)


def _out(kind: str, subject: str, mode: str) -> str:
    """Return in words what is out, by the columns of table ``cases``.

    >>> _out("unit", "Psary unit", "1 of 2"), _out("contact_line", "track 1 km 0-9", "dead")
    ('Psary, 1 of 2 units', 'contact line track 1 km 0-9')
    """
    if subject.endswith(" unit"):
        left = recorded(_UNITS.sub(r"\1 units", mode, count=1)) if _UNITS.search(mode) else tr("only unit out")
        return f"{subject.removesuffix(' unit')}, {left}"
    words = KIND_WORDS.get(kind, kind) if kind not in ("", "variant") else ""
    told = not words or subject.casefold().startswith(tuple(words.split()))
    named = recorded(subject) if told else f"{tr(words)} {recorded(subject)}"
    state = recorded(mode.replace("_", " "))
    return f"{named}, {state}" if state and state != "dead" else named


def _known(row: Mapping[Any, Any]) -> dict[str, Any]:
    return {str(key): None if pd.isna(value) else value for key, value in row.items()}


def worst(cases: Sequence[Mapping[str, Any]], name: str, *, lowest: bool = False) -> Mapping[str, Any] | None:
    """Return the case with the highest, or lowest, value of a figure; None if no case has one."""
    known = [case for case in cases if np.isfinite(_number(case, name))]
    if not known:
        return None
    return min(known, key=lambda case: _number(case, name)) if lowest else max(known, key=lambda case: _number(case, name))


def _number(case: Mapping[str, Any], name: str) -> float:
    value = case.get(name)
    return float("nan") if value is None or pd.isna(value) else float(value)
