"""The charts of a sweep: main figures over what is varied, with base and limit; else bars by case and clouds of points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, Line, bars, draw, scatter
from tractionpower.reporting.workbook.variants.axes import fit_axis, name_series, rooms_for_charts, show_points
from tractionpower.reporting.workbook.variants.sweep_cases import CASE, Cases, Cells, limit_cell
from tractionpower.reporting.workbook.variants.sweep_words import differing_figures, heading
from tractionpower.studies.sweep.cases import number_of

MOST_CHARTS = 8
MOST_LINES = 7
"""Values of the second key that have lines of their own."""

MOST_BARS = 40
"""Cases that bars are legible for."""

MOST_CLOUDS = 4
"""Numbers that are varied and have clouds of points."""

BASE, LIMIT = mark("base"), mark("limit")


@dataclass(frozen=True, slots=True)
class Grid:
    """A grid of one or two keys: what stands along the axis, what has lines of its own, and the case of each pair."""

    along: str
    across: str | None
    x: tuple[str, ...]
    lines: tuple[str, ...]
    case: dict[tuple[str, str], int]


def add_charts(book: Book, data: SweepData, cases: Cases, cells: Cells, variants: Block) -> None:
    """Add the sheet of charts, of the figures that differ."""
    names = [name for name in differing_figures(data) if name in cells.ranges][:MOST_CHARTS]
    if not names:
        return
    page = book.page("Charts", "Charts: figures of the variants")
    grid = grid_of(data, cases)
    if grid is not None:
        _over_grid(page, data, cases, cells, (names, grid))
        return
    shown = [name for name in names if name in variants.keys][: MOST_CHARTS // 2]
    charts = [_by_case(variants, cases, name) for name in shown]
    numeric = [k for k, path in enumerate(data.changes.columns) if _is_spread(data, cases, path)] if len(data.paths) <= 5 else []
    for k in numeric[:MOST_CLOUDS]:
        charts += [_cloud(variants, cases, (data.names[data.paths[k]], k), name) for name in shown[:2]]
    for chart, room in zip(charts, rooms_for_charts(page, len(charts)), strict=True):
        page.chart(chart, room)


def grid_of(data: SweepData, cases: Cases) -> Grid | None:
    """Return the grid that the cases make; None where more than two things are varied, or values are drawn."""
    paths = data.paths
    if not 1 <= len(paths) <= 2 or data.run["sweep"].get("sample"):
        return None
    order = sorted(paths, key=lambda path: (not _numbers(data.keys[path]), -len(data.keys[path])))
    along, across = order[0], order[1] if len(order) > 1 else None
    lines = tuple(data.keys[across]) if across else ("",)
    found: dict[tuple[str, str], int] = {}
    for number, row in enumerate(cases.rows):
        own = data.changes.loc[row["case"]] if row["case"] in data.changes.index else {}
        x, line = own.get(along), own.get(across) if across else ""
        if row["case"] in cases.words and isinstance(x, str) and isinstance(line, str):
            key = x, line
            if key in found:
                return None
            found[key] = number
    shown = tuple(value for value in data.keys[along] if any((value, line) in found for line in lines))
    return Grid(along, across, shown, lines, found) if len(shown) > 1 and len(lines) <= MOST_LINES else None


def _numbers(values: Sequence[str]) -> bool:
    return all(number_of(value) is not None for value in values)


def _is_spread(data: SweepData, cases: Cases, path: str) -> bool:
    """Return whether the cases that have figures have several numbers for a path."""
    own = data.changes[path][data.changes.index.isin(list(cases.words))].dropna()
    return own.nunique() > 1 and _numbers(list(own))


def _over_grid(page: Page, data: SweepData, cases: Cases, cells: Cells, told: tuple[list[str], Grid]) -> None:
    """Draw each figure over the first key, a line for each value of the second, with a table of what is drawn below."""
    names, grid = told
    rooms = rooms_for_charts(page, len(names))
    is_number = _numbers(grid.x)
    for name, room in zip(names, rooms, strict=True):
        page.section(tr(heading(name)))
        lines = [data.setting(grid.across, line, short=True) if grid.across else "" for line in grid.lines]
        columns = [Column(data.names[grid.along], "any", 24, "x")]
        columns += [Column(line or tr(heading(name)), "0.0", key=f"line{k}") for k, line in enumerate(lines)]
        check = next((check for check in cases.checks if check.figure == name and check.value), None)
        columns += [Column(BASE, "0.0", key="base"), *([Column(LIMIT, "0.0", key="limit")] if check else [])]
        block = page.table(columns, _grid_rows(cases, cells, grid, name))
        words = [*lines, tr(BASE), *([tr(LIMIT)] if check else [])]
        keys = [column.key for column in columns[1:]]
        y = title = tr(heading(name))
        if grid.across:
            title = tr("{figure}, by {input}", figure=y, input=data.names[grid.across])
        chart = _lines(block, (title, y, data.names[grid.along]), keys, words, is_number=is_number)
        known = [value for row in cases.rows if (value := cases.value(row, name)) is not None]
        fit_axis(chart.y_axis, known, from_zero=not is_number and not name.endswith("_v"))
        if is_number:
            fit_axis(chart.x_axis, [number_of(value) or 0.0 for value in grid.x])
        page.chart(chart, room)


def _grid_rows(cases: Cases, cells: Cells, grid: Grid, name: str) -> Iterator[list[Any]]:
    base = cases.value(cases.rows[0], name) if cases.rows[0]["kind"] == "base" else None
    check = next((check for check in cases.checks if check.figure == name and check.value), None)
    for value in grid.x:
        number = number_of(value)
        line: list[Any] = [value if number is None else number]
        for other in grid.lines:
            at = grid.case.get((value, other))
            found = None if at is None else cases.value(cases.rows[at], name)
            line.append(None if found is None else Formula(cells.of(name, at), found))
        line.append(None if base is None else Formula(cells.of(name, 0), base))
        yield [*line, *([Formula(limit_cell(check), check.value)] if check else [])]


def _lines(block: Block, titles: tuple[str, str, str], keys: Sequence[str], words: Sequence[str], *, is_number: bool) -> Any:
    """Return the chart of a table: lines with points over numbers, bars over texts."""
    title, y, x = titles
    if not is_number:
        own = [key for key in keys if key.startswith("line")]
        chart = bars(title, y, block, "x", own)
        name_series(chart, [word or y for word in words])
        return chart
    chart = scatter(title, x, y)
    for number, (key, word) in enumerate(zip(keys, words, strict=True)):
        is_line = key.startswith("line")
        colour = COLOURS[number % len(COLOURS)] if is_line else "CC0000" if key == "limit" else "777777"
        dashes = DASHES[number // len(COLOURS)] if is_line else "dash" if key == "limit" else "sysDot"
        draw(chart, block, Line(word or y, "x", key, block.first, block.last, colour, dashes))
        if is_line:
            show_points(chart.series[-1], number, colour)
    return chart


def _by_case(variants: Block, cases: Cases, name: str) -> Any:
    """Return bars of a figure, one for each case: of many the first."""
    last = min(variants.last, variants.first + MOST_BARS - 1)
    some = Block(variants.sheet, variants.first, last, variants.headings, variants.keys)
    title = tr(heading(name))
    if last < variants.last:
        title = tr("{figure}: the first {count} of {all} cases", figure=title, count=MOST_BARS, all=len(cases.rows))
    chart = bars(title, tr(heading(name)), some, "case", [name])
    chart.x_axis.title = tr(CASE)
    known = [value for row in cases.rows if (value := cases.value(row, name)) is not None]
    fit_axis(chart.y_axis, known, from_zero=not name.endswith("_v"))
    return chart


def _cloud(variants: Block, cases: Cases, key: tuple[str, int], name: str) -> Any:
    """Return points of a figure over a number that is varied; the base, which sets nothing, has none."""
    words, number = key
    chart = scatter(tr("{figure} over {input}", figure=tr(heading(name)), input=words), words, tr(heading(name)), legend=False)
    x = variants.headings[len(cases.columns) + number]
    draw(chart, variants, Line(name, x, name, variants.first + 1, variants.last, COLOURS[0]))
    show_points(chart.series[-1], 0, COLOURS[0], line=False)
    own = [cases.data.changes.loc[row["case"]].iloc[number] for row in cases.rows[1:] if row["case"] in cases.words]
    fit_axis(chart.x_axis, [value for text in own if isinstance(text, str) and (value := number_of(text)) is not None])
    fit_axis(chart.y_axis, [value for row in cases.rows if (value := cases.value(row, name)) is not None])
    return chart
