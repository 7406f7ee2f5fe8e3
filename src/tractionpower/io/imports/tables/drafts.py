"""A train as a timetable file tells it, before times, stations and tracks are made sure of."""

from __future__ import annotations

from dataclasses import dataclass, field

from tractionpower.errors import Problem
from tractionpower.io.excel import Cell, Sheet
from tractionpower.io.imports.tables.cell_times import ALLOWED, CellTime, read_time
from tractionpower.io.wording import shown
from tractionpower.model.line import Station

_BAD = CellTime(None, way="bad")


@dataclass(slots=True)
class Stop:
    """A call of a train: where it stands in the file, station, times, and what else is told.

    Attributes
    ----------
    row, column
        Cell that is blamed.
    station
        The station.
    arrival, departure
        Times of the cells, as they stand there.
    stops
        Whether it stops, where a column says so.
    min_dwell_s
        Shortest time there [s].
    track
        Track that it comes on.
    """

    row: int
    column: int
    station: Station
    arrival: CellTime | None = None
    departure: CellTime | None = None
    stops: bool | None = None
    min_dwell_s: float | None = None
    track: str = ""


@dataclass(slots=True)
class Draft:
    """A train: its number, where it begins in the file, what it is made of, its calls in the order of the file.

    `is_whole` is false where a row or cell of it could not be used: what is lacking then is no fault of its own.
    """

    id: str
    sheet: Sheet
    row: int
    column: int
    train_type: str = ""
    category: str = ""
    days: str = ""
    stops: list[Stop] = field(default_factory=list)
    is_whole: bool = True

    def problem(self, code: str, found: str, allowed: str = "", remedy: str = "", stop: Stop | None = None) -> Problem:
        """Return a problem of the train, or of one of its calls."""
        row, column = (self.row, self.column) if stop is None else (stop.row, stop.column)
        return self.sheet.problem(code, row, column, f"train {shown(self.id)}: {found}", allowed, remedy)


def time_at(sheet: Sheet, row: int, column: int, problems: list[Problem]) -> CellTime | None:
    """Return what a cell says of a time; what is no time becomes a problem, and a time that is marked as bad."""
    cell: Cell = sheet.rows[row][column]
    if (row, column) in sheet.unsaved:
        return _BAD
    try:
        return read_time(cell)
    except ValueError as error:
        problems.append(sheet.problem("no_time", row, column, f"{error} is no time", ALLOWED))
        return _BAD
