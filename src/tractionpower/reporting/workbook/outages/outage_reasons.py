"""The sheet of what each case fails at: in words that follow the limits of the workbook, by formulas on the sheets of cases."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from decimal import ROUND_HALF_UP, Decimal
from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.facts.outages import COMPUTED, Outages
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.accepted import LEAST_TOLERANCE
from tractionpower.reporting.workbook.common.verdicts import ROUNDING, beyond
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.outages.case_figures import (
    DEVICES,
    FIRST,
    figure_of,
    grid_in_words,
    limit_name,
    range_name,
    tolerance_of,
)
from tractionpower.reporting.workbook.sizing.judging import NO, YES, known, sentence
from tractionpower.studies.cases.judgement import Check

Case = Mapping[str, Any]

WORSE = mark("at more than with nothing out")

_FAILS = (
    *FIRST,
    Column("status", "beside", key="status"),
    Column("fails at", widest=48, key="short"),
    Column("how it stands", widest=90, key="how"),
    Column(WORSE, "beside", 12, key="worse"),
    Column("reason", widest=40, key="reason"),
    Column("case", widest=48, key="case"),
)
_NAMED = {"words": "what is out", "grid": "grid voltage", "short": "short", "how": "how", "worse": "worse"}
"""Ranges of the sheet, by the end of their names, with the column of each."""

_OF = {
    "useful_zone_v": ("useful_zone", mark(" (zone {name})")),
    "useful_train_v": ("useful_train", mark(" (train {name})")),
    "worst_late_s": ("worst_late_train", mark(" (train {name})")),
    "utilisation_percent": ("utilisation_device", mark(" ({name})")),
    "contract_share_percent": ("contract_point", mark(" (supply point {name})")),
    "breaker_share_percent": ("breaker_device", mark(" ({name})")),
}
"""Of what the figure of a case is: the column with its name, and in words."""


def add(book: Book, outages: Outages) -> None:
    """Add the sheet, after those of the figures."""
    page = book.page("What fails", "What fails: every outage at every grid voltage")
    page.note(
        "The words follow the limits of sheet Acceptance. `tractionpower run STUDY` with the changes of table"
        " case_changes repeats a case with all its tables. A case that failed or was refused has no figures. Trips of"
        " breakers are failures where limits say so. 'At more than with nothing out': at a limit that is kept with"
        " nothing out at the same grid voltage."
    )
    has_reasons = any(case["reason"] for case in outages.by_id.values())
    columns = [column for column in _FAILS if has_reasons or column.key != "reason"]
    reasons = Reasons(book, outages)
    block = page.table(columns, (_told(reasons, case, columns) for case in outages.by_id.values()), frozen=True)
    for name, column in _NAMED.items():
        book.define(range_name(name), page, block.cells(column))
    _colour_status(block)


def _told(reasons: Reasons, case: Case, columns: Sequence[Column]) -> list[Any]:
    cells = {
        "status": recorded(case["status"]), "short": reasons.short(case), "how": reasons.how(case), "worse": reasons.worse(case),
        "reason": case["reason"], "case": case["case"],
    }  # fmt: skip
    first = [case["words"], grid_in_words(case["grid"])]
    return [*first, *(cells[column.key] for column in columns[len(first) :])]


class Reasons:
    """What cases fail at, as formulas on the sheets of cases.

    Parameters
    ----------
    book
        The workbook; checks whose figures it does not show judge nothing.
    outages
        The cases.
    """

    def __init__(self, book: Book, outages: Outages) -> None:
        self.names, self.outages = book.names, outages
        self.checks = [check for check in outages.checks if range_name(check.figure) in book.names]
        self.numbers = {case["case"]: number for number, case in enumerate(outages.by_id.values(), 1)}
        self._base = {case["grid"]: case for case in outages.by_id.values() if case["kind"] == "base"}

    def is_beyond(self, check: Check, case: Case) -> bool:
        """Return whether a case fails at a check, as the formulas have it."""
        return known(figure_of(case, check.figure)) and check.beyond(case) > check.tolerance + float(ROUNDING) * abs(check.value)

    def bound(self, check: Check) -> str:
        """Return the test that a number is beyond the limit of a check, by the names of the sheets of cases."""
        has_cell = check.tolerance >= LEAST_TOLERANCE
        tolerance = f"{{{tolerance_of(check.limit)}}}" if has_cell else f"{check.tolerance:g}".upper() if check.tolerance else ""
        return beyond(f"{{{limit_name(check.limit)}}}", tolerance, is_floor=check.is_floor)

    def test(self, check: Check, case: Case) -> str:
        """Return the formula that says whether a case fails at a check."""
        cell = self._cell(check.figure, case)
        return f"AND(ISNUMBER({cell}),{cell}{self.bound(check)})"

    def short(self, case: Case) -> Formula | str:
        """Return in a few words what a case fails at."""
        if case["status"] not in COMPUTED:
            return self.outages.failures(case)[0].short
        parts, found = [], []
        for word in dict.fromkeys(check.word for check in self.checks):
            own = [check for check in self.checks if check.word == word]
            tests = ",".join(self.test(check, case) for check in own)
            parts.append(f'IF(OR({tests}),", {_quoted(recorded(word))}","")')
            found += [recorded(word)] if any(self.is_beyond(check, case) for check in own) else []
        return Formula(f"MID({'&'.join(parts)},3,500)", ", ".join(found)) if parts else ""

    def how(self, case: Case) -> Formula | str:
        """Return what a case fails at with the figures and their limits."""
        if case["status"] not in COMPUTED:
            return ""
        parts, found = [], []
        for check in self.checks:
            if known(figure_of(case, check.figure)):
                told = self.sentence(check, case, self._cell(check.figure, case), str(self.numbers[case["case"]]))
                word = recorded(check.word)
                parts.append(f'IF({self.test(check, case)},"; {_quoted(word)}: "&{told.text},"")')
                found += [f"{word}: {told.value}"] if self.is_beyond(check, case) else []
        return Formula(f"MID({'&'.join(parts)},3,1000)", "; ".join(found)) if parts else ""

    def worse(self, case: Case) -> Formula | str:
        """Return whether an outage fails at a limit that is kept with nothing out at the same grid voltage."""
        base = self._base.get(case["grid"])
        if case["kind"] == "base":
            return ""
        if case["status"] not in COMPUTED or not self.checks:
            return tr(YES if self.outages.is_worse(case) else NO)
        tests, is_worse = [], False
        for check in self.checks:
            new = base is None or not self.is_beyond(check, base)
            tests.append(
                self.test(check, case) if base is None else f"AND({self.test(check, case)},NOT({self.test(check, base)}))"
            )
            is_worse |= self.is_beyond(check, case) and new
        return Formula(f'IF(OR({",".join(tests)}),"{tr(YES)}","{tr(NO)}")', tr(YES if is_worse else NO))

    def sentence(self, check: Check, case: Case, cell: str, row: str) -> Formula:
        """Return how a figure stands against its limit; `cell` is a formula of the figure, `row` of the number of its case."""
        value = float(case[check.figure])
        limit = f"{{{limit_name(check.limit)}}}"
        of: tuple[str, object] = ('""', "")
        column, words = _OF.get(check.figure, ("", ""))
        if column and case.get(column) and range_name(column) in self.names:
            told = sentence(
                tr(words),
                name=(f"INDEX({{{range_name(column)}}},{row})", device_told(case[column]) if column in DEVICES else case[column]),
            )
            of = (told.text, told.value)
        text = (
            tr("{value} {unit}{of}, below {limit} {unit}") if check.is_floor else tr("{value} {unit}{of}, above {limit} {unit}")
        )
        return sentence(
            text if check.unit else tr("{value}, permitted {limit}"),
            value=(f"ROUND({cell},IF(ABS({cell}-{limit})<1,1,0))", shown(value, 1 if abs(value - check.value) < 1.0 else 0)),
            unit=(f'"{_quoted(check.unit)}"', check.unit), of=of, limit=(limit, f"{check.value:.10g}"),
        )  # fmt: skip

    def _cell(self, figure: str, case: Case) -> str:
        return f"INDEX({{{range_name(figure)}}},{self.numbers[case['case']]})"


def shown(value: float, digits: int) -> str:
    """Return a number as a workbook writes it when it is rounded within a text.

    >>> shown(2.5, 0), shown(0.25, 1), shown(2.0, 1)
    ('3', '0.3', '2')
    """
    rounded = Decimal(repr(value)).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_UP)
    return f"{float(rounded):.15g}"


def spans(outages: Outages) -> tuple[int, int]:
    """Return the numbers of the first and of the last case with something out; those with nothing out come first."""
    base = sum(case["kind"] == "base" for case in outages.by_id.values())
    return base + 1, len(outages.by_id)


def span(name: str, rows: tuple[int, int]) -> str:
    """Return a part of a range of all cases."""
    area = f"{{{range_name(name)}}}"
    return f"INDEX({area},{rows[0]}):INDEX({area},{rows[1]})"


def failing(reasons: Reasons, check: Check) -> tuple[str, list[Case]]:
    """Return the formula that counts the outages' cases beyond a limit, and these cases."""
    area = span(check.figure, spans(reasons.outages))
    cases: Iterator[Case] = (case for case in reasons.outages.by_id.values() if case["kind"] != "base")
    return f"SUMPRODUCT(ISNUMBER({area})*({area}{reasons.bound(check)}))", [c for c in cases if reasons.is_beyond(check, c)]


def _quoted(text: str) -> str:
    return text.replace('"', '""')


def _colour_status(block: Block) -> None:
    for word in ("failed", "refused", "flagged"):
        rule = CellIsRule(operator="equal", formula=[f'"{recorded(word)}"'], fill=fill(RED_FILL))
        block.sheet.conditional_formatting.add(block.cells("status"), rule)
