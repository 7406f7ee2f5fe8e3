import math

import pytest
from fake_results import VERDICTS
from read_workbook import read_table

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.common import acceptance
from tractionpower.reporting.workbook.common.accepted import Accepted, accepted_rows, cell_names
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula


@pytest.fixture
def book(case):
    return Book(Facts(*case), Report())


def finished(book):
    """Return the sheet of acceptance of a book, finished, with cached values by cell."""
    book.page("Cover", "Cover")
    acceptance.add(book)
    book.finish()
    return book.workbook["Acceptance"], book.cached["Acceptance"]


def test_verdicts_have_value_limit_source_and_status(small_values):
    rows = read_table(small_values["Acceptance"])
    assert [row["verdict"] for row in rows] == ["met", "violated", "met"]
    for number, (row, verdict) in enumerate(zip(rows, VERDICTS, strict=True), 1):
        assert (row["no."], row["found"], row["limit value"]) == (number, verdict["value"], verdict["limit_value"])
        assert row["limit"].lower() == verdict["limit"]
        assert row["source of the limit"] == verdict["source"]
        assert row["status of the limit"].startswith(verdict["status"])
        assert math.copysign(1.0, row["margin"]) == (1.0 if verdict["met"] else -1.0)
        assert abs(row["margin"]) == pytest.approx(abs(verdict["value"] - verdict["limit_value"]), rel=1e-12)


def test_acceptance_is_the_second_sheet(small):
    assert small.sheetnames[1] == "Acceptance"


def test_senses_follow_from_the_limits_of_earlier_results(small_values):
    assert [row["must be"] for row in read_table(small_values["Acceptance"])] == ["not below", "not above", "not above"]


def test_verdicts_are_coloured_by_their_word(small):
    rules = {
        rule.formula[0]: rule.dxf.fill.bgColor.rgb[-6:]
        for rules in small["Acceptance"].conditional_formatting
        for rule in rules.rules
    }
    assert rules == {'"met"': "C6EFCE", '"violated"': "FFC7CE", '"not judged"': "FFEB9C"}


def test_limits_can_be_edited_and_margins_and_verdicts_ask_for_them(small):
    for row in read_table(small["Acceptance"]):
        assert isinstance(row["limit value"], int | float)
        assert row["margin"].startswith("=IF(AND(ISNUMBER(")
        assert '"violated"' in row["verdict"]
    names = small.defined_names
    for name in ("limit_u_min2", "limit_u_max2", "limit_t_max2"):
        sheet, _, cell = names[name].attr_text.partition("!")
        assert sheet == "'Acceptance'"
        assert small["Acceptance"][cell.replace("$", "")].fill.start_color.rgb.endswith("FFF9C4")


def test_counts_are_formulas_with_names(small, small_values):
    told = {}
    for name in ("acceptance_met", "acceptance_violated", "acceptance_open", "acceptance_all"):
        cell = small.defined_names[name].attr_text.partition("!")[2].replace("$", "")
        assert small["Acceptance"][cell].value.startswith("=")
        told[name] = small_values["Acceptance"][cell].value
    assert told == {"acceptance_met": 2, "acceptance_violated": 1, "acceptance_open": 0, "acceptance_all": 3}


def test_a_row_of_a_sheet_takes_the_place_of_the_verdict_on_the_same(book):
    own = Accepted("highest voltage", "u_max2", 3900.0, "V", "at_most", Formula("40+2", 42.0))
    new = Accepted("lateness", "tolerance_s", 30.0, "s", "at_most", 12.0)
    book.acceptance += [new, own]
    assert accepted_rows(book)[1] is own
    assert [row.name for row in accepted_rows(book)][2:] == ["longest spell above U_max1", "lateness"]
    sheet, cached = finished(book)
    found = next(cell for row in sheet.iter_rows() for cell in row if cell.value == "=40+2")
    assert cached[found.coordinate] == 42.0


def test_rows_of_a_group_stand_together(book):
    book.acceptance += [Accepted(str(k), "x", 1.0, "", "at_most", 0.0, group=group) for k, group in enumerate("ABA")]
    assert [row.name for row in accepted_rows(book)][-3:] == ["0", "2", "1"]


