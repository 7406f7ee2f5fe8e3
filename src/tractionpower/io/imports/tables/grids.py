"""A table of a CSV file or an Excel workbook as sheets of cells, whatever its headings are."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from tractionpower.errors import InputError, UsageError
from tractionpower.io.csv_files import LIMIT_MB
from tractionpower.io.excel import Sheet, read_workbook
from tractionpower.io.imports.imported import Notes
from tractionpower.io.text_files import Source, read_text
from tractionpower.io.wording import did_you_mean, printable, shown

EXCEL = (".xlsx", ".xlsm", ".xls")
SEPARATORS = (";", "\t", ",")
_LOOKED_AT = 5


def read_grids(file: Path, only: str | None, notes: Notes) -> list[Sheet]:
    """Return the sheets of a file; of a workbook the visible ones, or the one that is asked for.

    Problems of the file go into `notes`.

    Raises
    ------
    UsageError
        If there is no sheet of the name `only`.
    """
    source = Source(file, printable(file.name), "")
    try:
        if file.suffix.lower() in EXCEL:
            return _of_workbook(source, only, notes)
        if only is not None:
            raise UsageError(f"--sheet {only}: {source.label} is no workbook")
        return [_of_text(source)]
    except InputError as error:
        notes.problems += error.problems
        return []


def _of_workbook(source: Source, only: str | None, notes: Notes) -> list[Sheet]:
    book = read_workbook(source)
    names = [sheet.name for sheet in book.sheets]
    if only is not None and only not in names:
        hint = did_you_mean(only, names) or f"sheets: {', '.join(map(shown, names))}"
        raise UsageError(f"--sheet: {source.label} has no sheet {shown(only)}; {hint}")
    kept = [sheet for sheet in book.sheets if only in (None, sheet.name)]
    notes.problems += [each for each in book.problems if any(each.place.startswith(f"{sheet.label}:") for sheet in kept)]
    notes.ignored += [f"sheet {name} is hidden" for name in book.hidden]
    notes.ignored += [f"sheet {printable(name)}: --sheet names another" for name in names if only not in (None, name)]
    return kept


def _of_text(source: Source) -> Sheet:
    text = read_text(source, LIMIT_MB)
    separator = _separator(text)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True, skipinitialspace=True)
    sheet = Sheet(source.label, [], [])
    line = 1
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                sheet.rows.append([cell.strip() or None for cell in row])
                sheet.lines.append(line)
            line = reader.line_num + 1
    except csv.Error as error:
        raise source.fail("csv_syntax", f"the row cannot be read: {error}", line=line) from None
    if not sheet.rows:
        raise source.fail("empty_file", "the file is empty", "a timetable: `tractionpower import timetable --help`")
    width = max(map(len, sheet.rows))
    for cells in sheet.rows:
        cells.extend([None] * (width - len(cells)))
    return sheet


def _separator(text: str) -> str:
    lines = [line for line in text.splitlines() if line.strip()][:_LOOKED_AT]
    return max(SEPARATORS, key=lambda sign: (sum(line.count(sign) for line in lines), -SEPARATORS.index(sign)))
