"""A sheet as it is filled: title, notes, tables one below the other, print set-up."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from openpyxl.utils import get_column_letter
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.table import Table, TableStyleInfo

from tractionpower.model.quantity import Quantity
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.texts.recorded import HEADINGS
from tractionpower.reporting.workbook.frame.cells import clean, days, put, shorten
from tractionpower.reporting.workbook.frame.editing import EDITABLE, MOST, only_numbers
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.paper import EMPTY_WIDTH, LETTER_WIDTHS, break_before_charts
from tractionpower.reporting.workbook.frame.widths import header_width, shown_width, told_apart

if TYPE_CHECKING:
    from tractionpower.reporting.workbook.frame.book import Book

NOTE_WIDTH = 118
"""Characters in a line of a note."""


SHEET_NAME_LENGTH = 31
"""Characters of the name of a sheet, the limit of Excel."""


PADDING = 2.5
"""Width of a column beyond that of its texts [characters]."""

WIDE = 165.0
"""A sheet that is wider than this is printed on A3: on A4 its letters would be too small [characters]."""

MOST_WIDE = {"a4": 245.0, "a3": 350.0}
"""Width of what one page shows in letters that can be read; a sheet that is wider takes two pages or more [characters]."""

MOST_PRINTED, FIRST_PRINTED = 1000, 60
"""Of a table with more rows than the first, as many as the second are printed: nobody reads a hundred pages of rows."""

LONG_SHEET, LONG_SCALE, LONG_WIDE = 150, 65, 205.0
"""A sheet of more printed rows than the first is printed at this scale [%], if it is no wider than the last [characters]."""

LINE_POINTS = 15.0
"""Height of a line of text [pt]."""

CHART_ROWS = 30
"""Rows that a chart covers."""

_BARE = {
    "km": mark("place [km]"),
    "kmh": mark("speed [km/h]"),
    "permille": mark("slope [‰]"),
    "unit": mark("type of unit"),
    "level": mark("control level"),
}


def heading_of(name: str) -> str:
    """Return the heading of a quantity by its name, with the unit.

    >>> heading_of("no_load_voltage_v"), heading_of("km")
    ('no load voltage [V]', 'place [km]')
    """
    quantity = Quantity(name, "")
    if name in _BARE or quantity.heading in HEADINGS:
        return tr(_BARE.get(name, quantity.heading))
    return f"{recorded(quantity.words)}{f' [{quantity.unit}]' if quantity.unit else ''}"


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its heading, the style of its cells, and the width that it may take [characters].

    The style is ``text``, a number format such as ``0.0``, ``time`` for seconds that are shown as a time of day, or ``any``
    where texts and numbers are mixed, ``beside`` for texts on the right of numbers. The heading is English; it is shown in the
    language of the report. By its key, formulas of the same row find it.
    """

    heading: str
    style: str = "text"
    widest: int = 34
    key: str = ""


@dataclass(frozen=True, slots=True)
class Block:
    """Where a table stands: its sheet, first and last row of the data, and the columns by heading (in English) or key."""

    sheet: Any
    first: int
    last: int
    headings: tuple[str, ...]
    keys: tuple[str, ...] = ()

    def column(self, name: str) -> int:
        """Return the number of a column, from 1."""
        return (self.keys if name in self.keys else self.headings).index(name) + 1

    def cell(self, name: str, row: int) -> str:
        """Return a cell of a column by the number of its row in the sheet."""
        return f"{get_column_letter(self.column(name))}{row}"

    def cells(self, name: str) -> str:
        """Return the range of a column's data, as conditional formats need it."""
        return f"{self.cell(name, self.first)}:{self.cell(name, self.last)}"


