"""A run beside a measurement: the shift of the clock, both resampled, errors, and what is doubtful about it."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.errors import InputError, Problem, UsageError
from tractionpower.io.measured_files import MapFile, read_map
from tractionpower.model.base import format_time
from tractionpower.model.measured import PLACES, SUBJECTS, MeasuredMap
from tractionpower.model.quantity import unit_of
from tractionpower.results.results import Results
from tractionpower.results.tables import make_table
from tractionpower.results.versions import versions
from tractionpower.studies.measured.computed import Run
from tractionpower.studies.measured.doubts import doubts_of
from tractionpower.studies.measured.errors import Compared, errors_of, smoothed
from tractionpower.studies.measured.places import over_places
from tractionpower.studies.measured.reading import POWER, Measured, Measurement, read_measurement
from tractionpower.studies.measured.shift import Pair, Shift, find_shift

KIND = "measured"
"""What ``run.json`` calls a comparison with a measurement."""


@dataclass(frozen=True, slots=True)
class OneSeries:
    """A series in both, and how far they are apart."""

    measured: Measured
    compared: Compared
    errors: dict[str, float]

    @property
    def id(self) -> str:
        """Name of the series."""
        return self.measured.series.id


@dataclass(frozen=True, slots=True)
class Comparison:
    """A run beside a measurement.

    Attributes
    ----------
    series
        What was compared, in the order of the map.
    shift
        Of the clock; with align: distance none was looked for.
    problems
        Warnings, those of the file first.
    run
        What ``run.json`` says, without the files.
    """

    series: tuple[OneSeries, ...]
    shift: Shift
    problems: tuple[Problem, ...]
    run: dict[str, Any]

    def tables(self) -> dict[str, pa.Table]:
        """Return the tables of the comparison."""
        found = {
            "measured": _rows(self.series, self.run["measured"]["align"]),
            "measured_errors": _errors(self.series, self.shift),
        }
        return found if self.shift.shifts_s is None else found | {"measured_shift": _search(self.shift)}


def compare_measured(results: Results, file: Path, map_file: Path) -> Comparison:
    """Hold a measured file against a run.

    Parameters
    ----------
    results
        The run.
    file, map_file
        The measurement, and the map of its columns.

    Raises
    ------
    InputError
        With all that is wrong with the map, or with the file.
    UsageError
        If the results are of no run.
    """
    began = time.perf_counter()
    if not set(results.tables) & set(SUBJECTS.values()):
        raise UsageError("there are no tables of a run to compare with: give the folder that `tractionpower run` has written")
    told = read_map(map_file)
    run = Run(results)
    problems = run.problems(told.map, lambda number, key: told.place("series", number, key))
    if problems:
        raise InputError(problems)
    has_power = {each.table for each in told.map.series if run.has_power(each)}
    measurement = read_measurement(file, told, has_power)
    shift, series = _compared(run, measurement, told)
    doubts = [Problem("shift", "shift_s", words, severity="warning", place=told.place("shift_s")) for words in shift.doubts]
    apart = _apart(run, measurement, told, shift.shift_s) if told.map.align == "time" else []
    doubts += apart
    for each in series if not apart else ():
        doubts += _doubts(each, told)
    problems = [*measurement.problems, *doubts]
    note = _note(results, told.map, (file, map_file), shift, problems)
    note["wall_seconds"] = round(time.perf_counter() - began, 3)
    return Comparison(series, shift, tuple(problems), note)


def _compared(run: Run, measurement: Measurement, told: MapFile) -> tuple[Shift, tuple[OneSeries, ...]]:
    asked = told.map
    pairs = [Pair(run.series(each.series), each.samples) for each in measurement.series]
    if asked.align == "distance":
        own = {each.series.subject: each for each in measurement.series if each.series.quantity in PLACES}
        compared = []
        for each, pair in zip(measurement.series, pairs, strict=True):
            place = own[each.series.subject]
            computed_place = run.series(place.series)
            compared.append(over_places(pair.computed, computed_place, each, place, asked.every_m))
        return Shift(0.0), _judged(measurement, compared)
    if asked.shift_s == "find":
        by = [
            pair
            for each, pair in zip(measurement.series, pairs, strict=True)
            if each.number >= 0 and asked.on in (None, each.series.column)
        ]
        shift = find_shift(by, asked.shift_range_s)
    else:
        shift = Shift(float(asked.shift_s))
    series = zip(pairs, measurement.series, strict=True)
    return shift, _judged(measurement, [_over_time(pair, shift.shift_s, each) for pair, each in series])


def _over_time(pair: Pair, shift_s: float, each: Measured) -> Compared:
    computed = pair.computed
    measured = pair.measured.means(computed.windows - shift_s, computed.step_s)
    rows = round(each.series.smoothing_s / computed.every_s)
    both = [smoothed(values, rows) for values in (measured, computed.values)]
    return Compared(computed.time_s, both[0], both[1], computed.every_s)


def _judged(measurement: Measurement, compared: Iterable[Compared]) -> tuple[OneSeries, ...]:
    return tuple(
        OneSeries(each, values, errors_of(values, is_power=each.series.quantity == POWER and np.isfinite(values.every_s)))
        for each, values in zip(measurement.series, compared, strict=True)
    )


def _apart(run: Run, measurement: Measurement, told: MapFile, shift_s: float) -> list[Problem]:
    """Return a warning with the spans of both clocks, and the remedy, if the shifted measurement does not meet the run."""
    samples = [each.samples for each in measurement.series if each.samples.begin.size]
    computed = [one.windows for each in measurement.series if (one := run.series(each.series)).windows.size]
    if not samples or not computed:
        return []
    own = min(float(each[0]) for each in computed), max(float(each[-1]) for each in computed)
    there = min(float(each.begin[0]) for each in samples), max(float(each.end[-1]) for each in samples)
    if there[0] + shift_s < own[1] and there[1] + shift_s > own[0]:
        return []
    needed = round(own[0] - there[0])
    found = f"the measurement lasts from {_span(there)}, the run from {_span(own)}: no measured value falls on a computed one"
    remedy = f"say shift_s in the map: {needed} if both begin together"
    if told.map.shift_s == "find":
        remedy += f"; or let it be looked for further away than {told.map.shift_range_s:g} s by shift_range_s"
    return [Problem("apart", "shift_s", found, remedy=remedy, severity="warning", place=told.place("shift_s"))]


def _span(ends: tuple[float, float]) -> str:
    return " to ".join(format_time(seconds) for seconds in ends)


def _doubts(each: OneSeries, told: MapFile) -> list[Problem]:
    number, series = each.measured.number, each.measured.series
    if number < 0:
        return []
    place = told.place("series", number)
    if not each.errors["rows"]:
        found = f"{series.id}: no measured value falls on a computed one"
        remedy = "do the times fit? see time.start, time.date, utc_offset_h and shift_s of the map"
        return [Problem("no_overlap", f"series[{number}]", found, remedy=remedy, severity="warning", place=place)]
    problems = doubts_of(series, each.compared, each.errors, each.measured.written, place)
    return [replace(problem, path=f"series[{number}]", found=f"{series.id}: {problem.found}") for problem in problems]


def _note(
    results: Results, asked: MeasuredMap, files: tuple[Path, Path], shift: Shift, problems: Sequence[Problem]
) -> dict[str, Any]:
    texts = [hashlib.sha256(file.read_bytes()).hexdigest() for file in files]
    whole = hashlib.sha256(" ".join([str(results.run.get("input_hash")), *texts]).encode())
    found = {
        name: None if not np.isfinite(value := getattr(shift, name)) else round(float(value), 6)
        for name in ("shift_s", "correlation", "width_s", "rival_s", "rival_correlation")
    }
    return {
        "format": 1,
        "status": "complete",
        "study": f"{results.run.get('study', '')}-{KIND}",
        "name": str(results.run.get("name") or results.run.get("study", "")),
        "input_hash": whole.hexdigest(),
        "kind": KIND,
        "versions": versions(),
        "verdicts": [],
        "measured": {
            "name": asked.name,
            "source": asked.source,
            "file": files[0].name,
            "sha256": texts[0],
            "map": asked.model_dump(mode="json", exclude_defaults=True),
            "run_input_hash": results.run.get("input_hash"),
            "align": asked.align,
            "shift_found": asked.shift_s == "find" and asked.align == "time",
            **found,
            "warnings": [str(problem) for problem in problems],
        },
    }


def _text(texts: Sequence[str]) -> tuple[list[int], list[str]]:
    names = list(dict.fromkeys(texts))
    number = {name: code for code, name in enumerate(names)}
    return [number[text] for text in texts], names


def _rows(series: Sequence[OneSeries], align: str) -> pa.Table:
    lengths = [len(each.compared.at) for each in series]
    at = np.concatenate([each.compared.at for each in series])
    nowhere = np.full(len(at), np.nan)
    measured = np.concatenate([each.compared.measured for each in series])
    computed = np.concatenate([each.compared.computed for each in series])
    columns = {
        "series": (np.repeat(np.arange(len(series)), lengths), [each.id for each in series]),
        "time_s": at if align == "time" else nowhere,
        "position_km": nowhere if align == "time" else at,
        "measured": measured,
        "computed": computed,
        "error": computed - measured,
    }
    return make_table("measured", columns)


def _errors(series: Sequence[OneSeries], shift: Shift) -> pa.Table:
    def numbers(name: str) -> list[float]:
        return [each.errors[name] for each in series]

    asked = [each.measured.series for each in series]
    gaps = [np.diff(each.measured.samples.gaps, axis=1).ravel() for each in series]
    in_time = [np.isfinite(each.compared.every_s) for each in series]
    columns: dict[str, Any] = {
        "series": _text([each.id for each in series]),
        "subject": _text([each.of for each in asked]),
        "quantity": _text([each.quantity for each in asked]),
        "unit": _text([unit_of(each.quantity) for each in asked]),
        "column": _text([each.column for each in asked]),
        "rows": [int(each.errors["rows"]) for each in series],
        "gaps": [len(own) for own in gaps],
        "longest_gap_s": [float(own.max(initial=0.0)) for own in gaps],
        "smoothing_s": [each.smoothing_s for each in asked],
        "shift_s": [shift.shift_s if known else np.nan for known in in_time],
    }
    same = "share_percent mean_measured mean_computed mean_error mean_absolute_error rms_measured rms_computed rms_error"
    for name in (f"{same} relative_percent correlation energy_error_percent").split():
        columns[name] = numbers(name)
    for name in ("energy_measured", "energy_computed"):
        columns[f"{name}_kwh"] = numbers(name)
    for name in ("lowest_measured", "lowest_computed", "highest_measured", "highest_computed"):
        columns[name] = numbers(name)
        at = numbers(f"{name}_at")
        columns[f"{name}_s"] = [value if known else np.nan for value, known in zip(at, in_time, strict=True)]
        columns[f"{name}_km"] = [np.nan if known else value for value, known in zip(at, in_time, strict=True)]
    return make_table("measured_errors", columns)


def _search(shift: Shift) -> pa.Table:
    return make_table("measured_shift", {"shift_s": shift.shifts_s, "correlation": shift.correlations})
