"""The tables of a GTFS feed as they are: a folder or a zip, texts only, what is missing told once."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from tractionpower.errors import Problem
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import printable

WEEKDAYS = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday")

# Columns without which a file cannot be used, and those that are used where they are there.
_NEEDED = {
    "routes": ("route_id", "route_type"),
    "trips": ("route_id", "service_id", "trip_id"),
    "stops": ("stop_id", "stop_lat", "stop_lon"),
    "stop_times": ("trip_id", "stop_id", "stop_sequence"),
    "calendar": ("service_id", *WEEKDAYS, "start_date", "end_date"),
    "calendar_dates": ("service_id", "date", "exception_type"),
    "shapes": ("shape_id", "shape_pt_lat", "shape_pt_lon", "shape_pt_sequence"),
    "frequencies": ("trip_id", "start_time", "end_time", "headway_secs"),
    "agency": ("agency_name",),
}
_USED = {
    "routes": ("agency_id", "route_short_name", "route_long_name"),
    "trips": ("trip_short_name", "direction_id", "block_id", "shape_id"),
    "stops": ("stop_name", "parent_station"),
    "stop_times": ("arrival_time", "departure_time", "pickup_type", "drop_off_type"),
    "frequencies": ("exact_times",),
    "agency": ("agency_id",),
}
_REQUIRED = ("routes", "trips", "stops", "stop_times")


@dataclass(frozen=True, slots=True)
class Feed:
    """Tables by the names of their files without `.txt`; all cells are trimmed texts, absent columns are empty.

    The index of a table counts its rows from 0, so that row k stands about in line k + 2 of its file.
    """

    tables: Mapping[str, pd.DataFrame]

    def table(self, name: str) -> pd.DataFrame:
        """Return a table; an empty one with its columns where the feed has none."""
        if name in self.tables:
            return self.tables[name]
        return pd.DataFrame({column: pd.Series(dtype=str) for column in (*_NEEDED[name], *_USED.get(name, ()))})

    def has(self, name: str) -> bool:
        """Return whether a table is there and has rows."""
        return name in self.tables and not self.tables[name].empty


def read_feed(source: Path, notes: Notes, *, repair: bool) -> Feed:
    """Read the tables of a feed; what is missing or cannot be read goes to the problems of `notes`.

    Parameters
    ----------
    source
        A folder, or a zip file.
    notes
        Takes what is told.
    repair
        Read a file that is not UTF-8 as Windows-1252.
    """
    files = _files(source, notes)
    if files is None:
        return Feed({})
    tables = {}
    for name in _NEEDED:
        if f"{name}.txt" in files:
            table = _read(name, files[f"{name}.txt"], notes, repair=repair)
            if table is not None:
                tables[name] = table
        elif name in _REQUIRED:
            found = f"the feed has no {name}.txt"
            notes.problems.append(Problem("missing_file", "", found, remedy="is it a GTFS feed?", place=printable(source.name)))
    others = sorted(set(files) - {f"{name}.txt" for name in _NEEDED})
    if others:
        notes.ignored.append(f"files of the feed that say nothing about runs of trains: {', '.join(map(printable, others))}")
    return Feed(tables)


def rows_of(table: pd.DataFrame) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the rows of a table: the line of its file, and the cells by column."""
    for index, row in zip(table.index, table.to_dict("records"), strict=True):
        yield int(index) + 2, {str(name): cell for name, cell in row.items()}


def first_line(table: pd.DataFrame) -> int:
    """Return the line of its file in which the first row of a table stands."""
    return int(table.index[0]) + 2


def _files(source: Path, notes: Notes) -> dict[str, bytes] | None:
    label = printable(source.name or str(source))
    try:
        if source.is_dir():
            return {path.name.lower(): path.read_bytes() for path in sorted(source.iterdir()) if path.suffix.lower() == ".txt"}
        with zipfile.ZipFile(source) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".txt")]
            names.sort(key=lambda name: -name.count("/"))  # of files with one name the outermost is taken
            return {name.rpartition("/")[2].lower(): archive.read(name) for name in names}
    except FileNotFoundError:
        notes.problems.append(Problem("missing_file", "", "there is no such file or folder", "a GTFS feed", place=label))
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError):
        found = "the file is no zip that can be read"
        notes.problems.append(Problem("bad_zip", "", found, "a folder or a zip file", place=label))
    except OSError as error:
        found = f"it cannot be read: {printable(error.strerror or str(error))}"
        notes.problems.append(Problem("unreadable_file", "", found, place=label))
    return None


def _read(name: str, raw: bytes, notes: Notes, *, repair: bool) -> pd.DataFrame | None:
    label = f"{name}.txt"
    text = _text(label, raw, notes, repair=repair)
    if text is None:
        return None
    wanted = (*_NEEDED[name], *_USED.get(name, ()))
    try:
        read = pd.read_csv(
            io.StringIO(text),
            dtype=str,
            keep_default_na=False,
            skipinitialspace=True,
            index_col=False,
            usecols=lambda column: column.strip().lower() in wanted,
        )
    except pd.errors.EmptyDataError:
        notes.problems.append(Problem("empty_file", "", "the file is empty", f"a header with {', '.join(wanted)}", place=label))
        return None
    except (pd.errors.ParserError, ValueError) as error:
        found = f"the file is no table that can be read: {printable(str(error))}"
        notes.problems.append(Problem("csv_syntax", "", found, "CSV with commas", place=label))
        return None
    read.columns = [column.strip().lower() for column in read.columns]
    missing = [column for column in _NEEDED[name] if column not in read.columns]
    if missing:
        found = f"no column {', '.join(missing)}"
        remedy = "columns are separated by commas" if len(missing) == len(_NEEDED[name]) else ""
        notes.problems.append(Problem("missing_column", "", found, ", ".join(_NEEDED[name]), remedy, place=label))
        return None
    table = pd.DataFrame({column: _cells(read, column) for column in wanted}, index=read.index)
    return table[~(table == "").all(axis=1)]


def _cells(read: pd.DataFrame, column: str) -> pd.Series[str]:
    if column not in read.columns:
        return pd.Series("", index=read.index, dtype=str)
    return read[column].fillna("").astype(str).str.strip()


def _text(label: str, raw: bytes, notes: Notes, *, repair: bool) -> str | None:
    for text in _decoded(raw, ("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig",)):
        return text
    if repair:
        notes.repaired.append(f"{label} is not UTF-8 and was read as Windows-1252; look at the names")
        return raw.decode("cp1252", errors="replace")
    remedy = "save it as UTF-8 text; with repair it is read as Windows-1252"
    notes.problems.append(Problem("not_utf8", "", "the file is not UTF-8", "UTF-8", remedy, place=label))
    return None


def _decoded(raw: bytes, encodings: tuple[str, ...]) -> Iterator[str]:
    for encoding in encodings:
        try:
            yield raw.decode(encoding)
        except UnicodeDecodeError:
            continue