class Page:
    """One sheet of the workbook.

    Texts that are the same in every report are given in English and shown in the language of the report; those with names or
    numbers are made by ``texts.tr``.

    Parameters
    ----------
    book
        Where it belongs.
    name
        Name of the sheet, in English.
    title
        What stands above.
    """

    def __init__(self, book: Book, name: str, title: str) -> None:
        self.book, self.name, self.title = book, name, tr(title)
        self.sheet = book.workbook.create_sheet(shorten(recorded(name), SHEET_NAME_LENGTH))
        self.styles = book.styles
        self.next = 1
        self._needed: dict[int, float] = {}
        self._narrow: dict[int, float] = {}
        self._edited: dict[float, list[str]] = {}
        self._tables = 0
        self._last_printed: int | None = None
        self._longest_line = 0.0
        self._loose: list[int] = []
        self._spread = False
        self._set_up()
        self.line(self.title, "title")
        self.sheet.row_dimensions[1].height = 24.0

    def put(self, row: int, column: int, value: Any, style: str, cells: Mapping[str, str] | None = None) -> Any:
        """Write a value or a formula into a cell and return what is shown there; `cells` are those that a formula may name."""
        if isinstance(value, Formula):
            self.book.pending.append((self, row, column, value, cells or {}))
            value = value.value
        shown = put(self.sheet, row, column, value, self.styles[style])
        if style.startswith(EDITABLE):
            self.edit(shown.coordinate, style.removeprefix(EDITABLE))
        return shown.value

    def edit(self, cell: str, number_format: str, least: float = -MOST) -> None:
        """Show a cell as one that is made to be edited; only numbers can be typed there, none below the least."""
        self.sheet[cell]._style = self.styles[f"editable {number_format}"]
        self._edited.setdefault(least, []).append(cell)

    def line(self, text: str, style: str = "plain") -> None:
        """Write a line of text."""
        shown = put(self.sheet, self.next, 1, tr(text), self.styles[style]).value
        self._longest_line = max(self._longest_line, len(str(shown or "")) * LETTER_WIDTHS.get(style, 1.0))
        self.next += 1

    def note(self, text: str) -> None:
        """Write a note, broken into lines that fit on a printed page."""
        for line in textwrap.wrap(clean(tr(text)), NOTE_WIDTH):
            self.line(line, "note")

    def wrapped(self, text: str) -> None:
        """Write a text, broken into lines that fit on a printed page."""
        for line in textwrap.wrap(clean(tr(text)), NOTE_WIDTH):
            self.line(line)

    def section(self, text: str) -> None:
        """Write a heading above a table, with a free row before it."""
        self.next += self._tables > 0
        self.line(text, "section")

    def table(
        self, columns: Sequence[Column], rows: Iterable[Sequence[Any]], *, frozen: bool = False, printed: int = MOST_PRINTED
    ) -> Block:
        """Write a table with a filter in its header.

        Parameters
        ----------
        columns
            What it has.
        rows
            The values, among them formulas; a time is given in seconds.
        frozen
            Whether the header stays in sight and is printed on every page; for the only long table of a sheet.
        printed
            Of a table with more rows the first few are printed, and nothing that stands below; the printed page says so.
        """
        top = self.next
        shown = [tr(column.heading) for column in columns]
        longest = [header_width(heading) for heading in shown]
        for number, heading in enumerate(told_apart(shown), 1):
            put(self.sheet, top, number, heading, self.styles["head"])
        keys = [(column.key, get_column_letter(number)) for number, column in enumerate(columns, 1) if column.key]
        styles = [self.styles[column.style] for column in columns]
        for row in rows:
            self.next += 1
            lines = 1
            for k, (column, value) in enumerate(zip(columns, row, strict=True)):
                if isinstance(value, Formula):
                    self.book.pending.append((self, self.next, k + 1, value, {key: f"{at}{self.next}" for key, at in keys}))
                    value = value.value  # noqa: PLW2901 - what is shown until the formula is written
                told = days(value) if column.style == "time" else value
                width = shown_width(put(self.sheet, self.next, k + 1, told, styles[k]).value, column.style)
                longest[k] = max(longest[k], min(width, column.widest))
                lines = max(lines, math.ceil(width / (column.widest + PADDING)))
            if lines > 1:
                self.sheet.row_dimensions[self.next].height = LINE_POINTS * min(lines, 25)
        for number, width in enumerate(longest, 1):
            self._needed[number] = max(self._needed.get(number, 0.0), width)
        headings, by_key = tuple(column.heading for column in columns), tuple(column.key for column in columns)
        block = Block(self.sheet, top + 1, self.next, headings, by_key)
        self._add_filter(block)
        if frozen:
            self.sheet.freeze_panes = f"B{top + 1}"
            self.sheet.print_title_rows = f"{top}:{top}"
        self._header_height(top, shown)
        if self._last_printed is None and block.last - top > printed:
            self._print_beginning(block, min(printed, FIRST_PRINTED))
        self.next += 2 if block.last >= block.first else 1
        return block

    def chart(self, chart: Any, row: int | None = None) -> None:
        """Put a chart below what stands there, or into rows that were kept free for it."""
        self.sheet.add_chart(chart, f"A{self.room_for_chart() if row is None else row}")

    def room_for_chart(self, rows: int = CHART_ROWS) -> int:
        """Keep rows free for a chart of what comes later, and return the first of them."""
        self.next += rows
        return self.next - rows

    def spread(self) -> None:
        """Let a sheet that is too wide for A4 go over several pages beside each other, rather than have small letters."""
        self._spread = True

    def new_page(self) -> None:
        """Let what follows begin on a page of its own when it is printed."""
        self.sheet.row_breaks.append(Break(id=self.next - 1))

    def new_page_for_chart(self) -> None:
        """Let a chart that follows begin on a page of its own if what stands before it leaves it no room."""
        self._loose.append(self.next)

    def finish(self) -> None:
        """Set the widths of the columns and the paper, when all is written."""
        sheet = self.sheet
        for number, given in self._narrow.items():
            self._needed[number] = given - PADDING
        width = sum(needed + PADDING for needed in self._needed.values())
        paper = self.book.report.paper
        if paper == "fit":
            paper = "a3" if width > WIDE and not self._spread else "a4"
        sheet.page_setup.paperSize = sheet.PAPERSIZE_A3 if paper == "a3" else sheet.PAPERSIZE_A4
        sheet.page_setup.fitToWidth = max(1, math.ceil(width / (WIDE if self._spread and paper == "a4" else MOST_WIDE[paper])))
        rows = self.next if self._last_printed is None else self._last_printed
        if paper == "a4" and rows > LONG_SHEET and width <= LONG_WIDE and not sheet._charts:
            sheet.sheet_properties.pageSetUpPr.fitToPage, sheet.page_setup.scale = False, LONG_SCALE
            sheet.print_title_cols = "A:A"  # where letters are wider than thought the last columns come on a page of their own
        if sheet.page_setup.fitToWidth > 1:
            sheet.print_title_cols = "A:A"
        for number, needed in self._needed.items():
            sheet.column_dimensions[get_column_letter(number)].width = needed + PADDING
        if self._last_printed is not None:
            sheet.print_area = f"A1:{get_column_letter(self._room_for_lines())}{self._last_printed}"
        break_before_charts(sheet, self._loose, CHART_ROWS, LINE_POINTS, (paper, width))
        if self.sheet.freeze_panes is None:
            self.sheet.freeze_panes = "A2"
        for least, cells in self._edited.items():
            only_numbers(self.sheet, cells, least)

    def _room_for_lines(self) -> int:
        """Return the last column that is printed, so that titles and notes are not cut at the edge of a narrow table."""
        last, width = max(self._needed), sum(needed + PADDING for needed in self._needed.values())
        while width < self._longest_line:
            last, width = last + 1, width + EMPTY_WIDTH
            self.sheet.column_dimensions[get_column_letter(last)].width = EMPTY_WIDTH
        return last

    def widen(self, *widths: float) -> None:
        """Give the first columns at least these widths [characters]."""
        for number, width in enumerate(widths, 1):
            self._needed[number] = max(self._needed.get(number, 0.0), width)

    def narrow(self, first: int, last: int, width: float) -> None:
        """Give columns exactly this width [characters], whatever their headings need."""
        self._narrow |= dict.fromkeys(range(first, last + 1), width)

    def _print_beginning(self, block: Block, rows: int) -> None:
        """Print the sheet down to some row of a table, and say so below the page."""
        self._last_printed = block.first + rows - 1
        words = tr("printed: the first {rows} of {all} rows", rows=rows, all=block.last - block.first + 1)
        self.sheet.oddFooter.center.text = words.replace("&", "&&")

    def _add_filter(self, block: Block) -> None:
        self._tables += 1
        if block.last < block.first:
            return  # a table without rows is an error in Excel
        words = re.sub(r"\W", "_", self.sheet.title)
        area = f"A{block.first - 1}:{get_column_letter(len(block.headings))}{block.last}"
        table = Table(displayName=f"{words}_{self._tables}", ref=area)
        table.tableStyleInfo = TableStyleInfo(name="TableStyleLight1", showRowStripes=False)
        self.sheet.add_table(table)

    def _header_height(self, row: int, headings: Sequence[str]) -> None:
        lines = max(len(textwrap.wrap(heading, int(self._needed[number]))) for number, heading in enumerate(headings, 1))
        self.sheet.row_dimensions[row].height = LINE_POINTS * max(lines, 1) + 9.0

    def _set_up(self) -> None:
        sheet = self.sheet
        sheet.sheet_view.showGridLines = False
        sheet.page_setup.orientation = "landscape"
        sheet.sheet_properties.pageSetUpPr.fitToPage = True
        sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0
        sheet.page_margins.left = sheet.page_margins.right = 0.5
        sheet.page_margins.top = sheet.page_margins.bottom = 0.75
        sheet.oddHeader.left.text = shorten(self.book.subject.study, 80).replace("&", "&&")
        sheet.oddHeader.right.text = "&A"
        sheet.oddFooter.left.text = shorten(self.book.report.company or "tractionpower", 80).replace("&", "&&")
        sheet.oddFooter.right.text = tr("page &P of &N")
