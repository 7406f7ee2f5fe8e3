import numpy as np
import pyarrow as pa
import pytest
from fake_feasibility import judged
from fake_results import make_case
from openpyxl import load_workbook
from read_workbook import read_table

from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.run.timetable import PARTS
from tractionpower.results.columns import DELAY_PARTS
from tractionpower.results.results import Results


def above(sheet):
    """Return labels and values above the table."""
    return {sheet.cell(row, 1).value: sheet.cell(row, 3).value for row in range(3, int(sheet.freeze_panes[1:]) - 1)}


def test_times_and_deviations_are_those_of_the_table(small_values, small, case):
    frame = case[0].table("calls")
    rows = read_table(small_values["Timetable"])
    assert [row["train"] for row in rows] == frame["train"].tolist()
    for heading, column in (("planned", "planned_s"), ("simulated", "actual_s")):
        assert np.abs(np.array([row[heading] for row in rows]) - frame[column]).max() < 0.5
    assert [row["deviation [s]"] for row in rows] == pytest.approx(frame["late_s"].tolist(), abs=1e-5)
    assert {row["deviation [s]"][:7] for row in read_table(small["Timetable"])} == {"=86400*"}
    assert rows[1]["station"] == "Łódź Bravo"
    assert rows[1]["dwell [s]"] is None


def test_late_calls_are_counted_by_the_numbers_that_can_be_edited(small_values, small, case):
    late = case[0].table("calls")["late_s"]
    told = above(small_values["Timetable"])
    assert (told["late from [s], can be edited"], told["very late from [s], can be edited"]) == (1.0, 60.0)
    assert told["late calls"] == (late >= 1.0).sum() > 0
    assert told["very late calls"] == (late >= 60.0).sum()
    assert told["largest lateness [s]"] == pytest.approx(late.max(), abs=1e-5)
    assert told["mean deviation [s]"] == pytest.approx(late.mean(), abs=1e-5)
    assert told["train that is latest"] in set(case[0].table("calls")[late >= late.max() - 1e-6]["train"])
    for name in ("late_from_s", "very_late_from_s"):
        assert small.defined_names[name].attr_text.startswith("'Timetable'!$C$")


def test_where_nobody_is_late_no_train_is_the_latest(case, tmp_path):
    results, scenario = case
    calls = results.table("calls")
    calls = calls.assign(actual_s=calls["planned_s"] - 30.0, late_s=-30.0)
    early = Results(results.run, results.key_figures, {"calls": pa.Table.from_pandas(calls)}, scenario)
    file = write_workbook(early, scenario, tmp_path / "early.xlsx")
    told = above(load_workbook(file, data_only=True)["Timetable"])
    assert (told["largest lateness [s]"], told["train that is latest"] or "") == (0.0, "")
    assert told["largest earliness [s]"] == pytest.approx(30.0, abs=1e-5)
    assert told["train that is earliest"] in set(calls["train"].astype(str))


def test_colours_follow_these_numbers(small):
    rules = [rule.formula[0] for area in small["Timetable"].conditional_formatting for rule in area.rules]
    assert any(">=late_from_s" in rule for rule in rules)
    assert any(">=very_late_from_s" in rule for rule in rules)


def test_causes_stand_beside_the_deviations_of_a_run_that_was_judged(tmp_path):
    results, scenario = make_case()
    late = {run.id: {"voltage": 70.0, "driving": 5.0} for run in scenario.runs[1:3]}
    results = judged(results, scenario, late)
    sheet = load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"), data_only=True)["Timetable"]
    delays = results.table("delays")
    assert above(sheet)["sum of low voltage [s]"] == pytest.approx(delays["voltage_s"].sum())
    assert above(sheet)["sum of driving plan [s]"] == pytest.approx(delays["driving_s"].sum())
    found = [row for row in read_table(sheet) if row["low voltage [s]"]]
    assert len(found) == (delays["voltage_s"] >= 0.05).sum() > 0


def test_every_part_of_a_delay_has_a_column():
    assert set(PARTS) == set(DELAY_PARTS)


def test_a_call_that_no_train_reached_is_counted(rich):
    told = above(rich.values["Timetable"])
    calls = rich.results.table("calls")
    missing = (calls["planned_s"].notna() & calls["actual_s"].isna()).sum()
    assert told["planned calls that were not reached"] == missing
