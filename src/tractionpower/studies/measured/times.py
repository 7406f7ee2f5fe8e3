"""Measured times in seconds after midnight of the study's day: seconds, clock, dates, days of spreadsheets."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.errors import InputError, Problem
from tractionpower.io.wording import counted, shown
from tractionpower.model.base import DAY_S
from tractionpower.model.measured import MeasuredTime
from tractionpower.studies.measured.cells import Cells
from tractionpower.studies.measured.numbers import MISSING, MOST_BAD, to_numbers

Array = NDArray[Any]

LOOKED_AT = 20
"""Cells by which the way of writing is found."""

EXCEL_ZERO = date(1899, 12, 30)
EXCEL_DAYS = (20_000.0, 80_000.0)
"""Days of spreadsheets for the years 1954 to 2119: numbers like these that hardly rise are no seconds."""

EVENING_S, MORNING_S = 0.75 * DAY_S, 0.25 * DAY_S
"""A time of day after the first [s] that is followed by one before the second is followed by the next day."""

UNIX_S = 1e8
"""Seconds beyond this are counted since 1970."""

_CLOCK = r"(\d{1,3}):([0-5]?\d)(?::([0-5]?\d(?:[.,]\d+)?))?"
_OFFSET = re.compile(r"(?:Z|[+-]\d\d:?(?:\d\d)?)$")
ALLOWED = (
    "seconds, unix (seconds since 1970), HH:MM:SS, YYYY-MM-DD HH:MM:SS, excel (days of a spreadsheet), or a pattern such as"
    " %d.%m.%Y %H:%M:%S"
)


def read_times(cells: Cells, told: MeasuredTime, decimal: str) -> tuple[Array, list[Problem]]:
    """Return the times of the rows [s], NaN where there is none, and warnings.

    Parameters
    ----------
    cells
        The file.
    told
        What the map says of the column of times.
    decimal
        Decimal sign of numbers.

    Raises
    ------
    InputError
        If the times cannot be read.
    """
    texts = cells.columns[told.column]
    form = told.format or _find_format(cells, told, decimal)
    problems: list[Problem] = []
    if form in ("seconds", "excel", "unix"):
        times = _numbered(cells, told, decimal, form, problems)
    elif form == "clock":
        parts = pd.Series(texts, dtype=object).str.fullmatch(_CLOCK)
        found = pd.Series(texts, dtype=object).where(parts, "").str.extract(f"^{_CLOCK}$")
        found[2] = found[2].fillna("0").str.replace(",", ".", regex=False)
        hours, minutes, seconds = (np.array(pd.to_numeric(found[k], errors="coerce"), float) for k in range(3))
        times = over_midnight(hours * 3600.0 + minutes * 60.0 + seconds)
    else:
        times = _dated(texts, told, form, problems)
    problems += _tell_bad(cells, told, times, form)
    if any(problem.severity == "error" for problem in problems):
        raise InputError(problems)
    return times, problems


def over_midnight(times: Array) -> Array:
    """Return times of day [s] with a day added wherever the evening is followed by the morning.

    Any other fall is a row out of its order, or a time that is wrong: it moves nothing but itself.
    """
    known = np.flatnonzero(np.isfinite(times))
    own = times[known]
    before = np.concatenate((own[:1], own[:-1]))
    falls = (before >= EVENING_S) & (before < DAY_S + 1.0) & (own < MORNING_S)
    times = times.copy()
    times[known] += DAY_S * np.cumsum(falls)
    return times


def _find_format(cells: Cells, told: MeasuredTime, decimal: str) -> str:
    texts = cells.columns[told.column]
    rows = [row for row, text in enumerate(texts) if text.lower() not in MISSING][:LOOKED_AT]
    first = [texts[row] for row in rows]
    if first:
        if not to_numbers(first, decimal)[1]:
            return "seconds"
        if all(re.fullmatch(_CLOCK, text) for text in first):
            return "clock"
        if not np.isnat(_parsed(first, "iso")).any():
            return "iso"
    found = f"times such as {shown(first[0])}" if first else "no times"
    remedy = "say time.format in the map"
    raise InputError([Problem("bad_time", "time.format", found, ALLOWED, remedy, place=cells.place(rows[0] if rows else 0))])


def _numbered(cells: Cells, told: MeasuredTime, decimal: str, form: str, problems: list[Problem]) -> Array:
    numbers, _ = to_numbers(cells.columns[told.column], decimal)
    known = numbers[np.isfinite(numbers)]
    if form == "excel":
        whole = _day_of(told, float(np.floor(known.min())) if known.size else 0.0)
        return np.asarray((numbers - whole) * DAY_S)
    if form == "unix":
        local = numbers + (told.utc_offset_h or 0.0) * 3600.0
        return np.asarray(local - _midnight(told, float(local[np.isfinite(local)][0]) if known.size else 0.0))
    if known.size and known.min() > UNIX_S:
        found = f"times from {known.min():.0f}: they look like seconds since 1970"
        problems.append(
            Problem("time_unit", "time.format", found, "seconds", "say format: unix in the map", place=cells.place(0))
        )
    steps = np.diff(known)
    inside = known.size > 2 and EXCEL_DAYS[0] < known.min() and known.max() < EXCEL_DAYS[1]
    if inside and 0.0 < float(np.median(steps)) < 1e-2 and float(np.ptp(known)) < 40.0:
        found = f"times from {known.min():.5f} to {known.max():.5f}: they look like days of a spreadsheet"
        problems.append(
            Problem("time_unit", "time.format", found, "seconds", "say format: excel in the map", place=cells.place(0))
        )
    return over_midnight(numbers) + told.start


def _day_of(told: MeasuredTime, found: float) -> float:
    return float((date.fromisoformat(told.date) - EXCEL_ZERO).days) if told.date else found


def _dated(texts: Sequence[str], told: MeasuredTime, form: str, problems: list[Problem]) -> Array:
    """Return seconds of dates after midnight of the study's day, in local time."""
    stamps = _parsed(texts, form)
    known = np.flatnonzero(~np.isnat(stamps))
    times = np.full(len(texts), np.nan)
    if not known.size:
        return times
    first = texts[known[0]]
    own = _OFFSET.search(first) if form == "iso" and ":" in first else None
    local_h = told.utc_offset_h or 0.0
    if own is not None and told.utc_offset_h is None:
        local_h = _hours(own[0])
        if local_h == 0.0:
            found = f"the times are UTC, as in {shown(first)}"
            remedy = "say utc_offset_h in the map if the study's clock is another"
            problems.append(Problem("utc", "time.utc_offset_h", found, remedy=remedy, severity="warning"))
    seconds = (stamps - np.datetime64(0, "s")) / np.timedelta64(1, "ns") * 1e-9 + local_h * 3600.0
    if "%" in form and not any(sign in form for sign in ("%d", "%j", "%x", "%c", "%D", "%s")):
        return over_midnight(np.asarray(seconds % DAY_S))
    return np.asarray(seconds - _midnight(told, float(seconds[known[0]])))


