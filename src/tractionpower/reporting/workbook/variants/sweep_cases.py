"""The cases of a sweep as its sheets tell them: verdicts and ranks, and where their figures stand in the workbook."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from openpyxl.formatting.rule import ColorScaleRule

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common.accepted import LEAST_TOLERANCE, MET, VIOLATED, tolerance_name
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.variants.sweep_words import (
    higher_is_better,
    ranking_figure,
    shown_figures,
)
from tractionpower.studies.cases.judgement import Check, checks_of
from tractionpower.studies.sweep.differences import NOT_JUDGED

NUMBER, CASE = "no.", "case"

_SEARCHED = re.compile(r'[*?~"{}]|^[=<>]|^$|.{200}')
"""Names that formulas would not find as they are written."""

_SHARED = ("useful voltage", "high voltage")
"""Words of what is violated that several checks share."""


class Cases:
    """The cases with what they violate and how they rank, by the figures that the workbook shows.

    Attributes
    ----------
    rows
        The cases, the base first.
    checks
        Limits of the base that a case with figures can be held against.
    words
        For each case with figures the verdict on each of the checks.
    key
        Column by which formulas find a case: ``case``, its name, or ``no``.
    """

    def __init__(self, data: SweepData) -> None:
        self.data = data
        self.rows: list[dict[Any, Any]] = data.cases.to_dict("records")
        shown = shown_figures(data)
        self.checks = [check for check in checks_of(data.scenario) if check.figure in shown]
        measured = set(data.measured["case"])
        self.words = {row["case"]: [_word(check, row) for check in self.checks] for row in self.rows if row["case"] in measured}
        self.by_ranking = ranking_figure(data)
        names = [self.name(row).casefold() for row in self.rows]
        plain = len(set(names)) == len(names) and not any(_SEARCHED.search(name) for name in names)
        self.key = "case" if plain else "no"

    def name(self, row: Mapping[Any, Any]) -> str:
        """Return what a case is called in the language of the report."""
        return tr("base") if row["kind"] == "base" else str(row["case"])

    def literal(self, number: int) -> str:
        """Return what formulas find a case by, from its number."""
        return f'"{self.name(self.rows[number])}"' if self.key == "case" else str(number)

    @property
    def columns(self) -> list[Column]:
        """The first columns of a table of cases; a number only where formulas cannot find a case by its name."""
        return [Column(CASE, "any", 18, "case"), *([] if self.key == "case" else [Column(NUMBER, "0", key="no")])]

    def cells(self, number: int) -> list[Any]:
        """Return what stands in the first columns for a case."""
        return [self.name(self.rows[number]), *([] if self.key == "case" else [number])]

    def subject(self, row: Mapping[Any, Any]) -> str:
        """Return in words what a case sets."""
        return tr("nothing is changed") if row["kind"] == "base" else self.data.subject(str(row["case"])) or str(row["subject"])

    def violated(self, case: str) -> int | None:
        """Return how many limits a case violates, None for one without figures that are judged."""
        words = self.words.get(case, [])
        return words.count(VIOLATED) if any(words) else None

    def value(self, row: Mapping[Any, Any], name: str) -> float | None:
        """Return a figure of a case as it is shown, None where it has none."""
        value = row[name]
        return None if row["case"] not in self.words or value is None or math.isnan(value) else float(value)

    def is_own(self, row: Mapping[Any, Any], number: int) -> bool:
        """Return whether a verdict follows from the limit of the base; a case that changes limits has others."""
        check, word = self.checks[number], self.words[row["case"]][number]
        return word == _word(check, row, told=False)

    def rank(self, row: Mapping[Any, Any]) -> int | None:
        """Return the rank of a case, from 1."""
        own = self._key(row)
        return None if own is None else 1 + sum(key < own for key in map(self._key, self.rows) if key is not None)

    def _key(self, row: Mapping[Any, Any]) -> tuple[int, float] | None:
        value = self.value(row, self.by_ranking) if self.by_ranking else None
        if self.by_ranking is None or value is None:
            return None
        return self.violated(row["case"]) or 0, -value if higher_is_better(self.by_ranking) else value


@dataclass
class Cells:
    """Where the figures of the cases stand: names of their ranges, and of the cases beside them."""

    cases: Cases
    ranges: dict[str, str] = field(default_factory=dict)
    beside: dict[str, str] = field(default_factory=dict)

    def define(self, book: Book, page: Page, block: Block, sheet: str, figures: Sequence[str]) -> None:
        """Name the columns of a block that holds all cases."""
        key = self.cases.key
        beside = book.define(f"{sheet}_{key}", page, block.cells(key))
        for name in figures:
            self.ranges[name] = book.define(f"case_{name}", page, block.cells(name))
            self.beside[name] = beside

    def of(self, name: str, number: int | None = None) -> str:
        """Return the part of a formula that finds a figure of a case by its number; None: of that of the same row."""
        case = f"{{{self.cases.key}}}" if number is None else self.cases.literal(number)
        return f"INDEX({{{self.ranges[name]}}},MATCH({case},{{{self.beside[name]}}},0))"


def _word(check: Check, row: Mapping[Any, Any], *, told: bool = True) -> str:
    """Return the verdict on a case: as the study told it, or else by the limit of the base."""
    value = row[check.figure]
    if value is None or math.isnan(value):
        return ""
    by_limit = check.is_met({check.figure: float(value)})
    fails = str(row.get("fails") or "").split(", ")
    is_known = told and not (check.word in fails and check.word in _SHARED)
    is_met = check.word not in fails if is_known else by_limit
    return MET if is_met else VIOLATED


def limit_cell(check: Check) -> str:
    """Return the place of a limit in a formula."""
    return f"{{limit_{check.limit}}}"


def tolerances_of(check: Check) -> tuple[str, str]:
    """Return the tolerance of a limit in a formula: its cell on the sheet of acceptance, and the number for a book without it."""
    value = f"{check.tolerance:g}"
    if check.tolerance < LEAST_TOLERANCE:  # one of rounding, which all verdicts have
        return "0", "0"
    return f"{{{tolerance_name(f'limit_{check.limit}')}}}", value


def shade(block: Block, key: str, name: str) -> None:
    """Shade a column from good to bad; energy, which is neither, stays as it is."""
    if name in NOT_JUDGED or block.last <= block.first:
        return
    low, high = (RED_FILL, GREEN_FILL) if higher_is_better(name) else (GREEN_FILL, RED_FILL)
    ends = {"start_type": "min", "start_color": low, "end_type": "max", "end_color": high}
    rule = ColorScaleRule(mid_type="percentile", mid_value=50, mid_color=AMBER_FILL, **ends)
    block.sheet.conditional_formatting.add(block.cells(key), rule)
