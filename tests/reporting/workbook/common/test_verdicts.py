"""Formulas that judge, calculated by LibreOffice: numbers, limits that are empty or a text, tolerances."""

import math

import pytest
from office import needs_office, recalculated
from openpyxl import Workbook, load_workbook

from tractionpower.reporting.workbook.common.verdicts import Comparison, Words, same_as

WORDS = Words("kept", "passed", "open")
CASES = [
    (found, limit, tolerance)
    for found in (99.9, 99.95, 100.0, 100.05, 100.1000001, 0.0, -3.0, None, "", "x")
    for limit in (100.0, 0.0, -3.0, None, "", "x")
    for tolerance in (None, 0.1, "x")
]


def expected(sense, found, limit, tolerance):
    """Return margin and verdict, by plain arithmetic."""
    if not isinstance(found, float) or not isinstance(limit, float):
        return None, "open"
    margin = found - limit if sense == "at_least" else limit - found
    slack = (tolerance if isinstance(tolerance, float) else 0.0) + 1e-9 * abs(limit)
    return margin, "kept" if margin >= -slack else "passed"


@needs_office
@pytest.mark.parametrize("sense", ["at_least", "at_most"])
def test_what_is_no_number_is_not_judged(sense, tmp_path):
    book = Workbook()
    for row, case in enumerate(CASES, 1):
        for column, value in enumerate(case, 1):
            book.active.cell(row, column, value)
        held = Comparison(f"A{row}", f"B{row}", sense, f"C{row}")
        formulas = held.margin, held.verdict(WORDS), held.verdict_by(f"D{row}", WORDS), held.is_passed, same_as(f"B{row}")
        for column, text in enumerate(formulas, 4):
            book.active.cell(row, column, f"={text}")
    book.save(tmp_path / "cases.xlsx")
    (copy,) = recalculated([tmp_path / "cases.xlsx"])
    for case, told in zip(CASES, load_workbook(copy, data_only=True).active.iter_rows(min_col=4, values_only=True), strict=True):
        margin, word = expected(sense, *case)
        assert (told[0] or None) == pytest.approx(margin or None)
        assert told[1:3] == (word, word)
        assert bool(told[3]) == (word == "passed")
        assert (told[4] or None) == (case[1] or None if isinstance(case[1], float) else None)


@pytest.mark.parametrize(("sense", "found"), [("at_least", 99.9), ("at_most", 100.1)])
def test_numbers_are_held_as_the_formula_does(sense, found):
    held = Comparison("A1", "B1", sense, "C1")
    assert held.holds(found, 100.0, 0.1)
    assert not held.holds(found, 100.0)
    assert not held.holds(math.nextafter(found, -1e9 if sense == "at_least" else 1e9), 100.0, 0.0999)
