"""How a workbook gets into its file: whole or not at all, with the values of formulas of any kind beside them."""

import pytest
from fake_results import make_case
from office import read_cells

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.saving import save_as


@pytest.fixture(scope="module")
def facts():
    return Facts(*make_case())


@pytest.mark.parametrize(
    ("formula", "value", "kept"),
    [
        ("1/3", 1.0 / 3.0, 1.0 / 3.0),
        ("10^300*1", 1e300, 1e300),
        ('"a"&CHAR(10)&"<b> & c"', "a\n<b> & c", "a\n<b> & c"),
        ('""', None, ""),
        ('REPT("x",300)', "x" * 300, "x" * 300),
        ("7", 7, 7.0),
        ('IF(1<2,"</v></c>","")', "</v></c>", "</v></c>"),
    ],
)
def test_a_value_stands_beside_its_formula_to_the_last_digit(facts, tmp_path, formula, value, kept):
    book = Book(facts, Report())
    page = book.page("Tested", "Title")
    page.put(5, 2, Formula(formula, value), "general")
    page.put(6, 2, '=cmd("<f>")', "text")
    book.finish()
    values, formulas = read_cells(save_as(book, tmp_path / "book.xlsx"))
    assert formulas["Tested"] == {"B5": formula}
    assert values["Tested"]["B5"] == kept
    assert values["Tested"]["B6"] == '=cmd("<f>")'
