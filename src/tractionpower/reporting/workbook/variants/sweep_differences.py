"""What a sweep tells of its base: best and worst case by each figure, differences, by formulas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.variants.sweep_cases import Cases, Cells, shade
from tractionpower.reporting.workbook.variants.sweep_words import (
    differing_figures,
    heading,
    higher_is_better,
    style_of,
)
from tractionpower.studies.sweep.differences import NOT_JUDGED

AT_ONCE = 7
"""Figures with their per cent that fit on a printed page."""


def add_best(book: Book, data: SweepData, cases: Cases, cells: Cells) -> None:
    """Add the sheet of the best and the worst case by each figure."""
    page = book.page("Best and worst", "Best and worst case by each figure")
    page.note(
        "Formulas on the figures of the cases; of equal cases the first. Energy is neither better nor worse: trains that are"
        " slowed down by low voltage take less."
    )
    columns = (
        Column("figure", widest=40), Column("better is", widest=10), Column("base", "0.0", key="base"),
        Column("best", "0.0", key="best"), Column("best case", "beside", 18), Column("what it sets", "beside", 38),
        Column("worst", "0.0", key="worst"), Column("worst case", "beside", 18), Column("what the worst sets", "beside", 38),
        Column("spread, of the base [%]", "0.0"),
    )  # fmt: skip
    names = differing_figures(data)
    block = page.table(columns, (_best_row(cases, cells, name) for name in names), frozen=True)
    for name, row in zip(names, range(block.first, block.last + 1), strict=False):
        book.define(f"base_{name}", page, block.cell("base", row))


def _best_row(cases: Cases, cells: Cells, name: str) -> list[Any]:
    known = [(value, number) for number, row in enumerate(cases.rows) if (value := cases.value(row, name)) is not None]
    best, worst = (max, min) if higher_is_better(name) else (min, max)
    area = f"{{{cells.ranges[name]}}}"
    base = cases.value(cases.rows[0], name) if cases.rows[0]["kind"] == "base" else None
    better = tr("not judged") if name in NOT_JUDGED else tr("more") if higher_is_better(name) else tr("less")
    line: list[Any] = [tr(heading(name)), better, None if base is None else Formula(cells.of(name, 0), base)]
    ends = []
    for key, choose in (("best", best), ("worst", worst)):
        value = choose(value for value, _ in known)
        number = next(number for one, number in known if one == value)
        row = cases.rows[number]
        words = cases.name(row)
        function = "MAX" if choose is max else "MIN"
        case = f"INDEX({{variants_case}},MATCH({{{key}}},{area},0))"
        line += [Formula(f"{function}({area})", value), Formula(case, words), cases.subject(row)]
        ends.append(value)
    spread = None
    if base:
        spread = Formula("100*ABS({best}-{worst})/ABS({base})", 100 * abs(ends[0] - ends[1]) / abs(base))
    return [*line, spread]


def add_differences(book: Book, data: SweepData, cases: Cases, cells: Cells) -> None:
    """Add the sheet of differences from the base, by formulas: of the figures that differ in at least one case."""
    names = [name for name in differing_figures(data) if cases.value(cases.rows[0], name) is not None]
    if not names or cases.rows[0]["kind"] != "base":
        return
    for count, some in enumerate((names[k : k + AT_ONCE] for k in range(0, len(names), AT_ONCE)), 1):
        page = book.page(
            "Differences" if count == 1 else f"Differences {count}", "Differences of the figures from those of the base"
        )
        page.note("Value of the case less that of the base, and in per cent of that of the base; formulas on the other sheets.")
        columns = [*cases.columns, Column("what it sets", "beside", 44)]
        for name in some:
            columns.append(Column(heading(name), style_of(name), key=name))
            columns.append(Column(f"{tr(heading(name)).split(' [')[0]} [%]", "0.0"))
        lines = (_difference_row(cases, cells, some, number) for number in range(1, len(cases.rows)))
        block = page.table(columns, filter(None, lines), frozen=True)
        for name in some:
            shade(block, name, name)


def _difference_row(cases: Cases, cells: Cells, names: Sequence[str], number: int) -> list[Any]:
    row = cases.rows[number]
    if row["case"] not in cases.words:
        return []
    line: list[Any] = [*cases.cells(number), cases.subject(row)]
    for name in names:
        base, value = cases.value(cases.rows[0], name), cases.value(row, name)
        if base is None or value is None:
            line += [None, None]
            continue
        line.append(Formula(f"{cells.of(name)}-{{base_{name}}}", value - base))
        share = f"100*({cells.of(name)}-{{base_{name}}})/ABS({{base_{name}}})"
        line.append(Formula(share, 100 * (value - base) / abs(base)) if base else None)
    return line
