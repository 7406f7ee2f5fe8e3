"""Timetables with a row for every call: train, station, arrival, departure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tractionpower.io.excel import Sheet
from tractionpower.io.imports.imported import Notes
from tractionpower.io.imports.tables.drafts import Draft, Stop, time_at
from tractionpower.io.imports.tables.headings import field_of, stops_of, text_of
from tractionpower.io.imports.tables.station_names import StationNames
from tractionpower.io.wording import shown

LOOKED_AT = 30
"""Rows at the top of a sheet in which a header may stand."""

_TIMES = ("arrival", "departure", "time")


@dataclass(frozen=True, slots=True)
class Header:
    """Row of the headings, and the column of each field."""

    row: int
    columns: Mapping[str, int]


def find_header(sheet: Sheet) -> Header | None:
    """Return the header of a long table, or None if the sheet has none."""
    for row, cells in enumerate(sheet.rows[:LOOKED_AT]):
        columns: dict[str, int] = {}
        for column, cell in enumerate(cells):
            name = field_of(cell)
            if name is not None:
                columns.setdefault(name, column)
        if {"train", "station"} <= columns.keys() and any(name in columns for name in _TIMES):
            return Header(row, columns)
    return None


def read_long(sheet: Sheet, header: Header, names: StationNames, notes: Notes) -> list[Draft]:
    """Return the trains of a long table in the order of the file."""
    drafts: dict[str, Draft] = {}
    order: dict[int, float] = {}
    _tell_columns(sheet, header, notes)
    remarks = _remarks(sheet, header)
    notes.ignored += [f"{sheet.place(row)}: {shown(text)}, a remark" for row, text in remarks.items()]
    for row in range(header.row + 1, len(sheet.rows)):
        texts = {name: text_of(sheet.rows[row][column]) for name, column in header.columns.items()}
        if row in remarks or not any(texts.values()):
            continue
        if not texts["train"] or not texts["station"]:
            lacking = "train" if not texts["train"] else "station"
            notes.problems.append(sheet.problem("empty_cell", row, header.columns[lacking], f"no {lacking} in the row"))
            continue
        draft = drafts.setdefault(texts["train"], Draft(texts["train"], sheet, row, header.columns["train"]))
        _add_words(draft, texts, row, notes)
        stop = _stop(sheet, header, row, names, notes)
        if stop is None or "bad" in (each.way for each in (stop.arrival, stop.departure) if each is not None):
            draft.is_whole = False
        if stop is not None:
            draft.stops.append(stop)
            order[id(stop)] = _order(sheet, header, row, notes)
    for draft in drafts.values():
        draft.stops.sort(key=lambda stop: order[id(stop)])
    return list(drafts.values())


def _remarks(sheet: Sheet, header: Header) -> dict[int, str]:
    """Return rows with a single text that is no train of the table, behind an empty row or under all calls; and the texts.

    A text beside the columns of the table is one wherever it stands.
    """
    filled = {row: [k for k, cell in enumerate(sheet.rows[row]) if cell is not None] for row in range(len(sheet.rows))}
    train, station = header.columns["train"], header.columns["station"]
    calls = [row for row in filled if row > header.row and {train, station} <= set(filled[row])]
    numbers = {text_of(sheet.rows[row][train]) for row in calls}
    unsaved = {row for row, _ in sheet.unsaved}
    remarks: dict[int, str] = {}
    for row in range(header.row + 1, len(sheet.rows)):
        cells = filled[row]
        is_apart = not filled[row - 1] or sheet.lines[row] > sheet.lines[row - 1] + 1 or row - 1 in remarks
        text = " ".join(text_of(sheet.rows[row][k]) for k in cells)
        if cells and not set(cells) & set(header.columns.values()):
            remarks[row] = text
        elif len(cells) == 1 and (is_apart or row > max(calls, default=row)) and text not in numbers and row not in unsaved:
            remarks[row] = text
    return remarks


def _tell_columns(sheet: Sheet, header: Header, notes: Notes) -> None:
    used = set(header.columns.values())
    others = [text_of(cell) for column, cell in enumerate(sheet.rows[header.row]) if cell is not None and column not in used]
    if others:
        notes.ignored.append(f"{sheet.label}: columns {', '.join(map(shown, others))}")
    if "km" in header.columns:
        notes.ignored.append(f"{sheet.label}: kilometres of the file; those of the line count")


def _add_words(draft: Draft, texts: Mapping[str, str], row: int, notes: Notes) -> None:
    """Note what a row says of the train as a whole; all its rows must say the same."""
    for name in ("train_type", "category", "days"):
        said, known = texts.get(name, ""), getattr(draft, name)
        if said and known and said != known:
            found = f"{name.replace('_', ' ')} {shown(said)}, in an earlier row {shown(known)}"
            notes.problems.append(
                draft.sheet.problem("two_values", row, draft.column, f"train {shown(draft.id)}: {found}", "one")
            )
        elif said:
            setattr(draft, name, said)


def _stop(sheet: Sheet, header: Header, row: int, names: StationNames, notes: Notes) -> Stop | None:
    at = header.columns
    station = names.find(text_of(sheet.rows[row][at["station"]]), sheet, row, at["station"])
    times = {name: time_at(sheet, row, at[name], notes.problems) for name in _TIMES if name in at}
    if station is None:
        return None
    stop = Stop(row, at["station"], station, times.get("arrival"), times.get("departure"))
    if times.get("time") is not None and stop.departure is None:
        stop.departure = times["time"]
    stop.track = text_of(sheet.rows[row][at["track"]]) if "track" in at else ""
    if "stops" in at and (said := sheet.rows[row][at["stops"]]) is not None:
        stop.stops = stops_of(said)
        if stop.stops is None:
            notes.problems.append(sheet.problem("bad_word", row, at["stops"], shown(text_of(said)), "yes or no, stop or pass"))
    if "min_dwell_s" in at:
        stop.min_dwell_s = _number(sheet, row, at["min_dwell_s"], notes)
    return stop


def _number(sheet: Sheet, row: int, column: int, notes: Notes) -> float | None:
    text = text_of(sheet.rows[row][column])
    if not text:
        return None
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 86400.0:
        notes.problems.append(sheet.problem("bad_number", row, column, shown(text), "seconds from 0 on"))
        return None
    return value


def _order(sheet: Sheet, header: Header, row: int, notes: Notes) -> float:
    if "order" not in header.columns:
        return float(row)
    value = _number(sheet, row, header.columns["order"], notes)
    return float(row) if value is None else value
