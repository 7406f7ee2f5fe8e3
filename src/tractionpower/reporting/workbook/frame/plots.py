"""Native charts in one style: axes with titles, lines without markers, colours that colour-blind eyes tell apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.chart.data_source import AxDataSource, StrRef
from openpyxl.chart.shapes import GraphicalProperties

from tractionpower.reporting.workbook.frame.cells import SECONDS_PER_DAY, shorten
from tractionpower.reporting.workbook.frame.page import Block

# Okabe and Ito; Excel wants them without the sign.
COLOURS = ("0072B2", "D55E00", "009E73", "CC79A7", "E69F00", "56B4E9", "333333")
DASHES = ("solid", "dash", "sysDot", "dashDot")
GRID, GREY = "D9D9D9", "777777"

WIDTH_CM, HEIGHT_CM = 26.0, 14.0
LINE_WIDTH = 15_000
"""Width of a line [EMU], 1.2 pt."""

NAME_LENGTH = 28
"""Characters of a name in a legend."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a chart: its name, the rows of a block that it takes, colour and dashes."""

    name: str
    x: str
    y: str
    first: int
    last: int
    colour: str
    dashes: str = "solid"


def scatter(title: str, x_title: str, y_title: str, *, legend: bool = True) -> Any:
    """Return an empty chart of lines over numbers."""
    chart = ScatterChart()
    chart.scatterStyle = "lineMarker"
    return _styled(chart, title, x_title, y_title, legend=legend)


def draw(chart: Any, block: Block, line: Line) -> None:
    """Add a line to a chart; its data stand in columns of `block`."""
    x, y = (
        Reference(block.sheet, min_col=block.column(name), min_row=line.first, max_row=line.last) for name in (line.x, line.y)
    )
    series = Series(y, x, title=shorten(line.name, NAME_LENGTH))
    series.marker.symbol, series.smooth = "none", False
    properties = series.graphicalProperties.line
    properties.solidFill, properties.width, properties.dashStyle = line.colour, LINE_WIDTH, line.dashes
    chart.series.append(series)


def bars(title: str, y_title: str, block: Block, label: str, headings: Sequence[str]) -> Any:
    """Return a bar chart of columns of a block, one group for each of its rows."""
    chart = BarChart()
    chart.type, chart.gapWidth = "col", 60
    names = Reference(block.sheet, min_col=block.column(label), min_row=block.first, max_row=block.last)
    for heading, colour in zip(headings, COLOURS, strict=False):
        values = Reference(block.sheet, min_col=block.column(heading), min_row=block.first, max_row=block.last)
        series = Series(values, title=heading)
        series.graphicalProperties.solidFill = colour
        series.cat = AxDataSource(strRef=StrRef(str(names)))
        chart.series.append(series)
    chart = _styled(chart, title, "", y_title, legend=len(headings) > 1)
    chart.x_axis.tickLblPos = "low"  # names stay below bars that go down
    return chart


def show_clock(axis: Any, begin_s: float, end_s: float, step_s: float) -> None:
    """Let an axis tell times of day, with ticks every `step_s`."""
    first, last = begin_s // step_s * step_s, -(-end_s // step_s) * step_s
    axis.scaling.min, axis.scaling.max = first / SECONDS_PER_DAY, last / SECONDS_PER_DAY
    axis.majorUnit = step_s / SECONDS_PER_DAY
    axis.number_format = "[hh]:mm" if step_s % 60 == 0 else "[hh]:mm:ss"


def _styled(chart: Any, title: str, x_title: str, y_title: str, *, legend: bool) -> Any:
    chart.title, chart.width, chart.height = title, WIDTH_CM, HEIGHT_CM
    chart.roundedCorners = chart.varyColors = False
    chart.title.overlay = False
    for axis, words in ((chart.x_axis, x_title), (chart.y_axis, y_title)):
        axis.delete = False  # Excel hides axes that do not say so
        axis.number_format, axis.majorTickMark = "General", "out"
        if words:
            axis.title = words
            axis.title.overlay = False
    chart.y_axis.majorGridlines.spPr = _thin()
    if chart.x_axis.tagname == "valAx":
        chart.x_axis.majorGridlines.spPr = _thin()
        chart.x_axis.crosses = chart.y_axis.crosses = "min"
    if legend:
        chart.legend.position, chart.legend.overlay = "b", False
    else:
        chart.legend = None
    return chart


def _thin() -> Any:
    properties = GraphicalProperties()
    properties.line.solidFill, properties.line.width = GRID, 6_000
    return properties
