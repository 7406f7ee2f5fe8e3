"""The workbook of a comparison with a measurement: what was compared, errors as formulas on the values, charts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.report import Report
from tractionpower.reporting.texts import language, mark, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Subject
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of
from tractionpower.reporting.workbook.frame.plots import COLOURS, Line, draw, scatter, show_clock
from tractionpower.reporting.workbook.frame.saving import save_as
from tractionpower.reporting.workbook.measured_values import COMPUTED, MEASURED, Place, add_values, formulas_of, series_words
from tractionpower.reporting.workbook.variants.axes import fit_axis, rooms_for_charts
from tractionpower.results.columns import TABLES
from tractionpower.results.results import Results

MOST_CHARTS = 12

_FORMATS = {"s": "time", "kwh": "0.00", "percent": "0.00", "km": "0.000"}
_TEXTS = ("series", "subject", "quantity", "unit", "column")
_WHOLE = ("rows", "gaps")
_LENGTHS = ("shift_s", "smoothing_s", "longest_gap_s")
_MEANS = (
    "rows", "mean_measured", "mean_computed", "mean_error", "mean_absolute_error", "rms_measured", "rms_computed", "rms_error",
    "largest_error", "relative_percent", "correlation",
)  # fmt: skip
_ENERGY = ("energy_measured_kwh", "energy_computed_kwh", "energy_error_percent")
_DATA = ("column", "share_percent", "shift_s", "smoothing_s", "gaps", "longest_gap_s")
_ALIGN = {"time": mark("time"), "distance": mark("distance")}
_HEADINGS = {
    "rows": mark("steps that have both"), "mean_error": mark("bias (mean error)"), "largest_error": mark("largest error"),
    "rms_error": mark("RMS error"), "rms_measured": mark("RMS measured"), "rms_computed": mark("RMS computed"),
    "relative_percent": mark("RMS error by RMS measured [%]"),
}  # fmt: skip


def write_measured_workbook(results: Results, path: Path, report: Report | None = None) -> Path:
    """Write the workbook and return where it is."""
    report = report or Report()
    with language(report.language):
        book = Book(Subject(results), report)
        table = results.table("measured_errors")
        errors = book.page("Errors", shorten(tr("{study}: run and measurement", study=book.subject.study), 120))
        charts = book.page("Charts", "Charts: measured and computed")
        places = add_values(book, results.table("measured"), table)
        _errors(errors, results, table, places)
        _charts(charts, table, places)
        if not places:
            book.pages.remove(charts)
            book.workbook.remove(charts.sheet)
        book.finish()
        return save_as(book, path)


def _errors(page: Page, results: Results, errors: pd.DataFrame, places: dict[str, Place]) -> None:
    told: dict[str, Any] = results.run.get("measured", {})
    page.section("Measurement")
    facts = [
        (tr("measurement"), told.get("name")),
        (tr("source"), told.get("source")),
        (tr("file"), told.get("file")),
        (tr("compared by"), tr(_ALIGN.get(str(told.get("align")), ""))),
        (tr("shift, added to its times [s]"), told.get("shift_s") if told.get("align") == "time" else None),
        (tr("how the shift is known"), tr("found by correlation") if told.get("shift_found") else tr("given")),
        (tr("correlation"), told.get("correlation")),
        (tr("width of that maximum [s]"), told.get("width_s")),
        (tr("next best shift [s]"), told.get("rival_s")),
        (tr("its correlation"), told.get("rival_correlation")),
    ]
    for label, value in facts:
        if value not in (None, ""):
            page.put(page.next, 1, label, "label")
            page.put(page.next, 2, f"{value:.6g}" if isinstance(value, float) else value, "plain")
            page.next += 1
    page.next += 1
    if told.get("warnings"):
        page.section("Warnings")
        for words in told["warnings"]:
            page.wrapped(recorded(words))
        page.next += 1
    page.section("Errors: computed less measured")
    page.note("Values are in the unit of their row. Only steps, or pieces of the way, that have both values count.")
    whole = all(places[str(series)].whole for series in errors["series"] if str(series) in places) and len(places) == len(errors)
    if whole:
        page.note("Means, bias, RMS, largest error and correlation are formulas on all values, on the sheets of values.")
    else:
        page.note(
            "Where not all values of a series are in the book, its errors are numbers that the program has computed from all of"
            " them; of the others they are formulas."
        )
    _means(page, errors, places)
    page.section("Energy, of series of power")
    _part(page, errors[errors["energy_measured_kwh"].notna()], _ENERGY)
    page.section("Extremes")
    _part(page, errors, [c.name for c in TABLES["measured_errors"] if c.name.startswith(("lowest", "highest"))])
    page.section("What was measured")
    _part(page, errors, _DATA)


def _means(page: Page, errors: pd.DataFrame, places: dict[str, Place]) -> None:
    """Write the errors: as formulas where all values of a series stand in the book."""
    lines = []
    for row in errors.to_dict("records"):
        place = places.get(str(row["series"]))
        live = formulas_of(place) if place is not None and place.whole else {}
        values = {name: live.get(name, row.get(name)) for name in _MEANS}
        lines.append([series_words(row), row["unit"], *values.values()])
    shown = [k for k in range(len(_MEANS)) if any(line[k + 2] is not None and _is_known(line[k + 2]) for line in lines)]
    columns = [Column("series", widest=34), Column("unit", widest=8)]
    columns += [Column(_heading(_MEANS[k]), _style(_MEANS[k])) for k in shown]
    if lines:
        page.table(columns, ([*line[:2], *(line[k + 2] for k in shown)] for line in lines))


def _is_known(value: Any) -> bool:
    return not isinstance(value, float) or not math.isnan(value)


def _part(page: Page, errors: pd.DataFrame, names: Sequence[str]) -> None:
    """Write some columns of the errors; those without a value are left out."""
    if len(errors):
        shown = ["series", "unit", *(name for name in names if errors[name].notna().any())]
        columns = [Column(_heading(name), _style(name), 34 if name == "series" else 24) for name in shown]
        words = [series_words(row) for row in errors.to_dict("records")]
        page.table(columns, errors.assign(series=words)[shown].itertuples(index=False))


def _heading(name: str) -> str:
    if name.endswith("_s") and name not in _LENGTHS:
        return tr("time of the {extreme}", extreme=heading_of(name.removesuffix("_s")))
    return _HEADINGS.get(name) or heading_of(name)


def _style(name: str) -> str:
    if name in _TEXTS:
        return "text"
    if name in _WHOLE:
        return "0"
    if name in _LENGTHS:
        return "0.00"
    return _FORMATS.get(name.rpartition("_")[2], "0.0000" if name == "correlation" else "0.00")


def _charts(page: Page, errors: pd.DataFrame, places: dict[str, Place]) -> None:
    """Draw each series, measured and computed."""
    shown = [row for row in errors.to_dict("records") if str(row["series"]) in places][:MOST_CHARTS]
    for told, room in zip(shown, rooms_for_charts(page, len(shown)), strict=True):
        page.chart(_chart(places[str(told["series"])], told), room)


def _chart(place: Place, told: Any) -> Any:
    x = tr("time of day") if place.in_time else tr("place [km]")
    chart = scatter(series_words(told), x, f"[{told['unit']}]")
    for key, words, colour in (("measured", MEASURED, COLOURS[1]), ("computed", COMPUTED, COLOURS[0])):
        block = place.block
        draw(chart, block, Line(tr(words), "x", f"{key}{place.column}", block.first, block.last, colour))
    if place.in_time:
        spell = float(place.at[-1] - place.at[0])
        step = next((each for each in (60, 300, 600, 1800, 3600, 7200) if spell / each <= 12), 14400)
        show_clock(chart.x_axis, float(np.min(place.at)), float(np.max(place.at)), step)
    else:
        fit_axis(chart.x_axis, place.at.tolist(), ticks=10)
    fit_axis(chart.y_axis, np.concatenate((place.measured, place.computed)).tolist())
    return chart
