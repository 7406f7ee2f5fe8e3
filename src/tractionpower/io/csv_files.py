"""CSV files that stand for a list: comma, or semicolon with decimal comma; the header row names the fields.

Blanks around a cell are dropped and an empty cell is a key left out. A cell becomes a number if its field is declared
as one and the text is a number; otherwise it stays text, and the check of the declaration tells what is wrong with it.
Fields of a nested declaration have dotted headers, such as ``from.track``; a field that is a list of rows itself, such
as the calls of a train, is the name of a further CSV file.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from tractionpower.errors import InputError, Problem
from tractionpower.io.provenance import Mark, list_mark
from tractionpower.io.shapes import Shape
from tractionpower.io.text_files import Source, read_text
from tractionpower.io.wording import did_you_mean, shown

LIMIT_MB = 50

_NUMBER = re.compile(r"[-+]?(?:\.\d+|\d+(?:\.\d*)?)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf)", re.IGNORECASE)


@dataclass(slots=True)
class Table:
    """A CSV file as read: one mapping per row, the lines, and what was wrong with single rows."""

    rows: list[dict[str, Any]]
    mark: Mark
    problems: list[Problem] = field(default_factory=list)


def read_csv(source: Source, row: Shape) -> Table:
    """Read a CSV file whose rows have the shape `row`.

    Raises
    ------
    InputError
        If the file cannot be read at all: missing, too large, not UTF-8, no header, a bad header.
    """
    text = read_text(source, LIMIT_MB)
    separator = ";" if ";" in text.partition("\n")[0] else ","
    lines = _cells(source, text, separator)
    header_line, header = next(lines, (0, []))
    if not header:
        raise source.fail("empty_file", "the file is empty", f"a header row with {', '.join(row.keys)}")
    _check_header(source, header_line, header, row)
    columns = [(name.split("."), _kind(name, row)) for name in header]
    table = Table([], Mark(source.label))
    for line, cells in lines:
        if len(cells) == len(header):
            table.mark.children[len(table.rows)] = Mark(source.label, line, is_row=True)
            table.rows.append(_row(columns, cells, separator))
        else:
            found = f"{len(cells)} cells in the row"
            table.problems.append(source.problem("ragged_row", found, f"{len(header)}, as in the header", line=line))
    list_mark(table.mark, table.rows)
    return table


def read_plain(source: Source) -> tuple[list[str], list[tuple[int, dict[str, str]]]]:
    """Return header and rows of a CSV file with columns of any name: each row with its line, its cells by column as texts.

    Empty cells are left out; a decimal comma becomes a point where a semicolon separates cells.

    Raises
    ------
    InputError
        If the file cannot be read, has no header, a column twice or without a name, or rows of another length.
    """
    text = read_text(source, LIMIT_MB)
    separator = ";" if ";" in text.partition("\n")[0] else ","
    lines = _cells(source, text, separator)
    line, header = next(lines, (0, []))
    if not header:
        raise source.fail("empty_file", "the file is empty", "a header row and a row for each case")
    problems = [
        source.problem("duplicate_column", f"the column {shown(name)} twice", "each column once", line=line)
        for name in sorted({name for name in header if header.count(name) > 1})
    ]
    rows = []
    for line, cells in lines:
        if len(cells) != len(header):
            found = f"{len(cells)} cells in the row"
            remedy = "" if separator == ";" else "a cell with a comma stands in quotes"
            problems.append(source.problem("ragged_row", found, f"{len(header)}, as in the header", remedy, line))
        named = zip(header, cells, strict=False)
        rows.append((line, {name: _pointed(cell, separator) for name, cell in named if cell}))
    if problems:
        raise InputError(problems)
    return header, rows


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return rows as CSV text with commas, header first; None becomes an empty cell."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\r\n")  # so that a text with either sign is quoted
    writer.writerow(columns)
    writer.writerows(rows)
    return buffer.getvalue()


def _cells(source: Source, text: str, separator: str) -> Iterator[tuple[int, list[str]]]:
    # Yields the first line of each row that is not blank, and its trimmed cells.
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True, skipinitialspace=True)
    line = 1
    try:
        for cells in reader:
            trimmed = [cell.strip() for cell in cells]
            if any(trimmed):
                yield line, trimmed
            line = reader.line_num + 1
    except csv.Error as error:
        raise source.fail("csv_syntax", f"the row cannot be read: {error}", line=line) from None


def _check_header(source: Source, line: int, header: Sequence[str], row: Shape) -> None:
    allowed = ", ".join(row.keys)
    problems = []
    for index, name in enumerate(header):
        if name in header[:index]:
            problems.append(source.problem("duplicate_column", f"the column {shown(name)} twice", "each column once", line=line))
        elif not _is_known(name, row):
            remedy = did_you_mean(name, row.keys) or "columns are separated by comma or semicolon"
            problems.append(source.problem("unknown_column", f"the column {shown(name)}", allowed, remedy, line))
    given = {name.split(".")[0] for name in header}
    for name in row.required:
        if name not in given:
            problems.append(source.problem("missing_column", f"no column {name}", allowed, line=line))
    if problems:
        raise InputError(problems)


def _is_known(name: str, row: Shape) -> bool:
    shape = row.find(tuple(name.split(".")))
    return shape is not None and shape.kind != "mapping"


def _kind(name: str, row: Shape) -> str:
    shape = row.find(tuple(name.split(".")))
    return shape.kind if shape is not None else "other"


def _row(columns: Sequence[tuple[list[str], str]], cells: Sequence[str], separator: str) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for (names, kind), cell in zip(columns, cells, strict=True):
        if not cell:
            continue
        target = row
        for name in names[:-1]:
            target = target.setdefault(name, {})
        target[names[-1]] = _value(cell, kind, separator)
    return row


def _value(cell: str, kind: str, separator: str) -> Any:
    if kind == "integer" and re.fullmatch(r"[-+]?\d{1,300}", cell):
        return int(cell)
    if kind in ("number", "integer"):
        text = _pointed(cell, separator)
        return float(text) if _NUMBER.fullmatch(text) else cell
    if kind == "boolean" and cell.lower() in ("true", "false"):
        return cell.lower() == "true"
    return cell


def _pointed(cell: str, separator: str) -> str:
    """Return a number with a decimal comma, where a semicolon separates cells, with a point; other texts as they are."""
    text = cell.replace(",", ".") if separator == ";" else cell
    return text if _NUMBER.fullmatch(text) else cell
