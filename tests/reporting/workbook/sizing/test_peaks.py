"""The sheets of peaks and breakers, read back."""

import pytest
from read_workbook import read_table, texts


def test_peaks_tell_trains_and_parts(book):
    rows = read_table(book["Peaks"])
    assert {row["train"] for row in rows} == {"1000", "1001", "all fixed loads"}
    assert all(row["part [%]"] == pytest.approx(100.0 * row["part of the peak [A]"] / row["highest current [A]"]) for row in rows)


def test_breakers_have_a_column_for_each_level(book, study):
    rows = read_table(book["Breakers"])
    table = study[0].table("breakers").set_index(["device", "level_percent"])
    for row in rows:
        for level in (50, 80, 100):
            own = table.loc[(row["feeder"], float(level))]
            assert row[f"longest above {level} % [s]"] == pytest.approx(own["longest_s"], abs=1e-4)
            assert row[f"in all above {level} % [s]"] == pytest.approx(own["total_s"], abs=1e-4)
            assert row["highest of the setting [%]"] == pytest.approx(own["share_percent"])
        assert row["holds"] == "yes"
    assert f"0 of {len(rows)} feeders beyond the setting of their breakers" in texts(book["Breakers"])


def test_shares_and_verdicts_follow_the_setting(formulas, book, study):
    for row in read_table(formulas["Breakers"]):
        assert row["highest of the setting [%]"].startswith("=IF(ISNUMBER(B")
        assert "no setting" in row["holds"]
    found = {row["what is judged"]: row for row in read_table(book["Acceptance"])}
    shown = found["peak of feeders, of the setting of the breaker"]
    assert shown["found"] == pytest.approx(study[0].table("breakers")["share_percent"].max())
    assert shown["verdict"] == "met"
