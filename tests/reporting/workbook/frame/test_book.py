"""Which sheets a book keeps, and what becomes of formulas and charts of those that go."""

import openpyxl
import pytest
from fake_results import make_case
from office import complaints, read_cells

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.frame.plots import Line, draw, scatter
from tractionpower.reporting.workbook.frame.saving import save_as


@pytest.fixture(scope="module")
def facts():
    return Facts(*make_case())


@pytest.fixture
def save(facts, tmp_path):
    """Return a function that fills three sheets, one of which needs the others, and saves what a template keeps."""

    def made(**template):
        book = Book(facts, Report(**template))
        data = book.page("Data", "Data")
        columns = [Column("x", "0.00", key="x"), Column("double", "0.00", key="y")]
        block = data.table(columns, [(k, Formula("2*{x}", 2.0 * k)) for k in (0.5, 1.0, 0.1)])
        book.define("all_doubles", data, block.cells("y"))
        told = book.page("Told", "Told")
        told.put(3, 1, Formula('"sum "&SUM({all_doubles})&" <&>"', "sum 3.2 <&>"), "text")
        told.put(4, 1, Formula("SUM({all_doubles})", 3.2), "0.0")
        told.put(5, 1, Formula('IF(SUM({all_doubles})>99,1,"")', ""), "0.0")
        drawn = book.page("Drawn", "Drawn")
        chart = scatter("Chart", "x", "y")
        draw(chart, block, Line("line", "x", "y", block.first, block.last, "0072B2"))
        drawn.chart(chart)
        book.finish()
        return save_as(book, tmp_path / "book.xlsx")

    return made


def test_all_sheets_are_kept_and_formulas_have_values_beside_them(save):
    path = save()
    values, formulas = read_cells(path)
    assert list(values) == ["Data", "Told", "Drawn"]
    assert formulas["Told"] == {
        "A3": '"sum "&SUM(all_doubles)&" <&>"', "A4": "SUM(all_doubles)", "A5": 'IF(SUM(all_doubles)>99,1,"")'
    }  # fmt: skip
    assert (values["Told"]["A3"], values["Told"]["A4"], values["Told"]["A5"]) == ("sum 3.2 <&>", 3.2, "")
    assert sorted(values["Data"][place] for place in formulas["Data"]) == [0.2, 1.0, 2.0]
    assert complaints(path) == []


def test_a_template_chooses_sheets_in_its_order_whatever_their_case(save):
    path = save(sheets=("told", "DATA", "no such sheet"))
    assert openpyxl.load_workbook(path).sheetnames == ["Told", "Data"]
    assert complaints(path) == []


def test_a_formula_on_a_sheet_that_is_left_out_becomes_its_value(save):
    path = save(sheets=("Told",))
    values, formulas = read_cells(path)
    assert formulas == {"Told": {}}
    assert (values["Told"]["A3"], values["Told"]["A4"]) == ("sum 3.2 <&>", 3.2)
    assert "all_doubles" not in openpyxl.load_workbook(path).defined_names


def test_a_sheet_that_a_chart_draws_from_is_hidden_not_lost(save):
    path = save(leave_out=("Data",))
    book = openpyxl.load_workbook(path)
    assert [(sheet.title, sheet.sheet_state) for sheet in book] == [("Told", "visible"), ("Drawn", "visible"), ("Data", "hidden")]
    assert book["Told"]["A4"].value == "=SUM(all_doubles)"
    assert complaints(path) == []


def test_a_template_that_keeps_nothing_keeps_all(save):
    assert openpyxl.load_workbook(save(sheets=("nothing",))).sheetnames == ["Data", "Told", "Drawn"]
