"""The sheet of outages: what is out, whether it holds, and the worst of its cases, by formulas on the sheets of all cases."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.accepted import OPEN
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.rules import Rule
from tractionpower.reporting.workbook.outages import outage_cases, outage_heat
from tractionpower.reporting.workbook.outages.case_figures import figure_of, grid_in_words, limit_name, range_name
from tractionpower.reporting.workbook.outages.outage_cases import LIMIT_WORDS, SHEETS
from tractionpower.reporting.workbook.outages.outage_reasons import WORSE, Reasons, span
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    YES,
    Bound,
    banner,
    bound_line,
    colour_red,
    colour_use,
    colour_word,
    judged,
    known,
    sentence,
)

Case = Mapping[str, Any]

BANNER = "outages_banner"
"""Name of the cell that says how many outages fail."""

WORSE_RANGE = "outages_worse"
"""Name of the range that says of each outage whether it fails at more than nothing out does."""

_MIN, _MAX = "MIN", "MAX"
_FIGURES = (
    (mark("lowest mean useful voltage of a zone [V]"), "0", "useful_zone_v", _MIN),
    (mark("lowest mean useful voltage of a train [V]"), "0", "useful_train_v", _MIN),
    (mark("highest utilisation [%]"), "0.0", "utilisation_percent", _MAX),
    (mark("devices beyond their rating"), "0", "overloaded", _MAX),
    (mark("late trains"), "0", "late_trains", _MAX),
    (mark("stuck trains"), "0", "stuck_trains", _MAX),
    (mark("trips"), "0", "trips", _MAX),
    (mark("greatest rail potential [V]"), "0", "rail_potential_v", _MAX),
)
"""Columns: heading, format, figure and which of its values over the grid voltages is the worst."""


@dataclass(frozen=True)
class _Group:
    """An outage: its cases by grid voltage, and the first and the last of their rows among all cases."""

    first: Case
    cases: Mapping[str, Case]
    rows: tuple[int, int]


def add(book: Book, outages: Outages) -> None:
    """Add the sheet of outages, that of heat, and those of all cases."""
    page = book.page("Outages", "Outages: what is out, and what becomes of voltages, devices and trains")
    outage_heat.add(book, outages)
    outage_cases.add(book, outages)
    head = page.next
    page.next += 1  # for the banner
    limits = {
        check.limit: bound_line(page, tr(LIMIT_WORDS[check.limit]), (check.limit, check.value, check.unit), check.tolerance)
        for check in _limits(outages)
    }
    page.note(
        "A row for each outage, with the worst of all grid voltages where none is named; grouped by kind, along the line. An"
        " outage holds if no limit of the voltage, no rating and no tolerance of lateness is passed and all its cases were"
        " computed; trips of breakers count as failures. Sheets Outage voltages, Outage loads and Outage trains have every"
        " grid voltage, What fails the reasons in words."
    )
    groups = _groups(outages)
    columns = _columns(outages)
    reasons = Reasons(book, outages)
    rows = [_row(reasons, group, columns) for group in groups]
    block = page.table(columns, rows, frozen=True)
    colour_word(block, HOLDS)
    _colour(book, block, limits, outages)
    end, page.next = page.next, head
    _banner(page, outages, block, groups)
    page.next = end
    book.define(WORSE_RANGE, page, block.cells("worse"))


def _limits(outages: Outages) -> list[Any]:
    """Return one check for each limit that columns of this sheet are coloured by."""
    figures = ("lowest_voltage_v", "useful_zone_v", "utilisation_percent")
    return [check for figure in figures for check in outages.checks if check.figure == figure and _has(outages, figure)]


def _has(outages: Outages, figure: str) -> bool:
    return any(figure_of(case, figure) is not None for case in outages.by_id.values())


def _groups(outages: Outages) -> list[_Group]:
    order = {case: number for number, case in enumerate(outages.by_id, 1)}
    found = []
    for first, cases in outages.groups():
        rows = [order[case["case"]] for case in cases.values()]
        found.append(_Group(first, cases, (min(rows), max(rows))))
    return found


def _columns(outages: Outages) -> list[Column]:
    grids = [
        Column(tr("lowest voltage, {grid} grid [V]", grid=grid_in_words(grid)), "0", key=f"volts_{grid}")
        for grid in outages.grids
    ]
    if len(grids) == 1:
        grids = [Column("lowest voltage [V]", "0", key=f"volts_{outages.grids[0]}")]
    return [
        Column("what is out", widest=44, key="words"),
        Column("kind", widest=20, key="kind"),
        Column(HOLDS, "beside", key=HOLDS),
        Column("why, and at which grid voltage", widest=60, key="why"),
        Column(WORSE, "beside", 12, key="worse"),
        *grids,
        *(Column(words, style, key=figure) for words, style, figure, _ in _FIGURES if _has(outages, figure)),
        Column("added delay, at most [s]", "0", key="added"),
        Column("train that is delayed most", "beside", 18, key="train"),
    ]


def _row(reasons: Reasons, group: _Group, columns: Sequence[Column]) -> list[Any]:
    outages, first, (low, high) = reasons.outages, group.first, group.rows
    by_grid = {case["grid"]: row for row, case in enumerate(outages.by_id.values(), 1) if low <= row <= high}
    computed = [case for case in group.cases.values() if case["status"] in COMPUTED]
    cells: dict[str, Any] = {
        "words": first["words"], "kind": tr(KINDS_WORDS.get(str(first["kind"]), str(first["kind"]))),
        "why": _why(reasons, group.cases, by_grid), "worse": _worse(outages, group), HOLDS: _holds(outages, group),
    }  # fmt: skip
    for grid in outages.grids:
        case = group.cases.get(grid)
        value = None if case is None else figure_of(case, "lowest_voltage_v")
        name = range_name("lowest_voltage_v")
        cells[f"volts_{grid}"] = Formula(f"INDEX({{{name}}},{by_grid[grid]})", value) if known(value) else None
    for _, _, figure, worst in _FIGURES:
        values = [value for case in computed if known(value := figure_of(case, figure))]
        found = (min if worst == _MIN else max)(values, default=None)
        cells[figure] = None if found is None else Formula(f"{worst}({span(figure, group.rows)})", found)
    added = max((outages.added_s[case["case"]] for case in computed if case["case"] in outages.added_s), default=(None, ""))
    cells["added"], cells["train"] = added if added[0] and added[0] > 0.0 else (added[0], "")
    return [cells[column.key] for column in columns]


def _holds(outages: Outages, group: _Group) -> Formula | str:
    """Return whether all cases of an outage hold on all sheets of cases."""
    sheets = [sheet.key for sheet in SHEETS if _is_judged(outages, sheet)]
    size = group.rows[1] - group.rows[0] + 1
    counts, opens = (
        "+".join(f'COUNTIF({span(f"{key}_hold", group.rows)},"{tr(word)}")' for key in sheets) for word in (YES, OPEN)
    )
    word = NO if any(map(outages.failures, group.cases.values())) else YES
    if size != len(group.cases) or not sheets:
        return tr(word)
    kept = f'IF({counts}=0,"{tr(OPEN)}","{tr(YES)}")'
    return judged(f'IF({counts}+{opens}={size * len(sheets)},{kept},"{tr(NO)}")', word, word)


def _is_judged(outages: Outages, sheet: Any) -> bool:
    figures = {column.key for column in sheet.columns if _has(outages, column.key)}
    return any(check.figure in figures for check in outages.checks)


def _worse(outages: Outages, group: _Group) -> Formula | str:
    """Return whether an outage fails at more than nothing out does, at some grid voltage."""
    if group.first["kind"] == "base":
        return ""
    word = tr(YES if any(map(outages.is_worse, group.cases.values())) else NO)
    if group.rows[1] - group.rows[0] + 1 != len(group.cases):
        return word
    return Formula(f'IF(COUNTIF({span("worse", group.rows)},"{tr(YES)}")>0,"{tr(YES)}","{tr(NO)}")', word)


def _why(reasons: Reasons, cases: Mapping[str, Case], by_grid: Mapping[str, int]) -> Formula:
    """Return what an outage fails at, and at which grid voltages, by the words of its cases."""
    every = [grid for grid in reasons.outages.grids if grid in cases]
    texts = {grid: str(getattr(told := reasons.short(cases[grid]), "value", told)) for grid in every}
    cells = {grid: f"INDEX({{{range_name('short')}}},{by_grid[grid]})" for grid in every}
    if len(reasons.outages.grids) == 1:
        return Formula(f'{cells[every[0]]}&""', texts[every[0]])
    pairs = ",".join(f"{cells[one]}={cells[other]}" for one, other in itertools.pairwise(every)) or "TRUE"
    first, suffix = cells[every[0]], f" ({tr('all')})"
    same = f'IF({first}="","",{first}&"{suffix}")'
    each = "&".join(f'IF({cells[grid]}="","","; {grid_in_words(grid)}: "&{cells[grid]})' for grid in every)
    shown = "; ".join(f"{grid_in_words(grid)}: {text}" for grid, text in texts.items() if text)
    if len(set(texts.values())) == 1:
        shown = f"{texts[every[0]]}{suffix}" if texts[every[0]] else ""
    return Formula(f"IF(AND({pairs}),{same},MID({each},3,1000))", shown)


def _colour(book: Book, block: Block, limits: Mapping[str, Bound], outages: Outages) -> None:
    floors = {check.figure: check for check in outages.checks if check.is_floor and check.limit in limits}
    for key in block.keys:
        figure = "lowest_voltage_v" if key.startswith("volts_") else key
        if key == "utilisation_percent" and key in limits:
            colour_use(block, key, limits[key].limit)
        elif figure in floors:
            check = floors[figure]
            colour_red(block, block.cells(key), limits[check.limit].beyond(is_floor=True))
        elif key in ("stuck_trains", "trips"):
            limit = limit_name(key)
            book.rules.append(Rule(block.sheet, block.cells(key), f"{{cell}}>{{{limit}}}", RED_FILL, {limit: 0.0}))
        elif key in ("late_trains", "overloaded"):  # counted with the limits of the run: red only where limits are passed now
            verdict = f"${block.cell(HOLDS, block.first)}"
            book.rules.append(Rule(block.sheet, block.cells(key), f'{{cell}}>0,{verdict}="{tr(NO)}"', RED_FILL))


def _banner(page: Page, outages: Outages, block: Block, groups: Sequence[_Group]) -> None:
    """Say how many outages fail, and how many of them at more than nothing out does; with that the table begins."""
    base = sum(group.first["kind"] == "base" for group in groups)
    many = len(groups) - base
    if not many:
        banner(page, tr("No outage was looked at"), "doubt", name=BANNER)
        return
    failing = sum(any(map(outages.failures, group.cases.values())) for group in groups[base:])
    area = f"$C${block.first + base}:$C${block.last}"
    count = f'COUNTIF({area},"{tr(NO)}")'
    worse = sum(any(map(outages.is_worse, group.cases.values())) for group in groups[base:])
    text = sentence(tr("{failing} of {all} outages fail"), failing=(count, failing), all=(str(many), many))
    more = sentence(
        tr(", {worse} of them at something that holds with nothing out"), worse=(f'COUNTIF({{{WORSE_RANGE}}},"{tr(YES)}")', worse)
    )
    shown = Formula(f'{text.text}&IF({count}>0,{more.text},"")', f"{text.value}{more.value if failing else ''}")
    banner(page, shown, "good", f"{count}>0", BANNER)
