import math

from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.run.sums import number, total, without_empty


def test_numbers_among_values():
    values = [1.5, None, "text", math.nan, Formula("1+1", 2.0), Formula('""', "")]
    assert [number(value) for value in values] == [1.5, None, None, None, 2.0, None]
    assert total(values) == 3.5


def test_columns_that_are_empty_go_but_not_the_first_and_those_that_are_needed():
    columns = [Column(name, key=name) for name in "abcd"]
    kept, rows = without_empty(columns, [["", None, "", 0.0], [None, None, None, None]], "b")
    assert [column.heading for column in kept] == ["a", "b", "d"]
    assert rows == [["", None, 0.0], [None, None, None]]
