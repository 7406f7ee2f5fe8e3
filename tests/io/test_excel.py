"""Workbooks as cells: times, merged cells, formulas without values, files that are no workbooks."""

from datetime import datetime, time, timedelta

import pytest
from openpyxl import Workbook

from tractionpower.errors import InputError
from tractionpower.io.excel import read_workbook
from tractionpower.io.text_files import Source


def source_of(path):
    return Source(path, path.name, "")


def test_cells(tmp_path):
    book = Workbook()
    sheet = book.active
    sheet.title = "Plan"
    sheet.append(["Łódź ", 1301, 0.5, time(5, 10), timedelta(hours=25, minutes=10), True, None])
    sheet["H1"] = 1.0 + 70.0 / 1440.0
    sheet["H1"].number_format = "h:mm"  # so spreadsheets keep 25:10 that someone typed
    sheet["I1"] = datetime(2026, 5, 4, 6, 30)
    sheet["A2"] = "merged"
    sheet.merge_cells("A2:A3")
    sheet["B3"] = "=B1+1"
    book.create_sheet("aside").sheet_state = "hidden"
    book.save(tmp_path / "plan.xlsx")
    read = read_workbook(source_of(tmp_path / "plan.xlsx"))
    assert read.hidden == ["aside"]
    (plan,) = read.sheets
    hour = timedelta(hours=1)
    assert plan.rows[0][:7] == [
        "Łódź",
        1301.0,
        0.5,
        5 * hour + timedelta(minutes=10),
        25 * hour + timedelta(minutes=10),
        True,
        None,
    ]
    assert abs(plan.rows[0][7] - timedelta(hours=25, minutes=10)) < timedelta(seconds=1)
    assert plan.rows[0][8] == datetime(2026, 5, 4, 6, 30)
    assert plan.rows[2][0] == "merged"
    (problem,) = read.problems
    assert (problem.code, problem.path, problem.place) == ("no_value", "cell B3", "plan.xlsx, sheet Plan:3")


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"train,station\n", "no_workbook"),
        (b"PK\x03\x04broken", "no_workbook"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1old", "old_workbook"),
        (b"", "no_workbook"),
    ],
)
def test_files_that_are_no_workbooks(tmp_path, content, code):
    (tmp_path / "plan.xlsx").write_bytes(content)
    with pytest.raises(InputError) as raised:
        read_workbook(source_of(tmp_path / "plan.xlsx"))
    assert [problem.code for problem in raised.value.problems] == [code]


def test_a_missing_file(tmp_path):
    with pytest.raises(InputError, match="no file"):
        read_workbook(source_of(tmp_path / "none.xlsx"))
