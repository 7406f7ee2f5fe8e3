"""The tables of a sweep: cases with their figures, what they violate, where and when."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from openpyxl.formatting.rule import FormulaRule
from openpyxl.styles import Font

from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.facts.input_words import value_in_words
from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.acceptance import colour_words
from tractionpower.reporting.workbook.common.accepted import BY_LIMIT, MET, OPEN, VIOLATED, Accepted
from tractionpower.reporting.workbook.common.verdicts import Comparison
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.variants.sweep_cases import Cases, Cells, limit_cell, shade, tolerances_of
from tractionpower.reporting.workbook.variants.sweep_words import (
    STATUSES,
    heading,
    higher_is_better,
    main_figures,
    shown_figures,
    style_of,
)
from tractionpower.results.verdicts import AT_LEAST, AT_MOST
from tractionpower.studies.cases.judgement import Check
from tractionpower.studies.sweep.cases import number_of
from tractionpower.studies.sweep.differences import NOT_JUDGED

PLACES = {
    "lowest_voltage_v": (
        ("lowest_voltage_track", mark("track of it"), "beside"),
        ("lowest_voltage_km", mark("at [km]"), "0.0"),
        ("lowest_voltage_s", mark("time of day of it"), "time"),
    ),
    "useful_zone_v": (("useful_zone", mark("zone"), "beside"),),
    "useful_train_v": (("useful_train", mark("train"), "beside"),),
    "useful_zone_time_mean_v": (("useful_zone_time_mean", mark("zone, time mean"), "beside"),),
    "useful_train_time_mean_v": (("useful_train_time_mean", mark("train, time mean"), "beside"),),
    "worst_late_s": (("worst_late_train", mark("latest train"), "beside"),),
    "utilisation_percent": (("utilisation_device", mark("device"), "beside"),),
    "contract_share_percent": (("contract_point", mark("supply point"), "beside"),),
    "breaker_share_percent": (("breaker_device", mark("feeder"), "beside"),),
}
"""What stands beside a figure, with heading and style of its cells: where it came about, and when."""

MOST_PATHS = 5
"""Paths that have columns of their own; with more, a text tells what a case sets."""


def add_variants(book: Book, data: SweepData, cases: Cases, cells: Cells) -> Block:
    """Add the main sheet: a row for each case with what it sets, verdict, rank and main figures."""
    page = book.page("Variants", "Variants: what each case sets, and what came of it")
    page.note(
        "The base is the study as it is. A case sets the inputs whose values stand in its row; an empty cell leaves an input as"
        " it is in the base; in the base itself it is left out, or differs from item to item. Red is worse, green better; the"
        " best of each figure is bold and underlined."
    )
    if cases.by_ranking:
        page.note(
            tr(
                "Rank: fewest violated limits first; of equally many, by {figure}. The limits are on sheet Acceptance.",
                figure=tr(heading(cases.by_ranking)),
            )
        )
    paths, figures = list(data.changes.columns), main_figures(data)
    sets = [Column(data.names[path], _path_style(data, path), 22) for path in paths]
    if len(paths) > MOST_PATHS:
        sets = [Column("what it sets", "beside", 48)]
    odd = set(data.cases["status"]) != {"complete"}
    columns = [
        *cases.columns, *sets,
        *([Column("status", "beside", 12)] if odd else []),
        Column("verdict", "beside", 12, "verdict"), Column("limits violated", "0", key="violated"),
        *([Column("rank", "0", key="rank")] if cases.by_ranking else []),
        *(Column(heading(name), style_of(name), key=name) for name in figures),
        *([Column("reason", "beside", 44)] if odd else []),
    ]  # fmt: skip
    lines = (_case_row(cases, row, (paths, figures, number)) for number, row in enumerate(cases.rows))
    block = page.table(columns, ([*line] for line in lines), frozen=True)
    cells.define(book, page, block, "variants", figures)
    if cases.key != "case":
        book.define("variants_case", page, block.cells("case"))
    book.define("case_violated", page, block.cells("violated"))
    colour_words(page.sheet, block.cells("verdict"))
    for name in figures:
        shade(block, name, name)
        _mark_best(block, name)
    if cases.by_ranking:
        area = block.cells("rank")
        first = FormulaRule(formula=[f"{area.split(':')[0]}=1"], font=Font(bold=True, underline="single"))
        page.sheet.conditional_formatting.add(area, first)
    return block


def _figure(row: Mapping[Any, Any], name: str) -> Any:
    return device_told(row[name]) if name in ("utilisation_device", "breaker_device") and row[name] else row[name]


def _case_row(cases: Cases, row: Mapping[Any, Any], told: tuple[list[str], list[str], int]) -> Iterator[Any]:
    paths, figures, number = told
    data, case = cases.data, row["case"]
    yield from cases.cells(number)
    own = data.of_base if row["kind"] == "base" else data.changes.loc[case] if case in data.changes.index else {}
    if len(paths) > MOST_PATHS:
        yield cases.subject(row)
    else:
        yield from (_value(own.get(path)) for path in paths)
    odd = set(data.cases["status"]) != {"complete"}
    if odd:
        yield tr(STATUSES.get(row["status"], row["status"]))
    count = cases.violated(case)
    if count is None:
        yield from (tr(OPEN), None)
    else:
        word = f'IF(ISNUMBER({{violated}}),IF({{violated}}>0,"{tr(VIOLATED)}","{tr(MET)}"),"{tr(OPEN)}")'
        yield Formula(word, tr(VIOLATED if count else MET))
        yield Formula(f"INDEX({{verdicts_count}},MATCH({{{cases.key}}},{{verdicts_{cases.key}}},0))", count)
    if cases.by_ranking:
        rank = cases.rank(row)
        yield None if rank is None else Formula(_rank_formula(cases.by_ranking), rank)
    yield from (cases.value(row, name) for name in figures)
    if odd:
        yield recorded(str(row["reason"]))


def _rank_formula(name: str) -> str:
    """Return the formula of the rank: one more than the cases that are better."""
    values, sign = f"{{case_{name}}}", ">" if higher_is_better(name) else "<"
    fewer, alike = "({case_violated}<{violated})", "({case_violated}={violated})"
    return f"1+SUMPRODUCT(ISNUMBER({values})*({fewer}+{alike}*({values}{sign}{{{name}}})))"


def _path_style(data: SweepData, path: str) -> str:
    return "general" if all(number_of(value) is not None for value in data.keys[path]) else "beside"


def _value(text: Any) -> Any:
    number = number_of(text) if isinstance(text, str) else None
    return number if number is not None else recorded(value_in_words(text)) if isinstance(text, str) else None


def add_figures(book: Book, data: SweepData, cases: Cases, cells: Cells) -> None:
    """Add the sheet of the other figures of the cases, and of where and when all figures came about."""
    page = book.page("All figures", "All figures of the cases, with where and when they came about")
    page.note("Figures of sheet Variants stand there; here is where they came about, and all others.")
    main, columns, names = main_figures(data), cases.columns, []
    for name in (*main, *(name for name in shown_figures(data) if name not in main)):
        if name not in main:
            columns.append(Column(heading(name), style_of(name), key=name))
            names.append(name)
        for beside, words, style in PLACES.get(name, ()):
            columns.append(Column(words, style, 18, beside))
            names.append(beside)
    lines = ([*cases.cells(number), *(_figure(row, name) for name in names)] for number, row in enumerate(cases.rows))
    block = page.table(columns, lines, frozen=True)
    cells.define(book, page, block, "figures", [name for name in names if name in shown_figures(data)])
    for name in names:
        if name in shown_figures(data):
            shade(block, name, name)


def add_verdicts(book: Book, cases: Cases, cells: Cells) -> None:
    """Add the sheet of verdicts: each case against each limit, by formulas."""
    page = book.page("Verdicts", "Verdicts: each case against each limit")
    page.note(
        "Formulas on the figures of the cases and the limits of sheet Acceptance: change a limit there, and the verdicts follow."
        " A case that changes a limit itself is held against its own."
    )
    names = [recorded(check.name) for check in cases.checks]
    columns = [
        *cases.columns, Column("limits violated", "0", key="count"),
        *(Column(name[:1].upper() + name[1:], "beside", key=f"check{k}") for k, name in enumerate(names)),
    ]  # fmt: skip
    block = page.table(columns, _verdict_rows(cases, cells), frozen=True)
    book.define(f"verdicts_{cases.key}", page, block.cells(cases.key))
    book.define("verdicts_count", page, block.cells("count"))
    for k in range(len(cases.checks)):
        colour_words(page.sheet, block.cells(f"check{k}"))
    _tell_acceptance(book, cases, cells)


def _verdict_rows(cases: Cases, cells: Cells) -> Iterator[list[Any]]:
    violated, met = (
        "+".join(f'({{check{k}}}="{tr(word)}")' for k in range(len(cases.checks))) or "0" for word in (VIOLATED, MET)
    )
    count = f'IF({violated}+{met}=0,"",{violated})'
    for number, row in enumerate(cases.rows):
        if row["case"] not in cases.words:
            continue
        words = cases.words[row["case"]]
        shown: list[Any] = [tr(word) for word in words]
        for k, (check, word) in enumerate(zip(cases.checks, words, strict=True)):
            if word and cases.is_own(row, k):
                text, instead = (_judged(check, cells.of(check.figure), tolerance) for tolerance in tolerances_of(check))
                shown[k] = Formula(text, tr(word), instead)
        yield [*cases.cells(number), Formula(count, words.count(VIOLATED) if any(words) else ""), *shown]


def _judged(check: Check, found: str, tolerance: str) -> str:
    """Return the formula of a verdict."""
    return Comparison(found, limit_cell(check), AT_LEAST if check.is_floor else AT_MOST, tolerance).verdict(BY_LIMIT)


def _tell_acceptance(book: Book, cases: Cases, cells: Cells) -> None:
    """Tell the sheet of acceptance the worst of all cases, where all are held against the limit of the base."""
    said = {verdict["name"]: verdict for verdict in book.facts.verdicts}
    for k, check in enumerate(cases.checks):
        verdict = said.get(check.name)
        values = [value for row in cases.rows if (value := cases.value(row, check.figure)) is not None]
        alike = all(cases.is_own(row, k) for row in cases.rows if row["case"] in cases.words)
        if verdict is None or verdict["limit_value"] != check.value or not alike or not values:
            continue
        function, worst = ("MIN", min(values)) if check.is_floor else ("MAX", max(values))
        found = Formula(f"{function}({{{cells.ranges[check.figure]}}})", worst)
        book.acceptance.append(
            Accepted(
                check.name, check.limit, check.value, check.unit, AT_LEAST if check.is_floor else AT_MOST, found,
                str(verdict["place"] or ""), str(verdict["time"] or ""), check.status, check.source, tolerance=check.tolerance,
            )
        )  # fmt: skip


def _mark_best(block: Block, name: str) -> None:
    """Let the best value of a column be bold, where not all are the same."""
    if name in NOT_JUDGED or block.last <= block.first:
        return
    area = f"${block.cell(name, block.first)[: -len(str(block.first))]}${block.first}"
    column = area.split("$")[1]
    area = f"${column}${block.first}:${column}${block.last}"
    first, function = block.cell(name, block.first), "MAX" if higher_is_better(name) else "MIN"
    formula = f"AND(ISNUMBER({first}),{first}={function}({area}),MIN({area})<MAX({area}))"
    rule = FormulaRule(formula=[formula], font=Font(bold=True, underline="single"))
    block.sheet.conditional_formatting.add(block.cells(name), rule)
