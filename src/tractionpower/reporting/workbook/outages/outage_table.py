"""The sheet of outages: what is out, whether it holds, and the worst of its cases, by formulas on the sheets of all cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.outages import outage_cases, outage_heat
from tractionpower.reporting.workbook.outages.outage_cases import SHEETS, figure_of, grid_in_words, range_name
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    YES,
    banner,
    colour_red,
    colour_use,
    colour_word,
    judged,
    known,
    limit_line,
    sentence,
)

Case = Mapping[str, Any]

BANNER = "outages_banner"
"""Name of the cell that says how many outages fail."""

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
    head = page.next
    page.next += 1  # for the banner
    limits = {
        check.limit: limit_line(page, tr(words), check.limit, check.value, check.unit)
        for check, words in ((check, outage_cases.LIMIT_WORDS.get(check.limit, "")) for check in _limits(outages))
    }
    page.note(
        "A row for each outage, with the worst of all grid voltages where none is named; grouped by kind, along the line. An"
        " outage holds if no limit of the voltage, no rating and no tolerance of lateness is passed and all its cases were"
        " computed; trips of breakers count as failures. Sheets Outage voltages, Outage loads and Outage trains have every"
        " grid voltage, What fails the reasons in words."
    )
    groups = _groups(outages)
    columns = _columns(outages)
    block = page.table(columns, [_row(outages, group, columns) for group in groups], frozen=True)
    colour_word(block, HOLDS)
    _colour(block, limits, outages)
    end, page.next = page.next, head
    _banner(page, outages, block, groups)
    page.next = end
    outage_heat.add(book, outages)
    outage_cases.add(book, outages)


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
        *grids,
        *(Column(words, style, key=figure) for words, style, figure, _ in _FIGURES if _has(outages, figure)),
        Column("added delay, at most [s]", "0", key="added"),
        Column("train that is delayed most", "beside", 18, key="train"),
    ]


def _row(outages: Outages, group: _Group, columns: Sequence[Column]) -> list[Any]:
    first, (low, high) = group.first, group.rows
    by_grid = {case["grid"]: row for row, case in enumerate(outages.by_id.values(), 1) if low <= row <= high}
    computed = [case for case in group.cases.values() if case["status"] in COMPUTED]
    cells: dict[str, Any] = {
        "words": first["words"], "kind": tr(KINDS_WORDS.get(str(first["kind"]), str(first["kind"]))),
        "why": _why(outages, group.cases), HOLDS: _holds(outages, group),
    }  # fmt: skip
    for grid in outages.grids:
        case = group.cases.get(grid)
        value = None if case is None else figure_of(case, "lowest_voltage_v")
        name = range_name("lowest_voltage_v")
        cells[f"volts_{grid}"] = Formula(f"INDEX({{{name}}},{by_grid[grid]})", value) if known(value) else None
    for _, _, figure, worst in _FIGURES:
        values = [value for case in computed if known(value := figure_of(case, figure))]
        found = (min if worst == _MIN else max)(values, default=None)
        cells[figure] = None if found is None else Formula(f"{worst}({_span(figure, group.rows)})", found)
    added = max((outages.added_s[case["case"]] for case in computed if case["case"] in outages.added_s), default=(None, ""))
    cells["added"], cells["train"] = added if added[0] and added[0] > 0.0 else (added[0], "")
    return [cells[column.key] for column in columns]


def _span(figure: str, rows: tuple[int, int]) -> str:
    """Return the cells of a figure of the cases of an outage."""
    name = f"{{{range_name(figure)}}}"
    return f"INDEX({name},{rows[0]}):INDEX({name},{rows[1]})"


def _holds(outages: Outages, group: _Group) -> Formula | str:
    """Return whether all cases of an outage hold on all sheets of cases."""
    sheets = [sheet.key for sheet in SHEETS if _is_judged(outages, sheet)]
    size = group.rows[1] - group.rows[0] + 1
    counts = "+".join(f'COUNTIF({_span(f"{key}_hold", group.rows)},"{tr(YES)}")' for key in sheets)
    word = NO if any(map(outages.failures, group.cases.values())) else YES
    if size != len(group.cases) or not sheets:
        return tr(word)
    return judged(f'IF({counts}={size * len(sheets)},"{tr(YES)}","{tr(NO)}")', word, word)


def _is_judged(outages: Outages, sheet: Any) -> bool:
    figures = {column.key for column in sheet.columns if _has(outages, column.key)}
    return any(check.figure in figures for check in outages.checks)


def _why(outages: Outages, cases: Mapping[str, Case]) -> str:
    """Return what an outage fails at, and at which grid voltages."""
    found: dict[str, list[str]] = {}
    for grid, case in cases.items():
        for failure in outages.failures(case):
            grids = found.setdefault(recorded(failure.short), [])
            grids += [grid] if grid not in grids else []
    if len(outages.grids) == 1:
        return "; ".join(found)
    every = [grid for grid in outages.grids if grid in cases]
    words = {grid: grid_in_words(grid) for grid in every}
    return "; ".join(
        f"{what} ({tr('all') if grids == every else ', '.join(words[g] for g in grids)})" for what, grids in found.items()
    )


def _colour(block: Block, limits: Mapping[str, str], outages: Outages) -> None:
    floors = {check.figure: check for check in outages.checks if check.is_floor and check.limit in limits}
    for key in block.keys:
        figure = "lowest_voltage_v" if key.startswith("volts_") else key
        if key == "utilisation_percent" and key in limits:
            colour_use(block, key, limits[key])
        elif figure in floors:
            check = floors[figure]
            colour_red(block, block.cells(key), f"<{limits[check.limit]}-{check.tolerance:g}")
        elif key in ("late_trains", "stuck_trains", "trips", "overloaded"):
            colour_red(block, block.cells(key), ">0")


def _banner(page: Page, outages: Outages, block: Block, groups: Sequence[_Group]) -> None:
    """Say how many outages fail; the first rows of the table are those with nothing out."""
    base = sum(group.first["kind"] == "base" for group in groups)
    many = len(groups) - base
    if not many:
        banner(page, tr("No outage was looked at"), "doubt", name=BANNER)
        return
    failing = sum(any(map(outages.failures, group.cases.values())) for group in groups[base:])
    area = f"$C${block.first + base}:$C${block.last}"
    count = f'COUNTIF({area},"{tr(NO)}")'
    text = sentence(tr("{failing} of {all} outages fail"), failing=(count, failing), all=(str(many), many))
    banner(page, text, "good", f"{count}>0", BANNER)