def _midnight(told: MeasuredTime, first: float) -> float:
    """Return the beginning of the study's day [s since 1970]."""
    day = (date.fromisoformat(told.date) - date(1970, 1, 1)).days if told.date else np.floor(first / DAY_S)
    return float(day) * DAY_S


def _parsed(texts: Sequence[str], form: str) -> Array:
    """Return UTC, or what the text says where it has no offset, as numpy's times."""
    cells = pd.Series(list(texts), dtype=object)
    if form == "iso":
        cells, form = cells.str.replace(",", ".", regex=False), "ISO8601"
    return np.array(pd.to_datetime(cells, format=form, errors="coerce", utc=True).dt.tz_localize(None), "datetime64[ns]")


def _hours(offset: str) -> float:
    if offset == "Z":
        return 0.0
    digits = offset[1:].replace(":", "").ljust(4, "0")
    return (int(digits[:2]) + int(digits[2:]) / 60.0) * (-1.0 if offset[0] == "-" else 1.0)


def _tell_bad(cells: Cells, told: MeasuredTime, times: Array, form: str) -> list[Problem]:
    bad = np.flatnonzero(~np.isfinite(times))
    if not bad.size:
        return []
    severity = "error" if bad.size > MOST_BAD * len(times) else "warning"
    text = cells.columns[told.column][bad[0]]
    found = f"{counted(int(bad.size), 'row')} of {len(times)} without a time of format {form}, the first {shown(text)}"
    remedy = "say time.format in the map" if severity == "error" else "the rows are left out"
    return [Problem("bad_time", "time.column", found, ALLOWED, remedy, severity, cells.place(int(bad[0])))]  # type: ignore[arg-type]
