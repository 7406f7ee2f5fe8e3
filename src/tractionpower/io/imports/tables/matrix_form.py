"""Timetables as a matrix: stations down and trains across, or the other way; a return direction may run upwards in it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from tractionpower.io.excel import Cell, Sheet
from tractionpower.io.imports.imported import Notes
from tractionpower.io.imports.tables.cell_times import CellTime
from tractionpower.io.imports.tables.drafts import Draft, Stop, time_at
from tractionpower.io.imports.tables.headings import field_of, text_of
from tractionpower.io.imports.tables.station_names import StationNames
from tractionpower.io.wording import shown
from tractionpower.model.line import Station

_WORDS = ("train_type", "category", "days")
_KINDS = ("arrival", "departure", "time")

MIDNIGHT_S = 18 * 3600.0
"""A train that seems to need longer from a call to the next, or comes so much earlier, has passed midnight [s]."""

At = tuple[int, int]
"""Row and column of a cell."""


@dataclass(frozen=True, slots=True)
class Matrix:
    """Where things stand in a sheet.

    Attributes
    ----------
    down
        Whether stations stand one below the other; else trains do.
    stations
        Index of the row (or column) of each station with its name, which kind of time stands there, and the name's cell.
    trains
        Index of the column (or row) of each train, with its number.
    words
        Index of rows (or columns) with train type, category, days.
    head, beside
        Row (or column) of the numbers of trains, and column (or row) of the names of stations.
    unused
        Rows (or columns) before the stations that are something else.
    """

    down: bool
    stations: Sequence[tuple[int, str, str]]
    trains: Sequence[tuple[int, str]]
    words: dict[str, int]
    head: int
    beside: int
    unused: Sequence[int] = ()

    def at(self, station: int, train: int) -> At:
        """Return row and column of the cell of a station's index and a train's."""
        return (station, train) if self.down else (train, station)


@dataclass(frozen=True, slots=True)
class Entry:
    """A time of a train: its cell, the station, what is said, which kind of time the row is for."""

    at: At
    station: Station
    said: CellTime
    kind: str


def find_matrix(sheet: Sheet, names: StationNames) -> Matrix | None:
    """Return where stations and trains stand in a sheet, or None if it is no matrix."""
    rows, columns = Counter[int](), Counter[int]()
    for row, cells in enumerate(sheet.rows):
        for column, cell in enumerate(cells):
            if isinstance(cell, str) and names.knows(_without_kind(cell)[0]):
                rows[row] += 1
                columns[column] += 1
    if not rows:
        return None
    (row, in_row), (column, in_column) = (max(count.items(), key=lambda item: (item[1], -item[0])) for count in (rows, columns))
    if max(in_row, in_column) < 2:
        return None
    down = in_column >= in_row
    lines = sheet.rows if down else [list(cells) for cells in zip(*sheet.rows, strict=True)]
    return _laid_out(lines, column if down else row, down, names)


def _laid_out(lines: Sequence[Sequence[Cell]], beside: int, down: bool, names: StationNames) -> Matrix | None:
    """Return the layout of lines in which stations stand one below the other in column `beside`."""
    first = next(k for k, line in enumerate(lines) if names.knows(_without_kind(text_of(line[beside]))[0]))
    kinds = _kind_column(lines, first, beside)
    labels = {
        k: next((name for cell in line[: beside + 2] if (name := field_of(cell))), "") for k, line in enumerate(lines[:first])
    }
    head = next((k for k in labels if labels[k] == "train"), None)
    if head is None:
        head = next((k for k in labels if labels[k] == "station" and any(lines[k][beside + 1 :])), None)
    if head is None:
        free = [k for k in labels if labels[k] not in _WORDS and any(cell is not None for cell in lines[k][beside + 1 :])]
        head = max(free, default=None)
    if head is None:
        return None
    begin = (beside if kinds is None else max(beside, kinds)) + 1
    trains = [
        (k, text_of(cell)) for k, cell in enumerate(lines[head]) if k >= begin and cell is not None and field_of(cell) != "km"
    ]
    stations, last = [], ""
    for k in range(first, len(lines)):
        text, said = _without_kind(text_of(lines[k][beside]))
        if kinds is not None:
            said = field_of(lines[k][kinds]) or said
        name = text or (last if said in _KINDS else "")
        if name:
            stations.append((k, name, said if said in _KINDS else ""))
            last = name
    words = {labels[k]: k for k in labels if labels[k] in _WORDS}
    used = {head, kinds if not down else None, *words.values()}
    unused = [k for k in labels if k not in used and any(cell is not None for cell in lines[k])]
    return Matrix(down, stations, trains, words, head, beside, unused)


def _kind_column(lines: Sequence[Sequence[Cell]], first: int, beside: int) -> int | None:
    """Return the column near the names of stations that tells arrivals from departures, or None."""
    for column in (beside + 1, beside + 2, beside - 1):
        if 0 <= column < len(lines[first]):
            said = [field_of(line[column]) for line in lines[first:] if line[column] is not None]
            if said and sum(kind in _KINDS for kind in said) >= 0.8 * len(said):
                return column
    return None


def _without_kind(text: str) -> tuple[str, str]:
    """Return the name of a station without a word such as ``arr`` behind it, and the field that the word stands for."""
    name, _, word = text.rpartition(" ")
    kind = field_of(word.strip("().")) if name and len(word.strip("().")) > 1 else None
    return (name.strip(" ,-–"), kind) if kind in ("arrival", "departure") else (text, "")


def read_matrix(sheet: Sheet, matrix: Matrix, names: StationNames, notes: Notes) -> list[Draft]:
    """Return the trains of a matrix from left to right, or from top to bottom."""
    drafts, upwards = [], []
    found = {index: names.find(name, sheet, *matrix.at(index, matrix.beside)) for index, name, _ in matrix.stations
             if _has_times(sheet, matrix, index)}  # fmt: skip
    others = [name for index, name, _ in matrix.stations if index not in found and not names.knows(name)]
    if others:
        notes.ignored.append(f"{sheet.label}: rows without times: {', '.join(map(shown, others))}")
    for index in matrix.unused:
        row, column = matrix.at(index, 0)
        cells = [
            text_of(cell)
            for cell in (sheet.rows[row] if matrix.down else (line[column] for line in sheet.rows))
            if cell is not None
        ]
        notes.ignored.append(f"{sheet.label}: {'row' if matrix.down else 'column'} {shown(' '.join(cells))}")
    for column, number in matrix.trains:
        draft = Draft(number, sheet, *matrix.at(matrix.head, column))
        for name, index in matrix.words.items():
            row, at = matrix.at(index, column)
            setattr(draft, name, text_of(sheet.rows[row][at]))
        entries = []
        for index, _, kind in matrix.stations:
            cell = matrix.at(index, column)
            station = found.get(index)
            said = time_at(sheet, *cell, notes.problems) if index in found else None
            if said is not None and (station is None or said.way == "bad"):
                draft.is_whole = False
            if said is not None and station is not None:
                entries.append(Entry(cell, station, said, kind))
        is_reversed = runs_upwards(entries)
        upwards += [number] * is_reversed
        draft.stops += _stops(entries[:: -1 if is_reversed else 1], is_reversed=is_reversed)
        drafts.append(draft)
    if upwards:
        way = "from the bottom to the top" if matrix.down else "from right to left"
        notes.read.append(f"{sheet.label}: read {way}, as their times run: {', '.join(map(shown, upwards))}")
    if not drafts:
        notes.problems.append(
            sheet.problem("no_trains", *matrix.at(matrix.head, matrix.beside), "no number of a train", "a row of them")
        )
    return drafts


def runs_upwards(entries: Sequence[Entry]) -> bool:
    """Tell whether the times of a train, in the order of the sheet, run from its end to its start.

    Times at one station say nothing, arrivals may stand above departures whatever the direction. A step of more than
    `MIDNIGHT_S` is taken to lead over midnight.
    """
    timed = [(entry.station.id, entry.said.seconds) for entry in entries if entry.said.seconds is not None]
    steps = [after - before for (here, before), (there, after) in pairwise(timed) if here != there]
    steps = [-step if abs(step) > MIDNIGHT_S else step for step in steps]
    return sum(step < 0.0 for step in steps) > sum(step > 0.0 for step in steps)


def _stops(entries: Sequence[Entry], *, is_reversed: bool) -> list[Stop]:
    """Return the calls of a train from its times in the order of the run; `is_reversed`: against that of the sheet."""
    stops: list[Stop] = []
    for entry in entries:
        before = stops[-1] if stops else None
        # A station that follows itself is a row of arrivals and one of departures.
        if before is not None and before.station is entry.station and entry.kind != "arrival":
            before.arrival, before.departure = before.arrival or before.departure, entry.said
        elif before is not None and before.station is entry.station and is_reversed and before.arrival is None:
            before.arrival = entry.said
        else:
            stop = Stop(*entry.at, entry.station)
            stop.arrival, stop.departure = (entry.said, None) if entry.kind == "arrival" else (None, entry.said)
            stops.append(stop)
    if is_reversed and stops:  # the words beside its ends are those of the other direction
        first, last = stops[0], stops[-1]
        first.arrival, first.departure = (None, first.arrival) if first.departure is None else (first.arrival, first.departure)
        last.arrival, last.departure = (last.departure, None) if last.arrival is None else (last.arrival, last.departure)
    return stops


def _has_times(sheet: Sheet, matrix: Matrix, index: int) -> bool:
    return any(
        sheet.rows[row][column] is not None or (row, column) in sheet.unsaved
        for row, column in (matrix.at(index, train) for train, _ in matrix.trains)
    )
