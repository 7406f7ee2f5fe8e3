"""Native charts in one style: axes with titles, lines without markers, colours that colour-blind eyes tell apart."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.chart.data_source import AxDataSource, StrRef
from openpyxl.chart.label import DataLabel, DataLabelList
from openpyxl.chart.layout import Layout, ManualLayout
from openpyxl.chart.legend import LegendEntry
from openpyxl.chart.shapes import GraphicalProperties
from openpyxl.chart.text import RichText
from openpyxl.drawing.text import CharacterProperties, Paragraph, ParagraphProperties, RichTextProperties

from tractionpower.reporting.workbook.frame.cells import SECONDS_PER_DAY, shorten
from tractionpower.reporting.workbook.frame.page import Block

# Okabe and Ito; Excel wants them without the sign.
COLOURS = ("0072B2", "D55E00", "009E73", "CC79A7", "E69F00", "56B4E9", "333333")
DASHES = ("solid", "dash", "sysDot", "dashDot")
GRID, GREY, INK = "D9D9D9", "777777", "333333"

WIDTH_CM, HEIGHT_CM = 26.0, 14.8
THIN, NORMAL, BOLD = 9_500, 15_000, 25_000
"""Widths of a line [EMU]: 0.75, 1.2 and 2 pt."""

NAME_LENGTH, MARK_LENGTH = 36, 20
"""Characters of a name in a legend, and at a place."""

TITLE_LENGTH = 90
"""Characters of the title of a chart."""

TITLE_SIZE, WORD_SIZE, SMALL_SIZE = 1300, 1000, 900
"""Sizes of letters [1/100 pt]."""

UPRIGHT = -5_400_000
"""Turn of a text that is read from below [1/60000 of a degree]."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a chart: its name, the rows of a block that it takes, its colour, dashes and width."""

    name: str
    x: str
    y: str
    first: int
    last: int
    colour: str
    dashes: str = "solid"
    width: int = NORMAL


def scatter(title: str, x_title: str, y_title: str, *, legend: bool = True) -> Any:
    """Return an empty chart of lines over numbers; its texts come in the language of the report."""
    chart = ScatterChart()
    chart.scatterStyle = "lineMarker"
    return _styled(chart, title, x_title, y_title, legend=legend)


def draw(chart: Any, block: Block, line: Line) -> Any:
    """Add a line to a chart and return it; its data stand in columns of `block`."""
    x, y = (
        Reference(block.sheet, min_col=block.column(name), min_row=line.first, max_row=line.last) for name in (line.x, line.y)
    )
    series = Series(y, x, title=shorten(line.name, NAME_LENGTH))
    series.marker.symbol, series.smooth = "none", False
    properties = series.graphicalProperties.line
    properties.solidFill, properties.width, properties.dashStyle = line.colour, line.width, line.dashes
    chart.series.append(series)
    return series


def name_end(series: Any, points: int) -> None:
    """Write the name of a line on the right of its last point."""
    series.dLbls = _label(DataLabel(idx=points - 1, dLblPos="r", txPr=_letters(SMALL_SIZE, INK)))


def mark_point(chart: Any, block: Block, line: Line) -> None:
    """Add a place on the upper edge: a mark with its name above, read from below."""
    series = draw(chart, block, replace(line, name=shorten(line.name, MARK_LENGTH)))
    series.graphicalProperties.line.noFill, series.graphicalProperties.line.solidFill = True, None
    series.graphicalProperties.line.dashStyle = None
    series.marker.symbol, series.marker.size = "diamond", 6
    series.marker.graphicalProperties = GraphicalProperties(solidFill=line.colour)
    series.marker.graphicalProperties.line.solidFill = line.colour
    series.dLbls = _label(DataLabel(idx=0, dLblPos="t", txPr=_letters(SMALL_SIZE, INK, turn=UPRIGHT)))


def hide_from_legend(chart: Any, lines: Iterable[int]) -> None:
    """Leave some lines out of the legend, by their numbers; their names stand elsewhere."""
    if chart.legend is not None:
        chart.legend.legendEntry = [LegendEntry(idx=number, delete=True) for number in lines]


def second_axis(chart: Any, other: Any) -> None:
    """Lay another chart of lines over a chart, with its vertical axis on the right; both have the same horizontal one."""
    other.x_axis.axId, other.y_axis.axId = 100, 200
    other.x_axis.crossAx, other.y_axis.crossAx = 200, 100
    other.x_axis.delete, other.x_axis.scaling = True, chart.x_axis.scaling
    other.y_axis.crosses = "max"
    other.y_axis.majorGridlines = other.x_axis.majorGridlines = None
    chart += other


def room_on_the_right(chart: Any) -> None:
    """Keep a fifth of the chart free for the names of lines at their ends."""
    chart.layout = _layout(x=0.07, y=0.09, w=0.77, h=0.78)


