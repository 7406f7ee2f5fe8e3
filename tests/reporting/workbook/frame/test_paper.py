import pytest
from openpyxl import Workbook
from openpyxl.utils import get_column_letter, range_boundaries
from openpyxl.worksheet.pagebreak import Break

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.frame.paper import CHARACTER_POINTS, LETTER_WIDTHS, PAGE_POINTS, break_before_charts

FITTING = int(PAGE_POINTS["a4"][1] / 15.0) - 10
"""Rows that leave room for a chart of ten."""


def breaks(rows_above, width, hard=None):
    sheet = Workbook().active
    if hard is not None:
        sheet.row_breaks.append(Break(id=hard))
    break_before_charts(sheet, [rows_above + 1], 10, 15.0, ("a4", width))
    return [each.id for each in sheet.row_breaks.brk]


def test_a_chart_gets_a_page_of_its_own_only_where_it_has_no_room():
    assert breaks(FITTING, 50.0) == []
    assert breaks(FITTING + 1, 50.0) == [FITTING + 1]
    assert breaks(FITTING + 1, 50.0, hard=3) == [3]  # rows before a break stand on another page


def test_a_wide_sheet_is_printed_smaller_and_has_room_for_more():
    twice = 2.0 * PAGE_POINTS["a4"][0] / CHARACTER_POINTS
    assert breaks(FITTING + 30, twice) == []
    assert breaks(FITTING + 40, twice) == [FITTING + 40]


def test_the_printed_area_of_a_narrow_extract_takes_its_title(case):
    book = Book(Facts(*case), Report())
    page = book.page("Extract", "A title that is far longer than the table below it is wide, so that the edge cut it")
    page.table([Column("a", "0"), Column("b", "0")], [(1, 2)] * 1100, frozen=True, printed=20)
    page.finish()
    _, _, last, rows = range_boundaries(page.sheet.print_area.split("!")[-1].replace("$", ""))
    width = sum(page.sheet.column_dimensions[get_column_letter(k)].width for k in range(1, last + 1))
    assert rows < 30
    assert width >= len(page.title) * LETTER_WIDTHS["title"]
    assert width == pytest.approx(len(page.title) * LETTER_WIDTHS["title"], abs=12.0)