def test_rows_with_the_same_limit_share_its_cell_and_others_are_numbered():
    def row(limit, value):
        return Accepted("x", limit, value, "V", "at_least", 1.0)

    rows = [row("u_useful", 2700.0), row("u_useful", 2800.0), row("u_useful", 2700.0), row("a-b", 1.0), row("u_useful", 2800.0)]
    names = ["limit_u_useful", "limit_u_useful_2", "limit_u_useful", "limit_a_b", "limit_u_useful_2"]
    assert cell_names(rows) == names
    spell = Accepted("x", "touch_300s", 1.0, "s", "at_most", 0.0)
    assert cell_names([spell]) == ["limit_touch_300s_s"]


def test_a_second_row_with_a_limit_refers_to_the_first(book):
    book.acceptance += [Accepted(name, "u_useful", 2700.0, "V", "at_least", 2800.0) for name in "ab"]
    sheet, cached = finished(book)
    cells = [cell for row in sheet.iter_rows() for cell in row if cell.value == '=IF(ISNUMBER(limit_u_useful),limit_u_useful,"")']
    assert [cached[cell.coordinate] for cell in cells] == [2700.0]


@pytest.mark.parametrize(
    ("sense", "found", "tolerance", "word"),
    [
        ("at_least", 99.95, 0.1, "met"),
        ("at_least", 99.85, 0.1, "violated"),
        ("at_most", 100.0 + 1e-8, 0.0, "met"),
        ("at_most", 100.001, 0.0, "violated"),
        ("at_most", None, 0.0, "not judged"),
        ("at_least", math.nan, 0.0, "not judged"),
        ("at_most", Formula("{nothing}", ""), 0.0, "not judged"),
    ],
)
def test_a_value_is_held_against_its_limit(book, sense, found, tolerance, word):
    book.subject.run = {}
    book.acceptance.append(Accepted("x", "x", 100.0, "", sense, found, tolerance=tolerance))
    sheet, cached = finished(book)
    head = next(cell for row in sheet.iter_rows() for cell in row if cell.value == "verdict")
    assert cached[f"{head.column_letter}{head.row + 1}"] == word


def test_tolerances_are_named_cells_that_can_be_edited_and_later_rows_refer_to_them(book):
    book.subject.run = {}
    book.acceptance += [Accepted(name, "u_min2", 2000.0, "V", "at_least", 1999.95, tolerance=0.1) for name in "ab"]
    book.acceptance.append(Accepted("c", "t_max2", 300.0, "s", "at_most", 300.0000001, tolerance=1e-6))
    sheet, cached = finished(book)
    first, second, third = (sheet[f"G{row}"] for row in (10, 11, 12))
    assert (first.value, second.value, third.value) == (0.1, '=IF(ISNUMBER(tolerance_u_min2),tolerance_u_min2,"")', None)
    assert first.fill.start_color.rgb.endswith("FFF9C4")
    assert not second.fill.start_color.rgb.endswith("FFF9C4")
    assert book.workbook.defined_names["tolerance_u_min2"].attr_text == "'Acceptance'!$G$10"
    assert [cached[f"I{row}"] for row in (10, 11, 12)] == ["met"] * 3
    assert "-N(1E-06)-" in sheet["I12"].value


def test_what_the_program_says_otherwise_than_the_numbers_is_a_word_of_its_own(book):
    book.subject.run = {}
    book.acceptance.append(Accepted("x", "x", 100.0, "", "at_most", 1.0, met=False))
    sheet, _ = finished(book)
    head = next(cell for row in sheet.iter_rows() for cell in row if cell.value == "verdict")
    assert sheet.cell(head.row + 1, head.column).value == "violated"


def test_a_book_without_rows_has_no_such_sheet(book):
    book.subject.run = {}
    book.page("Cover", "Cover")
    acceptance.add(book)
    book.finish()
    assert book.workbook.sheetnames == ["Cover"]


def test_limits_as_used_are_those_of_the_system(small, case):
    used = [limit for limit in case[1].limits if limit.system == "dc3000"]
    rows = read_table(small["Inputs limits"])
    assert [(row["name"], row["value"], row["source"]) for row in rows] == [(li.name, li.value, li.source) for li in used]
