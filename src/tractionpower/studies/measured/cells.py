"""A measured CSV file as columns of texts: lines above the headings, delimiter and units below them are found."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import InputError, Problem
from tractionpower.io.text_files import Source, read_text
from tractionpower.io.wording import counted, did_you_mean, shown

LIMIT_MB = 500
SEARCHED = 200
"""Lines in which the headings are looked for."""

DELIMITERS = {"semicolon": ";", "tab": "\t", "comma": ",", "blank": " "}
MOST_RAGGED = 0.1
"""Share of rows with too many cells from which on the file is refused."""


@dataclass(slots=True)
class Cells:
    """Columns of a measured file.

    Attributes
    ----------
    label
        The file as messages call it.
    lines
        Line of each row in the file, from 1.
    columns
        The cells of the wanted columns by heading, stripped.
    delimiter
        What stands between cells.
    problems
        Warnings.
    """

    label: str
    lines: NDArray[np.intp]
    columns: dict[str, list[str]]
    delimiter: str
    problems: list[Problem] = field(default_factory=list)

    def place(self, row: int) -> str:
        """Return file and line of a row."""
        return f"{self.label}:{self.lines[row]}"


def read_cells(source: Source, time: str, wanted: Sequence[str], delimiter: str | None, encoding: str) -> Cells:
    """Read the column `time` and those that are `wanted`.

    Parameters
    ----------
    source
        The file.
    time, wanted
        Headings.
    delimiter
        What stands between cells, as the map says it; None: found.
    encoding
        Encoding of the text.

    Raises
    ------
    InputError
        If the file cannot be read, headings are missing or stand there twice, or rows do not fit them.
    """
    text = read_text(source, LIMIT_MB, encoding)
    if text.startswith("PK\x03\x04"):
        raise source.fail("not_text", "an Excel workbook", "a CSV file", "save the sheet as CSV")
    lines = text.splitlines()
    if not any(line.strip() for line in lines):
        raise source.fail("empty_file", "the file is empty", "a row of headings and rows of values")
    top, sign, header = _find_header(source, lines, time, delimiter)
    positions = _positions(source, top + 1, header, [time, *dict.fromkeys(wanted)])
    return _rows(source, _split(source, lines[top + 1 :], sign, top + 2), header, positions, sign)


def _find_header(source: Source, lines: Sequence[str], time: str, delimiter: str | None) -> tuple[int, str, list[str]]:
    """Return number (from 0), delimiter and cells of the first line that has the heading of the times."""
    signs = list(DELIMITERS.values())[:3] if delimiter is None else [DELIMITERS[delimiter]]
    for number, line in enumerate(lines[:SEARCHED]):
        for sign in signs:
            cells = _cut(line, sign)
            if time in cells:
                return number, sign, cells
    first = next(k for k, line in enumerate(lines) if line.strip())
    sign = max(signs, key=lines[first].count)
    cells = [cell for cell in _cut(lines[first], sign) if cell]
    found = f"no column {shown(time)} in the first {min(SEARCHED, len(lines))} lines; the first has {shown(', '.join(cells))}"
    remedy = did_you_mean(time, cells) or "mend time.column, or delimiter, of the map"
    raise source.fail("missing_column", found, "headings as the map has them", remedy, first + 1)


def _cut(line: str, sign: str) -> list[str]:
    try:
        cells = next(csv.reader([line], delimiter=sign, skipinitialspace=True), [])
    except csv.Error:
        cells = line.split(sign)
    return [cell.strip() for cell in cells]


def _positions(source: Source, line: int, header: Sequence[str], wanted: Sequence[str]) -> dict[str, int]:
    problems = []
    for name in wanted:
        count = header.count(name)
        if count == 0:
            remedy = did_you_mean(name, header) or f"columns: {', '.join(cell for cell in header if cell)}"
            found = f"no column {shown(name)}"
            problems.append(source.problem("missing_column", found, "headings as the map has them", remedy, line))
        elif count > 1:
            found = f"the column {shown(name)} {count} times"
            problems.append(source.problem("duplicate_column", found, "each heading once", "rename one of them", line))
    if problems:
        raise InputError(problems)
    return {name: header.index(name) for name in wanted}


def _split(source: Source, lines: Sequence[str], sign: str, first: int) -> Iterator[tuple[int, list[str]]]:
    """Yield line and cells of each row that is not blank."""
    reader = csv.reader(io.StringIO("\n".join(lines)), delimiter=sign, skipinitialspace=True)
    line = first
    try:
        for cells in reader:
            if cells and any(cell.strip() for cell in cells):
                yield line, cells
            line = first + reader.line_num
    except csv.Error as error:
        raise source.fail("csv_syntax", f"the row cannot be read: {error}", line=line) from None


def _rows(
    source: Source, rows: Iterator[tuple[int, list[str]]], header: Sequence[str], positions: dict[str, int], sign: str
) -> Cells:
    picks, width = list(positions.values()), len(header)
    lines: list[int] = []
    columns: list[list[str]] = [[] for _ in picks]
    problems: list[Problem] = []
    long: list[int] = []
    for number, (line, cells) in enumerate(rows):
        taken = [cells[k].strip() if k < len(cells) else "" for k in picks]
        if number == 0 and not any(character.isdigit() for cell in taken for character in cell):
            continue  # a line of units below the headings
        if len(cells) > width and any(cell.strip() for cell in cells[width:]):
            long.append(line)
            continue
        lines.append(line)
        for column, cell in zip(columns, taken, strict=True):
            column.append(cell)
    if len(long) > MOST_RAGGED * (len(lines) + len(long)):
        found = f"{counted(len(long), 'row')} with more cells than the {width} headings"
        remedy = "are decimal commas in a file whose cells are separated by commas? save it with semicolons"
        raise source.fail("ragged_row", found, f"{width} cells", remedy if sign == "," else "mend the rows", long[0])
    if long:
        problem = source.problem("ragged_row", f"{counted(len(long), 'row')} with more than {width} cells left out", line=long[0])
        problems.append(_warning(problem))
    if not lines:
        raise source.fail("no_rows", "no rows of values below the headings", "two or more")
    return Cells(source.label, np.array(lines), dict(zip(positions, columns, strict=True)), sign, problems)


def _warning(problem: Problem) -> Problem:
    return Problem(problem.code, problem.path, problem.found, problem.allowed, problem.remedy, "warning", problem.place)
