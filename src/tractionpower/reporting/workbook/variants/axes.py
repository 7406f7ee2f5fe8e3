"""Finish of charts: axes that fit their values, points on lines, names of series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from openpyxl.chart.series import SeriesLabel

from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.frame.plots import NAME_LENGTH

POINTS = ("circle", "square", "triangle", "diamond", "x", "plus", "star")
"""What tells lines apart without colour."""

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def fit_axis(axis: Any, values: Sequence[float], *, ticks: int = 6, from_zero: bool = False) -> None:
    """Let an axis span the values in round steps; one of values near zero, or far apart, begins there.

    Bars are lengths: `from_zero` lets them begin at zero, but those of voltages, which are read against limits.
    """
    known = [value for value in (*values, *([0.0] if from_zero else [])) if math.isfinite(value)]
    if not known:
        return
    low, high = min(known), max(known)
    if low >= 0.0 and high > 0.0 and low < 0.35 * high:
        low = 0.0
    spread = high - low or abs(high) * 0.1 or 1.0
    if high == low:
        low, high = low - spread / 2.0, high + spread / 2.0
    rough = spread / ticks
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * each for each in STEPS if power * each >= rough * 0.999)
    axis.majorUnit = step
    axis.scaling.min, axis.scaling.max = _round(math.floor(low / step) * step), _round(math.ceil(high / step) * step)


def rooms_for_charts(page: Page, count: int) -> list[int]:
    """Keep room for charts, each on a printed page of its own, before the tables that they are drawn from; return their rows."""
    rooms = []
    for number in range(count):
        if number:
            page.new_page()
            page.next += 1  # the edge of a chart would show on the page before
        rooms.append(page.room_for_chart())
    page.new_page()
    return rooms


def show_points(series: Any, number: int, colour: str, *, line: bool = True) -> None:
    """Show points on a line, or instead of it."""
    marker = series.marker
    marker.symbol, marker.size = POINTS[number % len(POINTS)], 7
    marker.graphicalProperties.solidFill = colour
    marker.graphicalProperties.line.solidFill = colour
    if not line:
        series.graphicalProperties.line.noFill = True
        series.graphicalProperties.line.solidFill = None


def name_series(chart: Any, names: Sequence[str]) -> None:
    """Give the series of a chart their names in the language of the report."""
    for series, name in zip(chart.series, names, strict=False):
        series.tx = SeriesLabel(v=shorten(name, NAME_LENGTH))


def stack(chart: Any, colours: Sequence[str], *, lying: bool = False) -> None:
    """Stack the bars of a chart in colours of their own."""
    chart.grouping, chart.overlap = "stacked", 100
    if lying:
        chart.type = "bar"
        chart.x_axis.scaling.orientation = "maxMin"  # the first row stands above
    for series, colour in zip(chart.series, colours, strict=False):
        series.graphicalProperties.solidFill = colour


def _round(value: float) -> float:
    return float(f"{value:.12g}")