def room_above(chart: Any) -> None:
    """Keep room for names of places on the upper edge, below the title."""
    chart.layout = _layout(x=0.07, y=0.27, w=0.9, h=0.56)


def bars(
    title: str, y_title: str, block: Block, label: str, headings: Sequence[str], *, x_title: str = "", stacked: bool = False
) -> Any:
    """Return a bar chart of columns of a block, one group or one stack for each of its rows."""
    chart = BarChart()
    chart.type, chart.gapWidth = "col", 60
    if stacked:
        chart.grouping, chart.overlap, chart.gapWidth = "stacked", 100, 10
    names = Reference(block.sheet, min_col=block.column(label), min_row=block.first, max_row=block.last)
    for heading, colour in zip(headings, COLOURS, strict=False):
        values = Reference(block.sheet, min_col=block.column(heading), min_row=block.first, max_row=block.last)
        shown = block.sheet.cell(block.first - 1, block.column(heading)).value
        series = Series(values, title=shorten(str(shown), NAME_LENGTH))
        series.graphicalProperties.solidFill = colour
        series.cat = AxDataSource(strRef=StrRef(str(names)))
        chart.series.append(series)
    chart = _styled(chart, title, x_title, y_title, legend=len(headings) > 1)
    chart.x_axis.tickLblPos = "low"  # names stay below bars that go down
    return chart


def show_clock(axis: Any, begin_s: float, end_s: float, step_s: float) -> None:
    """Let an axis tell times of day, with ticks every `step_s`."""
    first, last = begin_s // step_s * step_s, -(-end_s // step_s) * step_s
    axis.scaling.min, axis.scaling.max = first / SECONDS_PER_DAY, last / SECONDS_PER_DAY
    axis.majorUnit = step_s / SECONDS_PER_DAY
    axis.number_format = "[hh]:mm" if step_s % 60 == 0 else "[hh]:mm:ss"


def _styled(chart: Any, title: str, x_title: str, y_title: str, *, legend: bool) -> Any:
    chart.title, chart.width, chart.height = shorten(title, TITLE_LENGTH), WIDTH_CM, HEIGHT_CM
    chart.roundedCorners = chart.varyColors = False
    chart.title.overlay = False
    _set_letters(chart.title, TITLE_SIZE, bold=True)
    for axis, words in ((chart.x_axis, x_title), (chart.y_axis, y_title)):
        axis.delete = False  # Excel hides axes that do not say so
        axis.number_format, axis.majorTickMark = "General", "out"
        axis.txPr = _letters(SMALL_SIZE, INK)
        axis.graphicalProperties = _thin(GREY)
        if words:
            axis.title = shorten(words, TITLE_LENGTH)
            axis.title.overlay = False
            _set_letters(axis.title, WORD_SIZE)
    chart.y_axis.majorGridlines.spPr = _thin()
    if chart.x_axis.tagname == "valAx":
        chart.x_axis.majorGridlines.spPr = _thin()
        chart.x_axis.crosses = chart.y_axis.crosses = "min"
    if legend:
        chart.legend.position, chart.legend.overlay = "b", False
        chart.legend.txPr = _letters(SMALL_SIZE, INK)
    else:
        chart.legend = None
    return chart


def _layout(**place: float) -> Layout:
    """Return where the area within the axes lies, in shares of the chart."""
    edges = {"layoutTarget": "inner", "xMode": "edge", "yMode": "edge"}
    return Layout(manualLayout=ManualLayout(**edges, **place))


def _label(label: DataLabel) -> DataLabelList:
    """Return labels of which there is one, with the name of its line."""
    label.showSerName = True
    label.showVal = label.showCatName = label.showLegendKey = label.showPercent = False
    none = dict.fromkeys(("showSerName", "showVal", "showCatName", "showLegendKey", "showPercent"), False)
    return DataLabelList(dLbl=[label], **none)


def _letters(size: int, colour: str, *, bold: bool = False, turn: int | None = None) -> RichText:
    properties = CharacterProperties(sz=size, b=bold, solidFill=colour)
    body = RichTextProperties() if turn is None else RichTextProperties(rot=turn, vert="horz")
    return RichText(bodyPr=body, p=[Paragraph(pPr=ParagraphProperties(defRPr=properties), endParaRPr=properties)])


def _set_letters(title: Any, size: int, *, bold: bool = False) -> None:
    """Give the words of a title their size."""
    properties = CharacterProperties(sz=size, b=bold, solidFill=INK)
    for paragraph in title.tx.rich.p:
        paragraph.pPr = ParagraphProperties(defRPr=properties)
        for run in paragraph.r or ():
            run.rPr = properties


def _thin(colour: str = GRID) -> Any:
    properties = GraphicalProperties()
    properties.line.solidFill, properties.line.width = colour, 6_000
    return properties
