"""The workbook of a comparison with a measurement: what was compared, errors, values, charts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.report import Report
from tractionpower.reporting.texts import language
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Subject
from tractionpower.reporting.workbook.frame.page import Block, Column, Page, heading_of
from tractionpower.reporting.workbook.frame.plots import COLOURS, Line, draw, scatter, show_clock
from tractionpower.reporting.workbook.frame.saving import save_as
from tractionpower.results.columns import TABLES
from tractionpower.results.results import Results

MOST_ROWS = 2000
"""Rows of a series in the workbook; of more every n-th stands there."""

MOST_SERIES, MOST_CHARTS = 40, 12

_FORMATS = {"s": "time", "kwh": "0.00", "percent": "0.00", "km": "0.000"}
_TEXTS = ("series", "subject", "quantity", "unit", "column")
_WHOLE = ("rows", "gaps")
_LENGTHS = ("shift_s", "smoothing_s", "longest_gap_s")
_MEANS = (
    "mean_measured", "mean_computed", "mean_error", "mean_absolute_error", "rms_measured", "rms_computed", "rms_error",
    "relative_percent", "correlation",
)  # fmt: skip
_ENERGY = ("energy_measured_kwh", "energy_computed_kwh", "energy_error_percent")
_DATA = ("column", "rows", "share_percent", "shift_s", "smoothing_s", "gaps", "longest_gap_s")
TIME, KM, MEASURED, COMPUTED, ERROR = "time of day", "place [km]", "measured", "computed", "error"


def write_measured_workbook(results: Results, path: Path, report: Report | None = None) -> Path:
    """Write the workbook and return where it is."""
    report = report or Report()
    with language(report.language):
        book = Book(Subject(results), report)
        errors = book.page("Errors", shorten(f"{book.subject.study}: run and measurement", 120))
        charts = book.page("Charts", "Charts: measured and computed")
        values = book.page("Values", "Values: measured, computed, error")
        _errors(errors, results, results.table("measured_errors"))
        _values(values, charts, results.table("measured"), results.table("measured_errors"))
        book.finish()
        return save_as(book, path)


def _errors(page: Page, results: Results, errors: pd.DataFrame) -> None:
    told: dict[str, Any] = results.run.get("measured", {})
    page.section("Measurement")
    facts = [
        ("measurement", told.get("name")),
        ("source", told.get("source")),
        ("file", told.get("file")),
        ("compared by", told.get("align")),
        ("shift, added to its times [s]", told.get("shift_s") if told.get("align") == "time" else None),
        ("how the shift is known", "found by correlation" if told.get("shift_found") else "given"),
        ("correlation", told.get("correlation")),
        ("width of that maximum [s]", told.get("width_s")),
        ("next best shift [s]", told.get("rival_s")),
        ("its correlation", told.get("rival_correlation")),
    ]
    columns = [Column("what", widest=40), Column("value", "any", widest=80)]
    page.table(columns, [fact for fact in facts if fact[1] not in (None, "")])
    if told.get("warnings"):
        page.section("Warnings")
        for words in told["warnings"]:
            page.wrapped(words)
        page.next += 1
    page.section("Errors: computed less measured")
    page.note("Values are in the unit of their row. Only steps, or pieces of the way, that have both values count.")
    _part(page, errors, _MEANS)
    page.section("Energy, of series of power")
    _part(page, errors[errors["energy_measured_kwh"].notna()], _ENERGY)
    page.section("Extremes")
    _part(page, errors, [c.name for c in TABLES["measured_errors"] if c.name.startswith(("lowest", "highest"))])
    page.section("What was measured")
    _part(page, errors, _DATA)


def _part(page: Page, errors: pd.DataFrame, names: Sequence[str]) -> None:
    """Write some columns of the errors; those without a value are left out."""
    if len(errors):
        shown = ["series", "unit", *(name for name in names if errors[name].notna().any())]
        page.table([Column(heading_of(name), _style(name)) for name in shown], errors[shown].itertuples(index=False))


def _style(name: str) -> str:
    if name in _TEXTS:
        return "text"
    if name in _WHOLE:
        return "0"
    if name in _LENGTHS:
        return "0.00"
    return _FORMATS.get(name.rpartition("_")[2], "0.0000" if name == "correlation" else "0.00")


def _values(page: Page, charts: Page, rows: pd.DataFrame, errors: pd.DataFrame) -> None:
    in_time = bool(rows["time_s"].notna().any())
    x, name = (TIME, "time_s") if in_time else (KM, "position_km")
    columns = [Column("series", widest=40), Column(x, "time" if in_time else "0.000")]
    columns += [Column(heading, "0.00") for heading in (MEASURED, COMPUTED, ERROR)]
    parts = []
    for series in errors["series"].head(MOST_SERIES):
        own = rows[rows["series"] == series]
        parts.append(own.iloc[:: -(-len(own) // MOST_ROWS) or 1])
    kept = pd.concat(parts) if parts else rows
    page.note(f"Of a series at most some {MOST_ROWS} rows; table measured has all.")
    fields = ["series", name, "measured", "computed", "error"]
    block = page.table(columns, kept[fields].itertuples(index=False), frozen=True)
    first = block.first
    for part, line in zip(parts[:MOST_CHARTS], errors.itertuples(), strict=False):
        if len(part):
            _chart(charts, block, x, part, (first, line))
        first += len(part)


def _chart(page: Page, block: Block, x: str, part: pd.DataFrame, where: tuple[int, Any]) -> None:
    first, told = where
    at = part["time_s" if x == TIME else "position_km"].to_numpy(float)
    chart = scatter(str(told.series), x, f"[{told.unit}]")
    for heading, colour in ((MEASURED, COLOURS[1]), (COMPUTED, COLOURS[0])):
        draw(chart, block, Line(heading, x, heading, first, first + len(at) - 1, colour))
    if x == TIME:
        spell = float(at[-1] - at[0])
        step = next((each for each in (60, 300, 600, 1800, 3600, 7200) if spell / each <= 12), 14400)
        show_clock(chart.x_axis, float(np.min(at)), float(np.max(at)), step)
    values = part[["measured", "computed"]].to_numpy(float)
    if np.isfinite(values).any():
        # Excel would begin a voltage at 0, and both lines would lie on each other.
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        unit = 10.0 ** np.floor(np.log10(max(high - low, 1e-3)))
        chart.y_axis.scaling.min, chart.y_axis.scaling.max = (
            float(np.floor(low / unit) * unit),
            float(np.ceil(high / unit) * unit),
        )
    page.chart(chart)
