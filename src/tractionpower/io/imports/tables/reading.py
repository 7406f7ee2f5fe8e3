"""Timetables from CSV files and Excel workbooks: long (a row for every call) or as a matrix, into a study with a line."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tractionpower.errors import Problem, UsageError
from tractionpower.io.excel import Sheet
from tractionpower.io.finder import STUDY_FILE
from tractionpower.io.imports.imported import Imported, Notes
from tractionpower.io.imports.tables.drafts import Draft
from tractionpower.io.imports.tables.frames import TIMETABLE, Frame, find_frame
from tractionpower.io.imports.tables.grids import read_grids
from tractionpower.io.imports.tables.long_form import find_header, read_long
from tractionpower.io.imports.tables.matrix_form import find_matrix, read_matrix
from tractionpower.io.imports.tables.settling import Settler
from tractionpower.io.imports.tables.station_names import StationNames
from tractionpower.io.imports.tables.ways import Ways, usual_tracks
from tractionpower.io.stock_finder import known_rolling_stock
from tractionpower.io.wording import counted, printable, shown
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT, format_time
from tractionpower.model.line import Line
from tractionpower.model.timetable import Timetable


def read_table_timetable(
    source: Path,
    folder: Path,
    *,
    line: str | None = None,
    train: str | None = None,
    tracks: str | None = None,
    sheet: str | None = None,
    dwell_s: float | None = None,
) -> Imported:
    """Read a timetable from a CSV file or an Excel workbook.

    Parameters
    ----------
    source
        The file.
    folder
        Folder of the study that it goes into.
    line
        Study whose line, supply and rolling stock are copied; None: those of `folder` count.
    train
        Train of runs for which the file names none.
    tracks
        Tracks of trains with rising and with falling kilometres, ``1,2``; None: the first two that lie side by side.
    sheet
        The sheet to read; None: all that hold a timetable.
    dwell_s
        Shortest dwell at stops for which the file gives none [s].

    Raises
    ------
    UsageError
        If there is no line, or an option does not fit.
    InputError
        If the files of the line have errors.
    """
    notes = Notes()
    frame = find_frame(folder, line, notes)
    usual = _usual(frame.line, tracks, notes)
    drafts = _drafts(read_grids(source, sheet, notes), frame.line, notes)
    settler = Settler(Ways(frame.line, usual), known_rolling_stock("trains", frame.folder), train, dwell_s)
    runs = [run for draft in drafts if (run := settler.run(draft)) is not None]
    notes.problems += settler.problems + settler.doubts
    notes.problems.sort(key=_in_file)
    if not any(problem.severity == "error" for problem in notes.problems):
        notes.problems += _refused(runs)
    if any(problem.severity == "error" for problem in notes.problems):
        return Imported({}, notes)
    notes.read.append(f"{counted(len(runs), 'train')} with {sum(len(run['calls']) for run in runs)} calls")
    notes.assumed += settler.told()
    return Imported(_texts(source, frame, runs, (min(settler.span_s), max(settler.span_s)), notes), notes)


def _in_file(problem: Problem) -> tuple[str, int]:
    """Return file or sheet and line of a problem, for the order in which it is told."""
    label, _, line = problem.place.rpartition(":")
    return (label, int(line)) if line.isdecimal() else (problem.place, 0)


def _usual(line: Line, tracks: str | None, notes: Notes) -> tuple[str, str] | None:
    """Return the tracks of both directions: those that are named, or the first two side by side."""
    if tracks is None:
        usual = usual_tracks(line)
        if usual is not None:
            words = f"trains with rising kilometres run on track {usual[0]}, with falling ones on track {usual[1]}"
            notes.assumed.append(
                f"{words} where a column track does not say otherwise (--tracks {usual[1]},{usual[0]} turns it round)"
            )
        return usual
    named = [word.strip() for word in tracks.split(",")]
    known = [track.id for track in line.tracks]
    if len(named) not in (1, 2) or not set(named) <= set(known):
        raise UsageError(
            f"--tracks {tracks}: give the tracks of rising and falling kilometres, such as 1,2; the line has {known}"
        )
    return named[0], named[-1]


def _drafts(sheets: Sequence[Sheet], line: Line, notes: Notes) -> list[Draft]:
    names = StationNames(line)
    drafts: list[Draft] = []
    useless: list[Sheet] = []
    for sheet in sheets:
        header = find_header(sheet)
        matrix = find_matrix(sheet, names) if header is None else None
        if header is not None:
            notes.read.append(f"{sheet.label}: a row for every call, from line {sheet.lines[header.row]} on")
            drafts += read_long(sheet, header, names, notes)
        elif matrix is not None:
            notes.read.append(f"{sheet.label}: a matrix, stations {'down' if matrix.down else 'across'}")
            drafts += read_matrix(sheet, matrix, names, notes)
        else:
            useless.append(sheet)
    if len(useless) == len(sheets):
        notes.problems += [_no_timetable(sheet, line) for sheet in useless]
    else:
        notes.ignored += [f"{sheet.label}: no timetable" for sheet in useless]
    notes.problems += names.problems()
    return _told_apart(drafts, notes)


def _no_timetable(sheet: Sheet, line: Line) -> Problem:
    found = "no timetable: no headings train, station and arrival or departure, and fewer than two stations of the line"
    stations = ", ".join(station.name or station.id for station in line.stations[:6])
    return Problem("no_timetable", "", found, f"see docs/imports.md; stations of the line: {stations}", place=sheet.label)


def _told_apart(drafts: Sequence[Draft], notes: Notes) -> list[Draft]:
    """Return the trains that have calls; two of one number are an error."""
    kept: dict[str, Draft] = {}
    for draft in drafts:
        if not draft.stops and not notes.problems:
            notes.ignored.append(f"{draft.sheet.label}: train {shown(draft.id)} has no times")
            continue
        first = kept.setdefault(draft.id, draft)
        if first is not draft:
            found = f"a second train of this number, first in {first.sheet.label}:{first.sheet.lines[first.row]}"
            notes.problems.append(draft.problem("duplicate_id", found, "each number once", "number the runs of other days apart"))
    return list(kept.values())


def _refused(runs: list[dict[str, Any]]) -> list[Problem]:
    """Return what the declaration of the timetable refuses, such as an identifier with brackets."""
    if not runs:
        return [Problem("no_trains", "", "no train in the file", "one or more")]
    try:
        Timetable.model_validate({"trains": runs})
    except ValidationError as error:
        return [
            Problem("refused", ".".join(map(str, fault["loc"])), f"{shown(fault['input'])}: {fault['msg']}")
            for fault in error.errors(include_url=False)
        ]
    return []


def _texts(source: Path, frame: Frame, runs: list[dict[str, Any]], span_s: tuple[float, float], notes: Notes) -> dict[str, str]:
    """Return the files to write: the timetable, and what makes a study of it."""
    name = printable(source.name)
    head = f"# Imported from {name} by `tractionpower import timetable`.\n"
    file = frame.study.timetable if frame.study is not None and not frame.is_new else TIMETABLE
    texts = frame.texts | {file or TIMETABLE: head + document({"format": FORMAT, "trains": runs})}
    if frame.is_new:
        texts[STUDY_FILE] = frame.study_text(*span_s, f"Timetable of {name}")
        notes.assumed.append(f"the clock of {STUDY_FILE} takes in all trains, at full hours")
    elif frame.study is not None:
        begin, end = frame.study.clock.start, frame.study.clock.end
        if span_s[0] < begin or span_s[1] > end:
            times = f"trains run from {format_time(span_s[0])} to {format_time(span_s[1])}"
            found = f"{times}, the clock of {STUDY_FILE} from {format_time(begin)} to {format_time(end)}"
            notes.problems.append(
                Problem("outside_clock", "clock", found, remedy="set the clock", severity="warning", place=STUDY_FILE)
            )
        if frame.study.timetable is None:
            found, remedy = f"{STUDY_FILE} names no timetable", f"add `timetable: {TIMETABLE}` to it"
            notes.problems.append(Problem("not_named", "timetable", found, remedy=remedy, severity="warning", place=STUDY_FILE))
    return texts
