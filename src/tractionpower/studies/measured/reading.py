"""A measured file by its map: each series as a function of time with gaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import InputError, Problem, raise_errors
from tractionpower.io.measured_files import MapFile
from tractionpower.io.text_files import Source
from tractionpower.io.wording import counted, printable
from tractionpower.model.base import format_time
from tractionpower.model.measured import MeasuredMap, MeasuredSeries
from tractionpower.studies.measured.cells import Cells, read_cells
from tractionpower.studies.measured.numbers import DECIMALS, find_decimal, tell_bad, to_numbers
from tractionpower.studies.measured.samples import Samples, in_order, samples_of
from tractionpower.studies.measured.times import read_times

Array = NDArray[Any]

POWER = "power_kw"
COLUMN_CELLS = 50
"""Cells of a column that are kept as they are written, for messages."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A measured series.

    Attributes
    ----------
    series
        What the map says of it; of a power that is made of voltage and current, what it would say.
    time_s, values
        The rows that have a value [s], in the unit of the quantity.
    samples
        The same as a function.
    number
        Number of the series in the map; -1 for one that is made of others.
    written
        Some cells as they are written.
    """

    series: MeasuredSeries
    time_s: Array
    values: Array
    samples: Samples
    number: int = -1
    written: tuple[str, ...] = ()


@dataclass(slots=True)
class Measurement:
    """A measured file as read, and warnings."""

    series: list[Measured]
    problems: list[Problem] = field(default_factory=list)


def read_measurement(file: Path, told: MapFile, has_power: set[str]) -> Measurement:
    """Read a measured file.

    Parameters
    ----------
    file
        The file.
    told
        Its map.
    has_power
        Tables of the run that tell the power; where voltage and current of one of their things are measured and the power is
        not, it is made of both, row by row.

    Raises
    ------
    InputError
        With all that is wrong with the file.
    """
    asked = told.map
    source = Source(file, printable(file.name), "")
    headings = [each.column for each in asked.series]
    cells = read_cells(source, asked.time.column, headings, asked.delimiter, asked.encoding)
    problems = list(cells.problems)
    if asked.decimal is None:
        decimal, signs = find_decimal(cells, list(dict.fromkeys(headings)))
    else:
        decimal, signs = DECIMALS[asked.decimal], []
    problems += signs
    raise_errors(problems)  # with two decimal signs, cells that are no numbers say nothing new
    numbers: dict[str, Array] = {}
    for number, each in enumerate(asked.series):
        if each.column not in numbers:
            numbers[each.column], bad = to_numbers(cells.columns[each.column], decimal)
            problems += tell_bad(cells, each.column, bad, f"series[{number}].column", decimal)
    try:
        times, notes = read_times(cells, asked.time, decimal)
        problems += notes
    except InputError as error:
        raise InputError([*problems, *error.problems]) from None
    raise_errors(problems)
    return _as_functions(cells, times, numbers, asked, (problems, has_power))


def _as_functions(
    cells: Cells, times: Array, numbers: dict[str, Array], asked: MeasuredMap, rest: tuple[list[Problem], set[str]]
) -> Measurement:
    problems, has_power = rest
    rows = np.flatnonzero(np.isfinite(times))
    problems += _order_told(cells, times, rows)
    names = list(numbers)
    at, columns, _, _ = in_order(times[rows], *(numbers[name][rows] for name in names))
    by_name = dict(zip(names, columns, strict=True))
    found = Measurement([], problems)
    for number, each in enumerate(asked.series):
        values = by_name[each.column] * each.factor + each.offset
        written = tuple(cell for cell in cells.columns[each.column][: 20 * COLUMN_CELLS] if cell)[:COLUMN_CELLS]
        measured = _measured(each, at, values, asked)
        if len(measured.time_s) < 2:
            filled = f"{counted(len(measured.time_s), 'row')} with a value in column {each.column}"
            problems.append(Problem("no_rows", f"series[{number}].column", filled, "two or more", place=cells.label))
            continue
        found.series.append(replace(measured, number=number, written=written))
    raise_errors(problems)
    problems += _gaps_told(found.series, cells.label)
    found.series += _powers(found.series, asked, has_power)
    return found


def _measured(each: MeasuredSeries, at: Array, values: Array, asked: MeasuredMap) -> Measured:
    known = np.isfinite(values)
    # The usual distance is that of rows; a column that is filled in few of them has one of its own.
    samples = samples_of(at[known], values[known], asked.samples, asked.gap_s)
    return Measured(each, at[known], values[known], samples)


def _powers(series: list[Measured], asked: MeasuredMap, has_power: set[str]) -> list[Measured]:
    """Return the power of all things of which voltage and current are measured, and the power is not."""
    of: dict[str, dict[str, Measured]] = {}
    for each in series:
        of.setdefault(each.series.of, {})[each.series.quantity] = each
    made = []
    for subject, own in of.items():
        if POWER in own or not {"voltage_v", "current_a"} <= own.keys() or own["voltage_v"].series.table not in has_power:
            continue
        voltage, current = own["voltage_v"], own["current_a"]
        at, i, j = np.intersect1d(voltage.time_s, current.time_s, assume_unique=True, return_indices=True)
        if len(at) > 1:
            smoothing = max(voltage.series.smoothing_s, current.series.smoothing_s)
            column = f"{voltage.series.column} x {current.series.column}"
            told = MeasuredSeries(column=column, of=subject, quantity=POWER, smoothing_s=smoothing)
            made.append(_measured(told, at, voltage.values[i] * current.values[j] / 1000.0, asked))
    return made


def _order_told(cells: Cells, times: Array, rows: Array) -> list[Problem]:
    problems = []
    steps = np.diff(times[rows])
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        first = rows[back[0] + 1]
        found = f"{counted(int(back.size), 'time')} earlier than in the row before, the first {format_time(times[first])}"
        problems.append(_warn("unsorted_times", f"{found}; the rows are sorted", cells.place(int(first))))
    twice = np.flatnonzero(np.diff(np.sort(times[rows])) == 0.0)
    if twice.size:
        same = np.flatnonzero(steps == 0.0)
        place = cells.place(int(rows[same[0] + 1])) if same.size else cells.label
        found = f"{counted(int(twice.size), 'row')} with a time that another row has; rows of the same time are averaged"
        problems.append(_warn("duplicate_times", found, place))
    return problems


def _gaps_told(series: Sequence[Measured], label: str) -> list[Problem]:
    """Return one warning for all columns with the same gaps."""
    alike: dict[bytes, list[Measured]] = {}
    for each in series:
        if len(each.samples.gaps):
            alike.setdefault(each.samples.gaps.tobytes(), []).append(each)
    problems = []
    for own in alike.values():
        gaps, time_s = own[0].samples.gaps, own[0].time_s
        lengths = gaps[:, 1] - gaps[:, 0]
        longest = int(lengths.argmax())
        columns = ", ".join(each.series.column for each in own)
        found = (
            f"{counted(len(gaps), 'gap')} in {columns}: {100.0 * lengths.sum() / (time_s[-1] - time_s[0]):.1f} % of the time, the"
            f" longest {lengths[longest]:.1f} s from {format_time(gaps[longest, 0])} of the file's clock; gaps are not compared"
        )
        problems.append(_warn("gap", found, label))
    return problems


def _warn(code: str, found: str, place: str) -> Problem:
    return Problem(code, "", found, severity="warning", place=place)
