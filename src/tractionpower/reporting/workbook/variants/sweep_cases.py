"""The cases of a sweep as its sheets tell them: verdicts and ranks, and where their figures stand in the workbook."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from openpyxl.formatting.rule import ColorScaleRule

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common.acceptance import LEAST_TOLERANCE, MET, VIOLATED, tolerance_name
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL
from tractionpower.reporting.workbook.frame.page import Block, Page
from tractionpower.reporting.workbook.variants.sweep_words import (
    higher_is_better,
    ranking_figure,
    shown_figures,
)
from tractionpower.studies.cases.judgement import Check, checks_of
from tractionpower.studies.sweep.differences import NOT_JUDGED

NUMBER, CASE = "no.", "case"

_SHARED = ("useful voltage", "high voltage")
"""Words of what is violated that several checks share."""


@dataclass
class Cells:
    """Where the figures of the cases stand: names of their ranges, and of the numbers of the cases beside them."""

    ranges: dict[str, str] = field(default_factory=dict)
    numbers: dict[str, str] = field(default_factory=dict)

    def define(self, book: Book, page: Page, block: Block, sheet: str, figures: Sequence[str]) -> None:
        """Name the columns of a block that holds all cases."""
        numbers = book.define(f"{sheet}_no", page, block.cells("no"))
        for name in figures:
            self.ranges[name] = book.define(f"case_{name}", page, block.cells(name))
            self.numbers[name] = numbers

    def of(self, name: str, number: str = "{no}") -> str:
        """Return the part of a formula that finds a figure of the case whose number stands in a cell."""
        return f"INDEX({{{self.ranges[name]}}},MATCH({number},{{{self.numbers[name]}}},0))"


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
    """

    def __init__(self, data: SweepData) -> None:
        self.data = data
        self.rows: list[dict[Any, Any]] = data.cases.to_dict("records")
        shown = shown_figures(data)
        self.checks = [check for check in checks_of(data.scenario) if check.figure in shown]
        measured = set(data.measured["case"])
        self.words = {row["case"]: [_word(check, row) for check in self.checks] for row in self.rows if row["case"] in measured}
        self.by_ranking = ranking_figure(data)

    def violated(self, case: str) -> int | None:
        """Return how many limits a case violates, None for one without figures."""
        return self.words[case].count(VIOLATED) if case in self.words else None

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


def subject_of(row: Mapping[Any, Any]) -> str:
    """Return in short what a case sets."""
    return tr("nothing is changed") if row["kind"] == "base" else str(row["subject"])


def shade(block: Block, key: str, name: str) -> None:
    """Shade a column from good to bad; energy, which is neither, stays as it is."""
    if name in NOT_JUDGED or block.last <= block.first:
        return
    low, high = (RED_FILL, GREEN_FILL) if higher_is_better(name) else (GREEN_FILL, RED_FILL)
    ends = {"start_type": "min", "start_color": low, "end_type": "max", "end_color": high}
    rule = ColorScaleRule(mid_type="percentile", mid_value=50, mid_color=AMBER_FILL, **ends)
    block.sheet.conditional_formatting.add(block.cells(key), rule)
