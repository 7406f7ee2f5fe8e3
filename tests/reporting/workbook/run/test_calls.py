import numpy as np
from read_workbook import exactly, read_table


def test_times_and_delays_are_those_of_the_table(small, case):
    frame = case[0].table("calls")
    rows = read_table(small["Calls"])
    assert [row["train"] for row in rows] == frame["train"].tolist()
    for heading, column in (("planned", "planned_s"), ("computed", "actual_s")):
        assert np.abs(np.array([row[heading] for row in rows]) - frame[column]).max() < 0.5
    assert [row["late [s]"] for row in rows] == [exactly(late) for late in frame["late_s"]]
    assert rows[1]["name"] == "Łódź Bravo"
    assert rows[1]["dwell [s]"] is None


def test_times_are_shown_as_times_of_day(small):
    sheet = small["Calls"]
    first = sheet[int(sheet.freeze_panes[1:])]
    assert [cell.number_format for cell in first[4:7]] == ["[hh]:mm:ss", "[hh]:mm:ss", "0"]


def test_late_calls_are_coloured(small):
    (area,) = small["Calls"].conditional_formatting
    assert [(rule.operator, rule.formula) for rule in area.rules] == [
        ("greaterThanOrEqual", ["59.5"]),
        ("greaterThanOrEqual", ["0.5"]),
    ]
    assert str(area.sqref).startswith("G")
