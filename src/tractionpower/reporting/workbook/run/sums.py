"""What stands above and below tables: sums of columns, counts and extremes, all of them as formulas."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from openpyxl.utils import get_column_letter

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Block, Column, Page

LABEL_WIDTH = 42.0
"""Room for the labels [characters]."""

Told = tuple[str, Any, str]
"""Label (English), value or formula, and style of a line above a table."""


def number(value: Any) -> float | None:
    """Return a number, None for what is none: an empty value, not a number, a text."""
    known = value.value if isinstance(value, Formula) else value
    if known is None or isinstance(known, str) or not math.isfinite(known):
        return None
    return float(known)


def total(values: Iterable[Any]) -> float:
    """Return the sum of the numbers among some values."""
    return math.fsum(known for value in values if (known := number(value)) is not None)


def add_sums(page: Page, block: Block, columns: Mapping[str, str], rows: Sequence[Sequence[Any]], **more: Formula) -> int:
    """Write a row of sums below a table that was just written, and return its row.

    Parameters
    ----------
    page, block
        The table.
    columns
        Keys of the columns that are summed up, with their number formats.
    rows
        Values of the table.
    more
        Other formulas of the row by the key of their column; places in braces are cells of this row.
    """
    row = block.last + 1
    cells = {key: block.cell(key, row) for key in block.keys if key}
    for number_ in range(1, len(block.headings) + 1):
        page.put(row, number_, tr("sum") if number_ == 1 else None, "sum text")
    for key, style in columns.items():
        value = total(each[block.column(key) - 1] for each in rows)
        page.put(row, block.column(key), Formula(f"SUM({block.cells(key)})", value), f"sum {style}")
    for key, formula in more.items():
        page.put(row, block.column(key), formula, "sum 0.00", cells)
    page.next = row + 2
    return row


def without_empty(
    columns: Sequence[Column], rows: list[list[Any]], needed: Sequence[str] = ()
) -> tuple[list[Column], list[list[Any]]]:
    """Return columns and rows of a table without the columns that are empty in all rows; the first and `needed` keys stay."""
    kept = [
        k for k, column in enumerate(columns) if k == 0 or column.key in needed or any(row[k] not in (None, "") for row in rows)
    ]
    return [columns[k] for k in kept], [[row[k] for k in kept] for row in rows]


def room_above(page: Page, lines: int) -> int:
    """Keep rows free above a table, and return the first of them."""
    page.next += lines + 1
    return page.next - lines - 1


def write_above(page: Page, row: int, told: Sequence[Told], names: Mapping[str, str] | None = None, *, value_in: int = 2) -> None:
    """Write lines of a label and a value into rows that were kept free; `names` by label name the cells of values.

    The label takes the columns before that of the values, so that the table below need not be wide for its sake.
    """
    if value_in == 2:
        page.widen(LABEL_WIDTH)
    for label, value, style in told:
        words = tr(label)
        page.put(row, 1, words, "label")
        if value_in > 2:
            page.sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=value_in - 1)
        page.sheet.row_dimensions[row].height = LINE_POINTS * math.ceil(len(words) / LABEL_WIDTH)
        page.put(row, value_in, value, style)
        if names and label in names:
            page.book.define(names[label], page, f"{get_column_letter(value_in)}{row}")
        row += 1
