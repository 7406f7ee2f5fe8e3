"""The sheet of acceptance: what was found against what is allowed, with limits that can be edited and verdicts that follow."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.accepted import (
    BY_LIMIT,
    MET,
    OPEN,
    VIOLATED,
    Accepted,
    accepted_rows,
    cell_names,
    comparison_of,
    digits_of,
    group_of,
    has_tolerance_cell,
    number_in,
    place_in_words,
    tolerance_name,
    word_by_numbers,
    word_of,
)
from tractionpower.reporting.workbook.common.verdicts import same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, limit_in_words
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.results.verdicts import AT_LEAST

COUNTS = {"acceptance_met": MET, "acceptance_violated": VIOLATED, "acceptance_open": OPEN}
"""Names of the cells that count the verdicts, with the word that they count."""

ALL = "acceptance_all"
"""Name of the cell that counts all rows."""

_SENSES = {"at_least": mark("not below"), "at_most": mark("not above")}

TIME = mark("time of day")

_COLUMNS = (
    Column("no.", "0"),
    Column("what is judged", "beside", 34),
    Column("found", "0.0", key="found"),
    Column("must be", "beside", 10),
    Column("limit value", "0.0", key="limit"),
    Column("unit", "beside", 8),
    Column("tolerance", "general", key="tolerance"),
    Column("margin", "0.0", key="margin"),
    Column("verdict", "beside", 12, key="verdict"),
    Column("group", widest=16),
    Column("place of the worst", widest=30),
    Column(TIME),
    Column("limit", widest=18),
    Column("status of the limit", widest=22),
    Column("source of the limit", widest=46),
)


def add(book: Book) -> None:
    """Add the sheet, as the second of the book, when all sheets that judge have told their rows; none without any rows."""
    rows = accepted_rows(book)
    if not rows:
        return
    page = book.page("Acceptance", "Acceptance: what was found against what is allowed")
    book.pages.insert(1, book.pages.pop())
    page.note(
        "Yellow cells can be edited: margins, verdicts and the cover follow. A limit whose status is not 'verified' is an"
        " editable value of the limits table: the check is against that value, which is no statement about a standard."
    )
    counts_row = _room_for_counts(page)
    columns = [replace(column, heading=book.computed.time_heading) if column.heading == TIME else column for column in _COLUMNS]
    block = page.table(columns, _lines(rows), frozen=True)
    _name_limits(book, page, block, rows)
    colour_words(block.sheet, block.cells("verdict"))
    book.define("acceptance_verdicts", page, block.cells("verdict"))
    for name, key in (("names", "what is judged"), ("found", "found"), ("limits", "limit")):
        book.define(f"acceptance_{name}", page, block.cells(key))
    _count(book, page, counts_row, [word_of(row) for row in rows])


def colour_words(sheet: Any, area: str) -> None:
    """Let cells that hold a verdict show green, red or amber by their word."""
    for word, colour in ((MET, GREEN_FILL), (VIOLATED, RED_FILL), (OPEN, AMBER_FILL)):
        sheet.conditional_formatting.add(area, CellIsRule(operator="equal", formula=[f'"{tr(word)}"'], fill=fill(colour)))


def _lines(rows: Sequence[Accepted]) -> Iterator[tuple[Any, ...]]:
    cells = cell_names(rows)
    known: set[str] = set()
    for number, (row, cell, tolerance) in enumerate(zip(rows, cells, _tolerances(rows), strict=True), 1):
        limit = Formula(same_as(f"{{{cell}}}"), row.limit_value) if cell in known else row.limit_value
        known.add(cell)
        yield (
            number, recorded(row.name), row.found, tr(_SENSES[row.sense]), limit, row.unit, tolerance,
            _margin(row), _verdict(row), tr(group_of(row)), place_in_words(row), row.time,
            limit_in_words(row.limit_name), tr(KNOWN_AS.get(row.status, row.status)), recorded(row.source),
        )  # fmt: skip


def _tolerances(rows: Sequence[Accepted]) -> list[float | Formula | None]:
    """Return what stands in the column of tolerances: a number that can be edited, or the same as of an earlier row."""
    found: list[float | Formula | None] = []
    first: dict[str, float] = {}
    for row, cell in zip(rows, cell_names(rows), strict=True):
        is_same = first.get(cell) == row.tolerance
        if has_tolerance_cell(row):
            first.setdefault(cell, row.tolerance)
            found.append(Formula(same_as(f"{{{tolerance_name(cell)}}}"), row.tolerance) if is_same else row.tolerance)
        else:
            found.append(None)
    return found


def _margin(row: Accepted) -> Formula | None:
    """Return how far the found value is from the limit, negative beyond it."""
    found, limit = number_in(row.found), number_in(row.limit_value)
    if limit is None:
        return None
    value = "" if found is None else found - limit if row.sense == AT_LEAST else limit - found
    return Formula(comparison_of(row).margin, value)


def _verdict(row: Accepted) -> Formula | str:
    """Return the verdict as a formula; as a word where the program says other than the numbers do."""
    word = word_of(row)
    if row.limit_value is None or (row.met is not None and word != word_by_numbers(row)):
        return tr(word)
    words = replace(BY_LIMIT, not_judged=row.bare or OPEN)
    return Formula(comparison_of(row).verdict_by("{margin}", words), tr(word))


def _name_limits(book: Book, page: Page, block: Block, rows: Sequence[Accepted]) -> None:
    """Name the first cell of each limit, and show those that can be edited so; small numbers get more digits."""
    known: set[str] = set()
    lines = zip(rows, cell_names(rows), digits_of(rows), _tolerances(rows), range(block.first, block.last + 1), strict=True)
    for row, cell, style, tolerance, at in lines:
        limit = number_in(row.limit_value)
        for key in ("found", "margin"):
            page.sheet[block.cell(key, at)]._style = page.styles[style]
        is_first = cell not in known and limit is not None
        editable = is_first and not isinstance(row.limit_value, Formula)
        if editable:
            page.edit(block.cell("limit", at), style)
        else:
            page.sheet[block.cell("limit", at)]._style = page.styles[style]
        if is_first:
            known.add(cell)
            book.define(cell, page, block.cell("limit", at))
        if tolerance is not None:
            place, is_own = block.cell("tolerance", at), not isinstance(tolerance, Formula)
            if is_own:
                page.edit(place, "general", 0.0)
            if is_own and tolerance_name(cell) not in book.names:
                book.define(tolerance_name(cell), page, place)


def _room_for_counts(page: Page) -> int:
    """Keep rows free for the counts, and return the first of them."""
    page.next += len(COUNTS) + 2
    return page.next - len(COUNTS) - 2


def _count(book: Book, page: Page, row: int, words: Sequence[str]) -> None:
    """Write how many limits are met, violated, and not judged."""
    for name, word in COUNTS.items():
        page.put(row, 1, "", "plain")
        page.put(row, 2, tr(word), "label")
        page.put(row, 3, Formula(f'COUNTIF({{acceptance_verdicts}},"{tr(word)}")', words.count(word)), "0")
        book.define(name, page, f"C{row}")
        row += 1
    page.put(row, 2, tr("all"), "label")
    page.put(row, 3, Formula("+".join(f"{{{name}}}" for name in COUNTS), sum(map(words.count, COUNTS.values()))), "sum 0")
    book.define(ALL, page, f"C{row}")
