"""Reading of Excel workbooks as plain cells: texts, numbers, times; this module is the reader's door to openpyxl."""

from __future__ import annotations

import warnings
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import date, datetime, time, timedelta
from typing import Any

from openpyxl import load_workbook
from openpyxl.utils import get_column_letter
from openpyxl.utils.exceptions import InvalidFileException

from tractionpower.errors import Problem
from tractionpower.io.text_files import MEGABYTE, Source
from tractionpower.io.wording import printable, shown

LIMIT_MB = 50
MOST_UNPACKED_MB = 1000
"""What a workbook may unpack to; more is taken for an attack."""

MOST_CELLS = 2_000_000
"""Cells of a sheet; a sheet with more is no timetable."""

_OLE = b"\xd0\xcf\x11\xe0"
_DAY_ZERO = datetime(1899, 12, 31)
_LAST_YEAR_OF_TIMES = 1900

Cell = str | float | bool | timedelta | datetime | None
"""Value of a cell: an empty one is None, a time is a `timedelta` from midnight, a date with a time a `datetime`."""


@dataclass(slots=True)
class Sheet:
    """Rows of a sheet, or of a CSV file.

    Attributes
    ----------
    label
        File and sheet as messages call them.
    rows, lines
        The cells, and the line of each row in the file.
    name
        Name of the sheet; empty for a CSV file.
    unsaved
        Row and column of formulas whose values were not saved: they are told, and are empty here.
    """

    label: str
    rows: list[list[Cell]]
    lines: list[int]
    name: str = ""
    unsaved: set[tuple[int, int]] = field(default_factory=set)

    def place(self, row: int) -> str:
        """Return file and line of a row, ``plan.xlsx, sheet Mo-Fr:7``."""
        return f"{self.label}:{self.lines[row]}"

    def cell(self, row: int, column: int) -> str:
        """Return a cell as spreadsheets name it, ``cell B7``."""
        return f"cell {get_column_letter(column + 1)}{self.lines[row]}"

    def problem(self, code: str, row: int, column: int, found: str, allowed: str = "", remedy: str = "") -> Problem:
        """Return a problem of one cell."""
        return Problem(code, self.cell(row, column), found, allowed, remedy, place=self.place(row))


@dataclass(slots=True)
class Workbook:
    """Sheets of a workbook, names of hidden ones that were not read, and what was wrong with single cells."""

    sheets: list[Sheet]
    hidden: list[str] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)


def read_workbook(source: Source) -> Workbook:
    """Read the visible sheets of an Excel workbook (.xlsx, .xlsm); of formulas the values that were saved with them.

    Raises
    ------
    InputError
        If the file is missing, too large, locked by a password, of the old kind or no workbook at all.
    """
    _refuse(source)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what openpyxl cannot keep (drawings, validations) is not read either
            values = load_workbook(source.file, data_only=True)
            formulas = load_workbook(source.file)
    except (InvalidFileException, zipfile.BadZipFile, KeyError, ValueError, TypeError, OSError, SyntaxError) as error:
        reason = printable(str(error))[:200]
        raise source.fail("no_workbook", f"no Excel workbook: {reason}", "an .xlsx file", "save it again as .xlsx") from None
    read = Workbook([])
    for sheet in values.worksheets:
        if sheet.sheet_state != "visible":
            read.hidden.append(printable(sheet.title))
        elif (sheet.max_row or 0) * (sheet.max_column or 0) > MOST_CELLS:
            raise source.fail("sheet_too_large", f"sheet {shown(sheet.title)} has more than {MOST_CELLS} cells")
        else:
            read.sheets.append(_sheet(source, sheet, formulas[sheet.title], read.problems))
    return read


def _refuse(source: Source) -> None:
    if not source.file.is_file():
        raise source.fail("missing_file", f"there is no file {source.label}", remedy="mend the name or add the file")
    size = source.file.stat().st_size / MEGABYTE
    if size > LIMIT_MB:
        raise source.fail("file_too_large", f"the file has {size:.1f} MB", f"at most {LIMIT_MB} MB")
    with source.file.open("rb") as file:
        head = file.read(4)
    if head == _OLE:
        found = "an Excel file of the old kind (.xls), or one with a password"
        raise source.fail("old_workbook", found, "an .xlsx file without a password", "save it again as .xlsx or as CSV")
    try:
        with zipfile.ZipFile(source.file) as packed:
            unpacked = sum(entry.file_size for entry in packed.infolist()) / MEGABYTE
    except (zipfile.BadZipFile, OSError) as error:
        found = f"no Excel workbook: {printable(str(error))}"
        raise source.fail("no_workbook", found, "an .xlsx file", "save it again as .xlsx") from None
    if unpacked > MOST_UNPACKED_MB:
        raise source.fail("file_too_large", f"the workbook unpacks to {unpacked:.0f} MB", f"at most {MOST_UNPACKED_MB} MB")


def _sheet(source: Source, values: Any, formulas: Any, problems: list[Problem]) -> Sheet:
    rows = [[_plain(value) for value in row] for row in values.iter_rows(values_only=True)]
    sheet = Sheet(f"{source.label}, sheet {printable(values.title)}", rows, list(range(1, len(rows) + 1)), values.title)
    for row, column in _upright(values):
        rows[row][column] = rows[row - 1][column]
    for row in formulas.iter_rows():
        for cell in row:
            if cell.data_type == "f" and rows[cell.row - 1][cell.column - 1] is None:
                found = "a formula whose value was not saved"
                remedy = "open the file in a spreadsheet, save it, or paste the values"
                sheet.unsaved.add((cell.row - 1, cell.column - 1))
                problems.append(sheet.problem("no_value", cell.row - 1, cell.column - 1, found, remedy=remedy))
    return sheet


def _upright(values: Any) -> Iterator[tuple[int, int]]:
    """Yield row and column of cells that are merged with the one above: a station over its rows of arrival and departure."""
    for area in values.merged_cells.ranges:
        if area.min_col == area.max_col:
            for row in range(area.min_row, area.max_row):
                yield row, area.min_col - 1


def _plain(value: Any) -> Cell:
    plain: Cell = value
    if isinstance(value, str):
        plain = value.strip() or None
    elif isinstance(value, time):
        plain = timedelta(hours=value.hour, minutes=value.minute, seconds=value.second, microseconds=value.microsecond)
    elif isinstance(value, datetime):  # 25:10 in a cell of format h:mm comes as a day of 1900
        plain = value - _DAY_ZERO if value.year <= _LAST_YEAR_OF_TIMES else value
    elif isinstance(value, date):
        plain = datetime(value.year, value.month, value.day)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        plain = float(value)
    return plain
