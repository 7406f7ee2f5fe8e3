import pytest
from fake_results import make_case

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import (
    FIRST_PRINTED,
    LONG_SCALE,
    LONG_SHEET,
    MOST_PRINTED,
    Column,
    heading_of,
)


@pytest.fixture
def book():
    return Book(Facts(*make_case()), Report())


def test_headings_that_differ_by_case_alone_are_told_apart(book):
    page = book.page("Sheet A", "title")
    block = page.table([Column("b"), Column("B"), Column("x" * 300)], [(1, 2, 3)])
    shown = [page.sheet.cell(block.first - 1, column).value for column in (1, 2, 3)]
    assert shown[:2] == ["b", "B (2)"]
    assert len(shown[2]) <= 255
    assert block.column("B") == 2


def test_a_table_without_rows_has_a_header_and_no_filter(book):
    page = book.page("Sheet A", "title")
    page.table([Column("b")], [])
    page.finish()
    assert page.sheet.tables == {}


def test_tables_below_each_other_do_not_touch_and_have_names_of_their_own(book):
    page = book.page("Two words", "title")
    first, second = (page.table([Column("b")], [(1,), (2,)]) for _ in range(2))
    assert second.first - 1 > first.last + 1
    assert {table.ref for table in page.sheet.tables.values()} == {"A2:A4", "A6:A8"}
    assert all(" " not in name for name in page.sheet.tables)


def test_a_column_is_as_wide_as_what_it_shows(book):
    page = book.page("Sheet", "title")
    page.table([Column("a", "0.0"), Column("b"), Column("c", "time")], [(-123456789.0, "x" * 30, 90000.0)])
    page.finish()
    widths = [page.sheet.column_dimensions[letter].width for letter in "ABC"]
    assert widths[0] > len("-123456789.0")
    assert widths[1] > 30
    assert widths[2] > len("25:00:00")


def test_a_long_text_gets_a_higher_row(book):
    page = book.page("Sheet", "title")
    block = page.table([Column("a", widest=20)], [("word " * 20,), ("short",)])
    assert page.sheet.row_dimensions[block.first].height >= 15 * 100 / 22.5
    assert page.sheet.row_dimensions[block.last].height is None


@pytest.mark.parametrize(
    ("name", "heading"), [("km", "place [km]"), ("mass_t", "mass [t]"), ("kmh", "speed [km/h]"), ("id", "id")]
)
def test_headings_carry_the_unit(name, heading):
    assert heading_of(name) == heading


def test_a_table_that_is_too_long_is_printed_in_part_and_the_page_says_so(book):
    page = book.page("Long", "title")
    block = page.table([Column("b"), Column("c")], [(k, k) for k in range(MOST_PRINTED + 1)], frozen=True)
    page.section("Below it")
    page.finish()
    assert page.sheet.print_area == f"'Long'!$A$1:$B${block.first + FIRST_PRINTED - 1}"
    assert page.sheet.oddFooter.center.text == f"printed: the first {FIRST_PRINTED} of {MOST_PRINTED + 1} rows"
    whole = book.page("Whole", "title")
    whole.table([Column("b")], [(k,) for k in range(MOST_PRINTED)], frozen=True)
    whole.finish()
    assert not whole.sheet.print_area


def test_a_sheet_that_is_too_wide_takes_several_pages_and_repeats_its_first_column(book):
    wide, narrow = book.page("Wide", "title"), book.page("Narrow", "title")
    wide.table([Column(f"column {k}") for k in range(20)], [("x" * 30,) * 20])
    narrow.table([Column(f"column {k}") for k in range(9)], [("x" * 30,) * 9])
    for page, pages, columns in ((wide, 2, "$A:$A"), (narrow, 1, None)):
        page.finish()
        assert page.sheet.page_setup.fitToWidth == pages
        assert page.sheet.print_title_cols == columns
        assert int(page.sheet.page_setup.paperSize) == int(page.sheet.PAPERSIZE_A3)


def test_a_long_narrow_sheet_is_printed_smaller(book):
    long, short = book.page("Long one", "title"), book.page("Short one", "title")
    for page, rows in ((long, LONG_SHEET), (short, 10)):
        page.table([Column("b")], [(k,) for k in range(rows)], frozen=True)
        page.finish()
    assert (long.sheet.sheet_properties.pageSetUpPr.fitToPage, long.sheet.page_setup.scale) == (False, LONG_SCALE)
    assert (short.sheet.sheet_properties.pageSetUpPr.fitToPage, short.sheet.page_setup.scale) == (True, None)
