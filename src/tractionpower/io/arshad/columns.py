"""Columns of the CSV files of Arshad et al.: a name in one of several spellings, and a unit in parentheses."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tractionpower.errors import InputError, Problem
from tractionpower.io.arshad.units import UNITS, Dimension, Told, plain_unit, read_quantity
from tractionpower.io.csv_files import read_plain
from tractionpower.io.documents import Reader
from tractionpower.io.text_files import Source
from tractionpower.io.wording import did_you_mean, shown

_HEADER = re.compile(r"(?P<name>[^(\[]*)(?:[(\[](?P<unit>.*)[)\]])?\s*")


@dataclass(frozen=True, slots=True)
class Column:
    """A column that a file may have.

    Attributes
    ----------
    name
        How this program calls it.
    spellings
        How its header may be written, without the unit; the one of messages first.
    dimension
        What its cells are; None: words.
    required
        Whether the file must have it.
    unit
        Unit where the header says none; None: the header must say it, if the dimension has units.
    """

    name: str
    spellings: tuple[str, ...]
    dimension: Dimension | None = None
    required: bool = True
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class Cells:
    """A row: its line, and its cells that are not empty, by the name of the column."""

    source: Source
    line: int
    texts: dict[str, str]
    units: dict[str, str]
    headers: dict[str, str]

    def problem(self, name: str, code: str, found: str, allowed: str = "", remedy: str = "") -> Problem:
        """Return a problem of a cell."""
        column = self.headers.get(name, name)
        return self.source.problem(code, f"{found} in column {shown(column)}", allowed, remedy, self.line)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A file as read: the units of its columns as the header says them, and its rows."""

    units: dict[str, str]
    headers: dict[str, str]
    rows: tuple[Cells, ...]


def read_sheet(reader: Reader, source: Source, columns: Sequence[Column]) -> Sheet | None:
    """Read a file with these columns, in any order; None if it has errors, which `reader` collects."""
    try:
        header, rows = read_plain(source)
        names, units, headers = _matched(source, header, columns)
    except InputError as error:
        reader.problems += error.problems
        return None
    cells = tuple(
        Cells(source, line, {names[column]: text for column, text in row.items()}, units, headers) for line, row in rows
    )
    if not cells:
        reader.problems.append(source.problem("empty_file", "no row below the header", "at least one row"))
        return None
    return Sheet(units, headers, cells)


def number(cells: Cells, column: Column, problems: list[Problem]) -> float | None:
    """Return the value of a cell in the unit of the declarations; None if it is empty or wrong, which is told."""
    text = cells.texts.get(column.name)
    if text is None or column.dimension is None:
        return None
    value = read_quantity(text, column.dimension, cells.units.get(column.name, ""))
    if isinstance(value, Told):
        problems.append(cells.problem(column.name, "bad_value", value.found, value.allowed, value.remedy))
        return None
    return value


def _matched(
    source: Source, header: Sequence[str], columns: Sequence[Column]
) -> tuple[dict[str, str], dict[str, str], dict[str, str]]:
    # Name by header as written; unit and header by name.
    by_spelling = {_plain(spelling): column for column in columns for spelling in column.spellings}
    names: dict[str, str] = {}
    units: dict[str, str] = {}
    problems: list[Problem] = []
    for written in header:
        match = _HEADER.fullmatch(written)
        column = by_spelling.get(_plain(match["name"])) if match is not None else None
        if column is None or match is None:
            known = [spelling for each in columns for spelling in each.spellings]
            allowed = ", ".join(each.spellings[0] for each in columns)
            problems.append(
                source.problem("unknown_column", f"the column {shown(written)}", allowed, did_you_mean(written, known), 1)
            )
        elif column.name in names.values():
            found = f"the column {column.spellings[0]} twice"
            problems.append(source.problem("duplicate_column", found, "each column once", line=1))
        else:
            names[written] = column.name
            problems += _unit(source, written, match["unit"], column, units)
    found_names = set(names.values())
    for column in columns:
        if column.required and column.name not in found_names:
            remedy = "add it" + (f", with its unit: {column.spellings[0]} (UNIT)" if _needs_unit(column) else "")
            problems.append(source.problem("missing_column", f"no column {column.spellings[0]}", remedy=remedy, line=1))
    if problems:
        raise InputError(problems)
    return names, units, {name: written for written, name in names.items()}


def _unit(source: Source, written: str, text: str | None, column: Column, units: dict[str, str]) -> Iterator[Problem]:
    if column.dimension is None:
        return
    unit = plain_unit(text or "")
    if not unit and column.unit is not None:
        unit = column.unit
    if unit in UNITS[column.dimension]:
        units[column.name] = unit
        return
    known = " | ".join(each for each in UNITS[column.dimension] if each)
    allowed = f"{column.spellings[0]} ({known})" if known else column.spellings[0]
    found = f"the column {shown(written)} with {f'the unit {shown(text)}' if unit else 'no unit'}"
    yield source.problem("bad_unit", found, allowed, f"units are {known}" if known else "leave the unit out", 1)


def _needs_unit(column: Column) -> bool:
    return column.dimension is not None and column.unit is None and "" not in UNITS[column.dimension]


def _plain(name: str) -> str:
    return " ".join(name.lower().split())
