"""The sheets of peaks and breakers, read back."""

import pytest
from fake_results import make_case
from fake_sizing import sized, table
from office import needs_office, recalculated
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.reporting.workbook import write_workbook
from tractionpower.results.results import Results


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


@needs_office
def test_settings_that_are_filled_in_reach_headline_acceptance_and_cover(tmp_path):
    results, scenario = make_case(substations=3)
    full = sized(results, scenario)
    rows = full.table("breakers").assign(setting_a=float("nan"), share_percent=float("nan"), met="")
    bare = Results(full.run, [], dict(full._source) | {"breakers": table("breakers", rows.to_dict("records"))}, scenario)
    file = write_workbook(bare, scenario, tmp_path / "bare.xlsx")
    book = load_workbook(file, data_only=True)
    assert "No feeder has a breaker with a setting" in texts(book["Breakers"])
    told = {row["what is judged"]: row for row in read_table(book["Acceptance"])}
    assert told["peak of feeders, of the setting of the breaker"]["verdict"] == "no setting"
    edited = load_workbook(file)
    head = next(row[0].row for row in edited["Breakers"].iter_rows() if row[0].value == "feeder")
    edited["Breakers"].cell(head + 1, 2).value = 0.5 * edited["Breakers"].cell(head + 1, 3).value
    edited.save(tmp_path / "filled.xlsx")
    after = load_workbook(recalculated([tmp_path / "filled.xlsx"])[0], data_only=True)
    assert "1 of 1 feeders beyond the setting of their breakers" in texts(after["Breakers"])
    shown = {row["what is judged"]: row for row in read_table(after["Acceptance"])}[
        "peak of feeders, of the setting of the breaker"
    ]
    assert (shown["found"], shown["verdict"]) == (pytest.approx(200.0), "violated")
    assert any("peak of feeders" in text for text in texts(after["Cover"]))
