"""Whole tables as sheets of an Excel workbook, a row at a time; no cell becomes a formula."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
from openpyxl import Workbook
from openpyxl.cell import WriteOnlyCell
from openpyxl.styles import Font
from openpyxl.utils import get_column_letter

LONGEST_TEXT = 32_767
"""Characters in a cell; a limit of Excel."""

_SPECIAL = tuple("=+-@#")
_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # no characters of XML 1.0


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet: its name, the headings of its columns, and its rows as Arrow tables, some at a time."""

    name: str
    headings: Sequence[str]
    batches: Iterable[pa.Table]


def write_sheets(path: Path, sheets: Sequence[Sheet]) -> None:
    """Write a workbook; the first row of every sheet holds the headings and stays in sight."""
    book = Workbook(write_only=True)
    for sheet in sheets:
        page = book.create_sheet(sheet.name)
        page.freeze_panes = "A2"
        for number, heading in enumerate(sheet.headings, 1):
            page.column_dimensions[get_column_letter(number)].width = max(10, len(heading) + 2)
        page.append([_text_cell(page, heading, Font(bold=True)) for heading in sheet.headings])
        for batch in sheet.batches:
            for row in zip(*(_cells(page, column) for column in batch.columns), strict=True):
                page.append(row)
    book.save(path)


def _cells(page: Any, column: pa.ChunkedArray) -> Iterator[Any]:
    """Yield the cells of a column; a missing value is an empty cell, as is a number that is not finite."""
    if pa.types.is_dictionary(column.type):
        for text in column.cast(pa.string()).to_pylist():
            yield None if text is None else _text_cell(page, text) if text[:1] in _SPECIAL else _fitting(text)
    elif pa.types.is_floating(column.type):
        finite = pc.if_else(pc.is_finite(column), column, None)
        if column.type == pa.float32():
            # As a text a number of 32 bits has the digits that it is worth, 3600.1 and not 3600.10009765625.
            yield from (None if text is None else float(text) for text in finite.cast(pa.string()).to_pylist())
        else:
            yield from finite.to_pylist()
    else:
        yield from column.to_pylist()


def _fitting(text: str) -> str:
    return _FORBIDDEN.sub("\ufffd", text)[:LONGEST_TEXT]


def _text_cell(page: Any, text: str, font: Font | None = None) -> Any:
    cell = WriteOnlyCell(page, _fitting(text))
    cell.data_type = "s"  # a leading = would make a formula of it, a name such as #N/A an error
    if font is not None:
        cell.font = font
    if text[:1] in _SPECIAL:
        cell.quotePrefix = 1  # it stays text when someone edits the cell
    return cell
