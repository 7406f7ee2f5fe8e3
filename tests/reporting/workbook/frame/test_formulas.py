import pytest
from openpyxl import Workbook

from tractionpower.reporting.workbook.frame.formulas import Formula, Names


@pytest.fixture
def sheet():
    sheet = Workbook().active
    sheet.title = "Key figures & 'more'"
    return sheet


def test_places_are_cells_of_the_row_before_names_of_the_book(sheet):
    names = Names()
    names.define("limit_u_min2", sheet, "C7")
    names.define("load", sheet, "C8")
    formula = Formula("IF({load}<{limit_u_min2},1,0)", 1)
    assert formula.written({"load": "B5"}, names) == "=IF(B5<limit_u_min2,1,0)"
    assert formula.written({}, names) == "=IF(load<limit_u_min2,1,0)"


def test_a_formula_that_asks_for_what_is_not_there_is_none(sheet):
    assert Formula("{gone}+1", 2.0).written({"here": "B5"}, Names()) is None


def test_a_name_stands_for_an_absolute_place_on_a_quoted_sheet(sheet):
    names = Names()
    names.define("all_loads", sheet, "C7:D99")
    names.write(sheet.parent)
    assert sheet.parent.defined_names["all_loads"].attr_text == "'Key figures & ''more'''!$C$7:$D$99"


@pytest.mark.parametrize("name", ["A1", "XFD12", "=cmd()", "two words", "7up", "", "a-b", "R1C1!"])
def test_what_excel_takes_for_a_cell_or_refuses_is_no_name(sheet, name):
    with pytest.raises(ValueError, match="cannot be a name"):
        Names().define(name, sheet, "A1")


def test_a_name_is_given_once(sheet):
    names = Names()
    names.define("limit", sheet, "A1")
    with pytest.raises(ValueError, match="is taken"):
        names.define("limit", sheet, "A2")


def test_names_of_a_sheet_go_with_it(sheet):
    other = sheet.parent.create_sheet("Other")
    names = Names()
    names.define("here", sheet, "A1")
    names.define("there", other, "A1")
    names.forget(sheet)
    assert list(names) == ["there"]
